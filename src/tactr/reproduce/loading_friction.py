"""What friction of the tendons would do to the loading experiment; its coefficient is assumed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tactr.friction import drive
from tactr.reproduce.records import Effect, Move
from tactr.robot import Robot

COEFFICIENT = 0.15
COLOURS = ("#4A1486", "#B39B00")  # loading, unloading: none of a tube; dark and light, so safe for all eyes
STATIONS = 2

REASON = (
    "not printed, and the paper's model has no friction: a value for metal wires in holes of plastic. "
    "Channels all along, as in the paper's model, not disks"
)


@dataclass(frozen=True, eq=False)
class Loop:
    """tensions (k, 2) N; tips (k, 3) m at them when loading and unloading, and without friction."""

    tensions: np.ndarray
    loading: np.ndarray
    unloading: np.ndarray
    without: np.ndarray

    def part(self, rows: slice) -> Loop:
        """Some of the tensions."""
        return Loop(self.tensions[rows], self.loading[rows], self.unloading[rows], self.without[rows])

    def error(self, tips: np.ndarray) -> np.ndarray:
        """Distance from the model without friction, (k,), m."""
        return np.linalg.norm(tips - self.without, axis=1)

    @property
    def width(self) -> np.ndarray:
        """How far both ways are apart, (k,), m."""
        return np.linalg.norm(self.unloading - self.loading, axis=1)


def with_friction(robot: Robot, coefficient: float) -> Robot:
    """Tendons that rub along their channels."""
    tendons = [replace(tendon, friction=coefficient) for tendon in robot.tendons]
    return robot.replace(tendons=tuple(tendons))


def loop_of(robot: Robot, up: np.ndarray) -> Loop:
    """Loaded along tensions (k, 2) and back."""
    path = {"tension": np.vstack([up, up[-2::-1]])}
    driven = drive(with_friction(robot, COEFFICIENT), path, stations=STATIONS)
    tips, without = driven.tips, driven.before(len(up)).frictionless_tips()
    return Loop(up, tips[: len(up)], tips[len(up) - 1 :][::-1], without)


def friction_effect(robot: Robot, loop: Loop) -> Effect:
    """How far the loaded tip moves for half the coefficient and twice it."""
    corner = int(np.argmax(loop.tensions[:, 1] > 0.0)) - 1
    path = {"tension": loop.tensions[[0, corner, -1]]}
    tips = [
        drive(with_friction(robot, factor * COEFFICIENT), path, stations=STATIONS).tips[-1]
        for factor in (0.5, 2.0)
    ]
    less, more = (float(np.linalg.norm(tip - loop.loading[-1])) for tip in tips)
    move = Move("OT 3 N, IT 2 N, loading", None, less, more)
    return Effect(
        "friction of the tendons on their channels",
        ("tendons[0].friction", "tendons[1].friction"),
        REASON,
        f"{COEFFICIENT:g}",
        "half and twice",
        (move,),
    )
