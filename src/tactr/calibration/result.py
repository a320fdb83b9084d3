"""The result of a calibration."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.calibration.driven_model import DrivenModel
from tactr.calibration.frame import Frame
from tactr.calibration.hold_out import HoldOut, distances
from tactr.calibration.identify import Knowledge, Unseen
from tactr.calibration.measurements import Measurements, Remark
from tactr.calibration.model import Model
from tactr.calibration.parameters import Free
from tactr.calibration.search import Found
from tactr.robot import Robot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """One free number: name; value, error (its standard error) and interval (95 %), SI units, None where the
    data do not identify it; start, where the search began; unit, SI; state: "found", "at its bound" (value is
    that bound) or "not identifiable"."""

    name: str
    value: float | None
    error: float | None
    interval: tuple[float, float] | None
    start: float
    unit: str
    state: str


@dataclass(frozen=True, eq=False, repr=False)
class Calibration:
    """What a calibration found.

    robot: calibrated; a number that is not identifiable is where the search left it. frame: marker and
    sensor. estimates: of the free numbers. correlation: (free, free), NaN where there is no standard error.
    unseen: combinations of free numbers that the data do not see. noise: standard deviation of a coordinate,
    m. residual: (n, k, 3) m, prediction - measurement, NaN where there is none. tension: (n, tendons) N, in
    the model. hold_out: see ``HoldOut``, None without folds. remarks: what to know of data and result.
    left: what each start left, m, root mean square, the best first. measurements: as given. history: whether
    rows were driven along in their order.
    """

    robot: Robot
    frame: Frame
    estimates: tuple[Estimate, ...]
    correlation: np.ndarray
    unseen: tuple[Unseen, ...]
    noise: float
    residual: np.ndarray
    tension: np.ndarray
    hold_out: HoldOut | None
    remarks: tuple[Remark, ...]
    left: tuple[float, ...]
    measurements: Measurements
    tolerance: float
    history: bool

    @classmethod
    def of(
        cls,
        model: Model,
        found: Found,
        known: Knowledge,
        hold_out: HoldOut | None,
        left: tuple[float, ...],
        unknown_noise: bool,
        remarks: tuple[Remark, ...],
    ) -> Calibration:
        """From the best search and what is known by it."""
        freedom = int(np.isfinite(found.residual).sum()) - len(model.frees)
        wide = _quantile(freedom if unknown_noise else np.inf)
        estimates = [
            _estimate(
                free, found.values[k], known.errors[k], bool(found.held[k]), bool(known.identifiable[k]), wide
            )
            for k, free in enumerate(model.frees)
        ]
        return cls(
            robot=model.calibrated(found.values),
            frame=model.setting(found.values).frame,
            estimates=tuple(estimates),
            correlation=known.correlation,
            unseen=known.unseen,
            noise=found.noise,
            residual=found.residual,
            tension=model.tensions(),
            hold_out=hold_out,
            remarks=remarks,
            left=left,
            measurements=model.measured,
            tolerance=model.tolerance,
            history=isinstance(model, DrivenModel),
        )

    @property
    def error(self) -> np.ndarray:
        """Mean distance of the points of every row from the measured ones, (n,), m."""
        return distances(self.residual)

    @property
    def length(self) -> float:
        """Of the robot outside the guide, m, against which errors are compared."""
        return max(tube.tip for tube in self.robot.tubes)

    def __getitem__(self, name: str) -> Estimate:
        """The estimate called so."""
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        raise KeyError(f"{name!r} is not free; free are {', '.join(e.name for e in self.estimates)}")

    def predict(self, measurements: Measurements) -> np.ndarray:
        """Points of other rows in the sensor's axes, (n, k, 3) m; NaN in rows without an equilibrium. With a
        history the rows are a path, from rest."""
        model = DrivenModel if self.history else Model
        return model(self.robot, self.frame, measurements, (), self.tolerance).predict(np.array([]))

    def errors(self, measurements: Measurements) -> np.ndarray:
        """Mean distance of predicted from measured points of other rows, (n,), m."""
        return distances(self.predict(measurements) - measurements.points)

    def plot(self, path: str | Path | None = None) -> Figure:
        """Residuals over rows, in space, and their distribution; saved to path where given (extra: plot)."""
        from tactr.plotting.calibration_plot import plot_calibration

        return plot_calibration(self, path)

    def to_dict(self) -> dict[str, Any]:
        """Numbers, errors, remarks and scores as plain data, SI units, for JSON."""
        from tactr.calibration.report import as_data

        return as_data(self)

    def __str__(self) -> str:
        from tactr.calibration.report import as_text

        return as_text(self)

    def __repr__(self) -> str:
        found = sum(estimate.state == "found" for estimate in self.estimates)
        error = float(np.nanmean(self.error)) * 1e3
        return f"<Calibration: {found} of {len(self.estimates)} numbers found, mean error {error:.3g} mm>"


def _estimate(
    free: Free, value: float, error: float, held: bool, identifiable: bool, wide: float
) -> Estimate:
    unit = "N" if free.kind.name == "axial or shear stiffness" else free.kind.units[-1]  # the SI one
    if held:
        return Estimate(free.name, float(value), None, None, free.start, unit, "at its bound")
    if not identifiable:
        return Estimate(free.name, None, None, None, free.start, unit, "not identifiable")
    interval = float(value - wide * error), float(value + wide * error)
    return Estimate(free.name, float(value), float(error), interval, free.start, unit, "found")


def _quantile(freedom: float) -> float:
    """Half the width of the interval, in standard errors (Student's t; scipy.stats is slow to import)."""
    from scipy.special import stdtrit

    return float(stdtrit(max(freedom, 1.0) if np.isfinite(freedom) else 1e9, 0.5 + 0.5 * CONFIDENCE))
