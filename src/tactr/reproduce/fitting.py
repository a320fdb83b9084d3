"""Choosing one number of a robot so that its tip moves as far from rest as printed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.errors import NotConverged
from tactr.reproduce.records import Fit
from tactr.robot import Robot
from tactr.statics import Shape, solve
from tactr.statics.parameters import value_of, with_values

MET = 1e-9  # m
MOST_STEPS = 30

Direction = Sequence[str]
"""Paths whose numbers are scaled by one factor."""


def displacement(shape: Shape) -> float:
    """How far the tip is from where it is at rest without tensions, m. Raises NotConverged."""
    return float(np.linalg.norm(shape.tip_position - _rest(shape.robot)))


def scaled(robot: Robot, paths: Direction, factor: float) -> Robot:
    """The robot with the numbers at the paths times a factor. Raises RobotError."""
    return with_values(robot, {path: factor * value_of(robot, path) for path in paths})


def fit(
    robot: Robot, what: str, paths: Direction, target: float, *, within: float, used: bool = False
) -> Fit:
    """The factor on the numbers at the paths for which the tip moves by `target` (m) from rest, by Newton's
    method with exact derivatives. within: m, how far the target itself may be off. Raises NotConverged."""
    factor, met = _factor(robot, paths, target)
    less, more = (_factor(robot, paths, target + sign * within)[0] for sign in (-1.0, 1.0))
    start = value_of(robot, paths[0])
    span = (min(less, more) * start, max(less, more) * start)
    return Fit(what, paths[0], start, factor * start, target, met, within, span, used)


def _factor(robot: Robot, paths: Direction, target: float) -> tuple[float, float]:
    factor = 1.0
    for _ in range(MOST_STEPS):
        moved = scaled(robot, paths, factor)
        shape = solve(moved)
        reached = displacement(shape)
        if abs(reached - target) < MET:
            return factor, reached
        away = (shape.tip_position - _rest(moved)) / reached
        rates = shape.sensitivity(paths)[:3] @ [value_of(robot, path) for path in paths]
        factor += (target - reached) / float(away @ rates)
    raise NotConverged(f"no factor on {', '.join(paths)} moves the tip by {1e3 * target:.2f} mm")


def _rest(robot: Robot) -> np.ndarray:
    """The tip without tensions; for robots whose tubes are straight, on the guide's axis."""
    return np.array([0.0, 0.0, max(tube.tip for tube in robot.tubes)])
