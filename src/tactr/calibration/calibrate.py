"""Calibrate a robot: the free numbers that make its model meet what was measured."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np

from tactr.calibration.checks import after, before
from tactr.calibration.curvature import rough_intervals
from tactr.calibration.driven_model import DrivenModel
from tactr.calibration.frame import Frame
from tactr.calibration.history import with_history, without_history
from tactr.calibration.hold_out import Folds, HoldOut, fold_labels, hold_out_of
from tactr.calibration.identify import knowledge
from tactr.calibration.measurements import Measurements, Remark
from tactr.calibration.model import Model, Ticker
from tactr.calibration.parameters import Free, Parameter, expanded
from tactr.calibration.result import Calibration
from tactr.calibration.search import LOSSES, Found, Loss, search
from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot import _check as check

Progress = Callable[[str, int, int], None]
"""Called with what is being done, the row that it is at, and of how many."""

AGREE = 1e-3  # relative difference of the costs of starts that ended at the same place


def calibrate(
    robot: Robot,
    measurements: Measurements | str | Path,
    *,
    parameters: Sequence[str | Parameter],
    frame: Frame | None = None,
    noise: float | None = None,
    loss: Loss = "linear",
    starts: int = 1,
    folds: Folds | None = None,
    history: bool = False,
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> Calibration:
    """The robot, the marker and the sensor's place that fit measurements best, and what these say of them.

    measurements: or a CSV file (see ``Measurements.read``). parameters: what is free: paths or Parameter
    objects; none: how well the robot predicts as it is. frame: where marker and sensor are, or start from.
    noise: standard deviation of a measured coordinate, m; None: from the residuals, model errors included.
    loss: "linear" (least squares), or for data with outliers "huber", "soft_l1" or "cauchy". starts: of the
    search, the first where the robot is, the others spread over bounds, or two scales to each side. folds: a
    number of blocks of successive rows, "group", or a mask of rows: each is predicted by a calibration on
    the other rows. history: rows are one path in the order of time, from rest, which ``drive`` follows with
    friction and backlash ("tendons.outer.friction", "tendons.outer.play"); derivatives are then differences,
    and rows cannot be held out. tolerance: as in ``solve``. Motors' zeros end as rest lengths in the
    calibrated robot. Raises RobotError for parameters or data that do not fit the robot, FileError.
    """
    data = measurements if isinstance(measurements, Measurements) else Measurements.read(measurements)
    frame = Frame() if frame is None else frame
    frees = expanded(robot, parameters, list(data.displacement), frame)
    _check_options(noise, loss, starts)
    remarks = before(robot, frame, data, frees)
    remarks += with_history(data, frees, folds) if history else without_history(robot, frees)
    labels = None if folds is None else fold_labels(data, folds)
    origin = np.array([free.start for free in frees])
    tick = _ticker(progress, len(data))
    model = (DrivenModel if history else Model)(robot, frame, data, frees, tolerance)
    first = model.predict(origin, tick("start"))
    found, costs = _best(model, frees, noise, loss, starts, tick)
    known = knowledge(frees, found.jacobian, found.noise, found.held)
    held: HoldOut | None = None
    if labels is not None:
        fit = partial(_fitted, robot, frame, frees, noise, loss, tolerance, tick)
        held = hold_out_of(data, labels, fit)
    remarks += after(model, first, found, known, loss) + _of_starts(costs)
    remarks += rough_intervals(model, found.values, known)
    return Calibration.of(model, found, known, held, costs, noise is None, tuple(remarks))


def _best(
    model: Model, frees: Sequence[Free], noise: float | None, loss: Loss, starts: int, tick: _Ticks
) -> tuple[Found, tuple[float, ...]]:
    found: list[Found] = []
    for k, start in enumerate(_starts(frees, starts)):
        if k > 0:
            model.forget()
        name = f"start {k + 1} of {starts}" if starts > 1 else "calibrating"
        try:
            found.append(search(model, start, noise=noise, loss=loss, tick=tick(name)))
        except RobotError:
            if k == 0:
                raise
    best = min(found, key=lambda each: _rank(each, found[0].noise))
    if starts > 1:
        model.predict(best.values)
    return best, tuple(sorted(_rank(each, found[0].noise) for each in found))


def _rank(found: Found, noise: float) -> float:
    """What is left, m: comparable between starts whose noises differ, and rows without equilibrium cost."""
    seen = np.isfinite(found.residual)
    spread = float(np.sqrt(np.mean(found.residual[seen] ** 2)))
    missing = 1.0 - seen.mean()
    return spread + missing * noise


def _starts(frees: Sequence[Free], count: int) -> list[np.ndarray]:
    """The first from where the robot is, the others by Latin hypercube."""
    origin = np.array([free.start for free in frees])
    if count == 1:
        return [origin]
    from scipy.stats import qmc

    low, high = np.array([_span(free) for free in frees]).T
    shares = qmc.LatinHypercube(d=len(frees), rng=np.random.default_rng(0)).random(count - 1)
    return [origin, *(low + shares * (high - low))]


def _span(free: Free) -> tuple[float, float]:
    """Where a number may start: between its bounds, or two scales to each side."""
    if np.isfinite(free.lower) and np.isfinite(free.upper):
        return free.lower, free.upper
    return max(free.lower, free.start - 2 * free.scale), min(free.upper, free.start + 2 * free.scale)


def _fitted(
    robot: Robot,
    frame: Frame,
    frees: Sequence[Free],
    noise: float | None,
    loss: Loss,
    tolerance: float,
    tick: _Ticks,
    name: str,
    train: Measurements,
    test: Measurements,
) -> np.ndarray:
    """Points of the rows held out, predicted by a calibration on the others, (rows, k, 3)."""
    origin = np.array([free.start for free in frees])
    found = search(
        Model(robot, frame, train, frees, tolerance), origin, noise=noise, loss=loss, tick=tick(name)
    )
    return Model(robot, frame, test, frees, tolerance).predict(found.values)


def _of_starts(costs: tuple[float, ...]) -> list[Remark]:
    if len(costs) < 2:
        return []
    same = sum(cost <= costs[0] * (1 + AGREE) for cost in costs)
    if same > 1:
        return []
    text = f"only one of {len(costs)} starts came to the best fit, the next one left {costs[1] * 1e3:.3g} mm"
    return [Remark("starts-differ", text)]


def _check_options(noise: float | None, loss: str, starts: int) -> None:
    check.choice("loss", loss, LOSSES)
    if noise is not None:
        check.real("noise", noise, "m", above=0)
    if isinstance(starts, bool) or not isinstance(starts, int) or starts < 1:
        raise RobotError("starts", f"{starts!r}", "a whole number above 0", value=starts)


_Ticks = Callable[[str], Ticker | None]


def _ticker(progress: Progress | None, rows: int) -> _Ticks:
    if progress is None:
        return lambda name: None
    shown = cast(Progress, progress)
    return lambda name: lambda row: shown(name, row, rows)
