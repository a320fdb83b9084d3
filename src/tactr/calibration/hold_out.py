"""How well a calibration predicts rows that it has not seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tactr.calibration.measurements import Measurements
from tactr.errors import RobotError

Folds = int | Literal["group"] | Sequence[bool] | Sequence[str] | np.ndarray
Fit = Callable[[str, Measurements, Measurements], np.ndarray]


@dataclass(frozen=True, eq=False, repr=False)
class HoldOut:
    """Errors of predictions of rows held out.

    folds: their names; fold: (n,) the fold of each row, -1 for rows never held out; residual: (n, k, 3) m,
    prediction - measurement, NaN where there is none.
    """

    folds: tuple[str, ...]
    fold: np.ndarray
    residual: np.ndarray

    @property
    def error(self) -> np.ndarray:
        """Mean distance of the points of every row, (n,), m."""
        return distances(self.residual)

    @property
    def mean(self) -> float:
        """Mean error over all rows held out, m."""
        return float(np.nanmean(self.error))

    @property
    def means(self) -> np.ndarray:
        """Mean error of every fold, (folds,), m."""
        return np.array([np.nanmean(self.error[self.fold == k]) for k in range(len(self.folds))])

    @property
    def missing(self) -> int:
        """Rows held out without a prediction: the model found no equilibrium."""
        return int(np.isnan(self.error[self.fold >= 0]).sum())

    def __repr__(self) -> str:
        low, high = self.means.min() * 1e3, self.means.max() * 1e3
        count = len(self.folds)
        return (
            f"<HoldOut: mean error {self.mean * 1e3:.3g} mm, {low:.3g} to {high:.3g} mm over {count} folds>"
        )


def distances(residual: np.ndarray) -> np.ndarray:
    """Mean distance of the points of every row, (n,), from (n, k, 3); NaN where there is none."""
    far = np.linalg.norm(residual, axis=2)
    count = np.isfinite(far).sum(axis=1)
    return np.where(count > 0, np.nansum(far, axis=1) / np.maximum(count, 1), np.nan)


def fold_labels(data: Measurements, folds: Folds) -> tuple[tuple[str, ...], np.ndarray]:
    """Names of the folds and the fold of each row. Raises RobotError."""
    n = len(data)
    if isinstance(folds, str):
        if folds != "group" or data.group is None:
            raise RobotError(
                "folds", f"{folds!r}", "a number, a mask, or 'group' for data with a group column"
            )
        names = tuple(dict.fromkeys(data.group))
        return _checked(names, np.array([names.index(name) for name in data.group]))
    if isinstance(folds, int | np.integer) and not isinstance(folds, bool):
        if not 2 <= folds <= n:
            raise RobotError("folds", f"{folds} blocks of {n} rows", f"2 to {n} blocks", value=folds)
        parts = np.array_split(np.arange(n), folds)
        label = np.concatenate([np.full(len(part), k) for k, part in enumerate(parts)])
        return tuple(f"{data.row_name(p[0])} to {data.row_name(p[-1])}" for p in parts), label
    mask = np.asarray(folds)
    if mask.shape != (n,) or mask.dtype != bool or mask.all() or not mask.any():
        raise RobotError(
            "folds", f"an array {mask.shape} of {mask.dtype}", f"{n} booleans, some of them true"
        )
    return ("rows held out",), np.where(mask, 0, -1)


def _checked(names: tuple[str, ...], label: np.ndarray) -> tuple[tuple[str, ...], np.ndarray]:
    if len(names) < 2:
        raise RobotError("folds", "all rows are of one group", "data of at least two groups")
    return names, label


def hold_out_of(data: Measurements, labels: tuple[tuple[str, ...], np.ndarray], fit: Fit) -> HoldOut:
    """Every fold predicted by a fit on the other rows."""
    names, label = labels
    residual = np.full(data.points.shape, np.nan)
    for k in range(len(names)):
        test = np.flatnonzero(label == k)
        train = np.flatnonzero(label != k)
        points = fit(f"fold {k + 1} of {len(names)}", data.rows(train), data.rows(test))
        residual[test] = points - data.points[test]
    return HoldOut(names, label, residual)
