"""What the model with friction and backlash says of measured rows, which are driven along in their order."""

from __future__ import annotations

import numpy as np

from tactr.calibration.model import Model, Setting, Ticker
from tactr.calibration.parameters import FRAME, Free
from tactr.friction import drive

TENDONS = ("tension", "displacement")
STEP = 1e-2  # of a number's scale: far above what drives are solved to


class DrivenModel(Model):
    """Predictions along the rows, from rest. Derivatives are differences of drives: exact ones would have to
    know how the places where tendons slide move."""

    def predict(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """Points in the sensor's axes, (n, k, 3) m; NaN in rows that were not reached."""
        setting = self.setting(values)
        progress = None if tick is None else (lambda done, count: tick(done - 1))
        driven = drive(
            setting.robot, self._path(setting), tolerance=self.tolerance, stations=2, progress=progress
        )
        pairs = zip(driven.shapes, driven.failed, strict=True)
        self._shapes = [None if text else shape for shape, text in pairs]
        return self._seen(setting)

    def jacobian(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """d points/d values, (n, k, 3, free), at the shapes of the last ``predict``, which was there."""
        here = list(self._shapes)
        columns = [self._column(values, k, free, tick) for k, free in enumerate(self.frees)]
        self._shapes = here
        return np.nan_to_num(np.stack(columns, axis=-1))

    def _column(self, values: np.ndarray, k: int, free: Free, tick: Ticker | None) -> np.ndarray:
        step = STEP * free.scale
        ends = [max(values[k] - step, free.lower), min(values[k] + step, free.upper)]
        moved = []
        for end in ends:
            at = values.copy()
            at[k] = end
            only_seen = all(path in FRAME for path in free.paths)
            moved.append(self._seen(self.setting(at)) if only_seen else self.predict(at, tick))
        return (moved[1] - moved[0]) / (ends[1] - ends[0])

    def _path(self, setting: Setting) -> list[dict[str, dict[str, float]]]:
        rows = self._actuation(setting)
        points: list[dict[str, dict[str, float]]] = [{} for _ in range(len(self.measured))]
        for kind, array in rows.items():
            members = self.robot.tendons if kind in TENDONS else self.robot.tubes
            for j, member in enumerate(members):
                if member.name in getattr(self.measured, kind):
                    for point, value in zip(points, array[:, j], strict=True):
                        point.setdefault(kind, {})[member.name] = float(value)
        return points

    def _seen(self, setting: Setting) -> np.ndarray:
        found = np.full(self.measured.points.shape, np.nan)
        for i, shape in enumerate(self._shapes):
            if shape is not None:
                found[i] = self._points(shape, setting.frame)
        return found
