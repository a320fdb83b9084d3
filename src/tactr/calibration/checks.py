"""What can be wrong with measured data, said by name: errors before the search, remarks after it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.calibration.align import best_turn
from tactr.calibration.frame import Frame
from tactr.calibration.hold_out import distances
from tactr.calibration.identify import Knowledge
from tactr.calibration.measurements import ACTUATION, Measurements, Remark, seen
from tactr.calibration.model import Model
from tactr.calibration.parameters import ZERO, Free
from tactr.calibration.search import Found
from tactr.errors import RobotError
from tactr.robot import Robot

FAR = 5.0  # median distances: an outlier
BETTER = 0.5  # of the error left in other axes: the sensor's axes are not what they are said to be
ALIKE = 0.5  # correlation of neighbouring rows' residuals
UNLIKE = 30.0  # ratio of the spreads of measured and predicted points
MOST_TENSION, MOST_ROTATION = 1e3, 8.0 * np.pi


def before(robot: Robot, frame: Frame, data: Measurements, frees: Sequence[Free]) -> list[Remark]:
    """Raises RobotError where the data cannot be of this robot, or are too few."""
    count = int(np.isfinite(data.points).sum())
    known = sum(free.prior is not None for free in frees)
    if count + known < len(frees):
        found = f"{len(frees)} free numbers, but only {count} coordinates measured in {len(data)} rows"
        raise RobotError("parameters", found, "more rows, fewer free parameters, or priors")
    _check_measured(data, frees)
    _check_zeros(robot, data, frees)
    reach = max(tube.tip for tube in robot.tubes)
    _check_points(data, frame, frees, reach)
    _check_actuation(data, longest=max(tube.length for tube in robot.tubes))
    return list(data.remarks)


def _check_measured(data: Measurements, frees: Sequence[Free]) -> None:
    """What was measured in every row cannot be free as well."""
    for path in (path for free in frees for path in free.paths):
        name, _, kind = path.partition(".")[2].rpartition(".")
        if kind not in ACTUATION or (path.startswith("tubes") != (kind in ("rotation", "translation"))):
            continue
        given = {*data.displacement, *data.tension} if kind == "tension" else getattr(data, kind)
        if name in given:
            found = "the data say for every row how it is actuated"
            raise RobotError(path, found, "other parameters, such as tendons.NAME.zero for displacements")


def _check_actuation(data: Measurements, longest: float) -> None:
    for kind, most, unit in (
        ("displacement", longest, "m"), ("translation", longest, "m"), ("tension", MOST_TENSION, "N"),
        ("rotation", MOST_ROTATION, "rad"),
    ):  # fmt: skip
        for name, values in getattr(data, kind).items():
            worst = int(np.argmax(np.abs(values)))
            found = f"{values[worst]:.4g} {unit} in {data.row_name(worst)}"
            if abs(values[worst]) > most:
                found = f"{found} is more than a robot can take; is the unit right?"
                raise RobotError(f"{kind}.{name}", found, f"at most {most:.4g} {unit}", value=values)
            least = int(np.argmin(values))
            if kind == "tension" and values[least] < 0.0:
                found = f"{values[least]:.4g} N in {data.row_name(least)}"
                raise RobotError(f"tension.{name}", found, "at least 0 N: a tendon cannot push", value=values)


def _check_zeros(robot: Robot, data: Measurements, frees: Sequence[Free]) -> None:
    """A zero says where a tendon is tied: one that is zeroed anew wherever its tubes are has none."""
    zeros = [path for free in frees for path in free.paths if path.endswith(f".{ZERO}")]
    for path in zeros if data.rotation or data.translation else ():
        name = path.split(".", 1)[1].rpartition(".")[0]
        if robot.tendon(name).rest_length is None:
            found = "its tube moves in the data, and the tendon is zeroed anew at every place of it"
            raise RobotError(path, found, "a rest_length of the tendon (see tactr.rest_lengths)")


def _check_points(data: Measurements, frame: Frame, frees: Sequence[Free], reach: float) -> None:
    for k, place in enumerate(data.places):
        name, points = "tip" if place is None else f"at {place * 1e3:g} mm", data.points[:, k]
        if place is not None and place > reach * (1 + 1e-9):
            raise RobotError(
                name, f"the robot ends at {reach * 1e3:g} mm", "a point on the robot", value=place
            )
        points = points[np.isfinite(points).all(axis=1)]
        marker = 2 * float(np.linalg.norm(frame.marker)) + 0.5 * reach
        spread = float(np.ptp(points, axis=0).max(initial=0.0)) if len(points) else 0.0
        if spread > 2 * reach + marker:
            found = f"its points are up to {spread:.4g} m apart, but the robot is only {reach:.4g} m long"
            raise RobotError(f"{name}.x, y, z", found, "the unit of the columns; or leave out the outliers")
        moved = any(path.startswith("sensor") for free in frees for path in free.paths)
        far = float(np.abs(points - frame.position).max(initial=0.0))
        if not moved and far > reach + marker:
            expected = "sensor.x, sensor.y, sensor.z free, a frame, or other units"
            raise RobotError(
                f"{name}.x, y, z", f"{far:.4g} m from the guide, beyond the robot's reach", expected
            )


def after(model: Model, first: np.ndarray, found: Found, known: Knowledge, loss: str) -> list[Remark]:
    """first: points predicted at the start of the search."""
    data = model.measured
    missing = ~seen(found.residual)
    remarks = [
        *_missing(data, missing),
        *_spread(data, first),
        *_axes(data, first, found),
        *_outliers(data, found, loss),
        *_neighbours(found),
    ]
    if not found.converged:
        remarks.append(Remark("search-stopped", f"the search has not settled: {found.message}"))
    held = [free.name for free, at in zip(model.frees, found.held, strict=True) if at]
    if held:
        remarks.append(Remark("at-bound", f"{', '.join(held)}: the best value is a bound"))
    vague = [
        free.name for k, free in enumerate(model.frees) if not known.identifiable[k] and not found.held[k]
    ]
    if vague:
        remarks.append(
            Remark(
                "not-identifiable",
                f"the data do not tell {', '.join(vague)}; the calibrated robot has what the search left",
            )
        )
    return remarks


def _missing(data: Measurements, missing: np.ndarray) -> list[Remark]:
    if not missing.any():
        return []
    shown = ", ".join(data.row_name(int(i)) for i in np.flatnonzero(missing)[:8])
    text = f"{missing.sum()} of {len(data)} rows have no equilibrium in the model and do not count: {shown}"
    return [Remark("no-equilibrium", text)]


def _spread(data: Measurements, first: np.ndarray) -> list[Remark]:
    both = np.isfinite(first) & np.isfinite(data.points)
    own, model = (np.where(both, p, np.nan) for p in (data.points, first))
    wide, predicted = (float(np.nanmax(np.nanstd(p, axis=0))) for p in (own, model))
    if (
        len(data) < 3
        or (wide < UNLIKE * predicted and predicted < UNLIKE * wide)
        or max(wide, predicted) < 1e-4
    ):
        return []
    text = f"measured points spread by {wide:.3g} m, predicted ones at the start by {predicted:.3g} m: units?"
    return [Remark("units", text)]


def _axes(data: Measurements, first: np.ndarray, found: Found) -> list[Remark]:
    """Whether the points fit far better turned or mirrored, at the start of the search and at its end."""
    measured = data.points.reshape(-1, 3)
    for predicted in (first.reshape(-1, 3), (found.residual + data.points).reshape(-1, 3)):
        both = np.isfinite(predicted).all(axis=1) & np.isfinite(measured).all(axis=1)
        if both.sum() < 4:
            continue
        p, q = predicted[both], measured[both]
        left = float(np.sqrt(np.nanmean(found.residual**2)))
        turned, mirrored = (_left_over(p, q, mirror) for mirror in (False, True))
        if mirrored < BETTER * min(left, turned):
            text = "the points fit far better mirrored: one axis, or two exchanged, make it left-handed"
            return [
                Remark(
                    "left-handed-axes",
                    f"{text} ({mirrored * 1e3:.3g} mm left instead of {left * 1e3:.3g} mm)",
                )
            ]
        if turned < BETTER * left:
            text = "the points fit far better turned: free sensor.rx, sensor.ry, sensor.rz and its place"
            return [
                Remark("turned-axes", f"{text} ({turned * 1e3:.3g} mm left instead of {left * 1e3:.3g} mm)")
            ]
    return []


def _left_over(p: np.ndarray, q: np.ndarray, mirror: bool) -> float:
    """Root mean square of coordinates after the best shift and turn of p (mirrored) to q."""
    turn = best_turn(p, q, mirror=mirror)
    return float(np.sqrt(np.mean(((p - p.mean(axis=0)) @ turn.T - (q - q.mean(axis=0))) ** 2)))


def _outliers(data: Measurements, found: Found, loss: str) -> list[Remark]:
    error = distances(found.residual)
    median = float(np.nanmedian(error))
    far = np.flatnonzero(error > FAR * median)
    if not len(far) or median < 1e-9:
        return []
    order = far[np.argsort(-error[far])][:8]
    shown = ", ".join(f"{data.row_name(int(i))} ({error[i] * 1e3:.3g} mm)" for i in order)
    advice = (
        "a robust loss, such as huber, weighs them less" if loss == "linear" else "the loss weighs them less"
    )
    return [
        Remark("outliers", f"{len(far)} rows are {FAR:g} times as far off as the median: {shown}; {advice}")
    ]


def _neighbours(found: Found) -> list[Remark]:
    rows = found.residual.reshape(len(found.residual), -1)
    rows = rows[np.isfinite(rows).all(axis=1)]
    if len(rows) < 20 or not rows.any():
        return []
    rows = rows - rows.mean(axis=0)
    alike = float((rows[1:] * rows[:-1]).sum() / (rows**2).sum())
    if alike < ALIKE:
        return []
    less = np.sqrt((1 + alike) / (1 - alike))
    text = (
        f"errors of neighbouring rows are alike (correlation {alike:.2f}): the model misses something, and"
        f" standard errors, which take rows for independent, are too small by about {less:.1f}"
    )
    return [Remark("alike-errors", text)]
