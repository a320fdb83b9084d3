"""The same actuation without friction and backlash, to compare with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.friction.state import DriveState
from tactr.robot import Robot, TensionProfile
from tactr.statics.shape import Shape
from tactr.statics.solve import Prepared


def without_friction(robot: Robot, states: Sequence[DriveState]) -> tuple[Shape | None, ...]:
    """Shapes of a robot at what its actuators were given, each from the one before; None at rest."""
    first = next((state.given for state in states if state.given is not None), None)
    if first is None:
        return (None,) * len(states)
    prepared, found, near = Prepared(robot, stations=2), [], None
    profiled = any(isinstance(t.tension, TensionProfile) for t in robot.tendons)
    for state in states:
        given = state.given
        if given is None:
            found.append(None)
            continue
        pulled = ~np.isnan(given.displacement)
        shape = prepared.solve(
            tension=None if profiled else np.where(pulled, 0.0, given.tension),
            rotation=given.rotation,
            translation=given.translation,
            displacement=given.displacement if pulled.any() else None,
            guess=near,
        )
        found.append(shape)
        near = shape if shape.converged else near
    return tuple(found)
