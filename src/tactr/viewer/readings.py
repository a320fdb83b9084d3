"""What a shape says in numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.robot import Robot
from tactr.statics import Shape
from tactr.viewer.controls import Control
from tactr.viewer.session import Outcome


@dataclass(frozen=True, eq=False)
class Readings:
    """Numbers of a shape. tip (3,) m; direction (3,) of the tip's tangent; quaternion (4,) w first; margin of
    stability; residual; solve_time s; lengths and tensions of the tendons by name, m and N (tension None: a
    profile); slack: names."""

    tip: np.ndarray
    direction: np.ndarray
    quaternion: np.ndarray
    margin: float
    residual: float
    solve_time: float
    lengths: dict[str, float]
    tensions: dict[str, float | None]
    slack: tuple[str, ...]


def readings(shape: Shape) -> Readings:
    """The readings of a converged shape."""
    return Readings(
        tip=shape.tip_position,
        direction=shape.tip_orientation[:, 2],
        quaternion=shape.tip_quaternion,
        margin=shape.stability.margin,
        residual=shape.residual,
        solve_time=shape.solve_time,
        lengths={tendon.name: tendon.length for tendon in shape.tendons},
        tensions={
            tendon.name: float(tension) if isinstance(tendon.tension, float) else None
            for tendon, tension in zip(shape.robot.tendons, shape.tension, strict=True)
        },
        slack=shape.slack,
    )


def columns(robot: Robot, controls: Sequence[Control]) -> list[str]:
    """Heads of the columns of a record, with units."""
    moved = [f"{c.kind} {c.name} [{c.unit}]" for c in controls]
    tip = [f"tip {axis} [mm]" for axis in "xyz"] + [f"tip q{part}" for part in "wxyz"]
    lengths = [f"length {tendon.name} [mm]" for tendon in robot.tendons]
    tensions = [f"tension found {tendon.name} [N]" for tendon in robot.tendons]
    return ["time [s]", *moved, *tip, "stability margin", "residual", "solve time [ms]", *lengths, *tensions]


def row(time: float, outcome: Outcome, controls: Sequence[Control]) -> list[float]:
    """The values for ``columns`` at a time in s; NaN where the state has no shape."""
    state = outcome.state
    moved = [state.value(control) for control in controls]
    if outcome.shape is None or not outcome.fresh:
        return [time, *moved, *[np.nan] * (10 + 2 * len(state.robot.tendons))]
    found = readings(outcome.shape)
    return [
        time,
        *moved,
        *(1e3 * found.tip),
        *found.quaternion,
        found.margin,
        found.residual,
        1e3 * found.solve_time,
        *(1e3 * length for length in found.lengths.values()),
        *(np.nan if tension is None else tension for tension in found.tensions.values()),
    ]
