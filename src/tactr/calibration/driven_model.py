"""What the model with friction and backlash says of measured rows, which are driven along in their order."""

from __future__ import annotations

import numpy as np

from tactr.calibration.model import Model, Setting, Ticker
from tactr.calibration.parameters import FRAME, Free
from tactr.friction import drive
from tactr.statics.shape import Shape

STEP = 1e-2  # of a number's scale: far above what drives are solved to


class DrivenModel(Model):
    """Predictions along the rows, from rest. Derivatives are differences of drives: exact ones would have to
    know how the places where tendons slide move."""

    _at: np.ndarray | None = None  # the robot's own numbers in the shapes found last

    def predict(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """Points in the sensor's axes, (n, k, 3) m; NaN in rows that were not reached."""
        setting = self.setting(values)
        own = values[[not _only_seen(free) for free in self.frees]]
        if self._at is None or not np.array_equal(own, self._at):
            self._shapes, self._at = self._driven(setting, tick), own
        return self._seen(self._shapes, setting)

    def forget(self) -> None:
        """Shapes of a path from rest are the same from any start."""

    def jacobian(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """d points/d values, (n, k, 3, free), at the shapes of the last ``predict``, which was there; 0 in
        rows that were not reached."""
        here = self._seen(self._shapes, self.setting(values))
        columns = [self._column(here, values, k, free, tick) for k, free in enumerate(self.frees)]
        return np.nan_to_num(np.stack(columns, axis=-1))

    def _column(
        self, here: np.ndarray, values: np.ndarray, k: int, free: Free, tick: Ticker | None
    ) -> np.ndarray:
        """One difference, away from the nearer bound."""
        step = STEP * free.scale
        if values[k] - free.lower > free.upper - values[k]:
            step = -step
        moved = values.copy()
        moved[k] += step
        setting = self.setting(moved)
        shapes = self._shapes if _only_seen(free) else self._driven(setting, tick)
        return (self._seen(shapes, setting) - here) / step

    def _driven(self, setting: Setting, tick: Ticker | None) -> list[Shape | None]:
        progress = None if tick is None else (lambda done, count: tick(done - 1))
        driven = drive(
            setting.robot, self._actuation(setting), tolerance=self.tolerance, stations=2, progress=progress
        )
        pairs = zip(driven.shapes, driven.failed, strict=True)
        return [None if text else shape for shape, text in pairs]

    def _seen(self, shapes: list[Shape | None], setting: Setting) -> np.ndarray:
        found = np.full(self.measured.points.shape, np.nan)
        for i, shape in enumerate(shapes):
            if shape is not None:
                found[i] = self._points(shape, setting.frame)
        return found


def _only_seen(free: Free) -> bool:
    """Whether it moves marker or sensor, not the robot."""
    return all(path in FRAME for path in free.paths)
