"""The same actuation without friction and backlash, to compare with."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.friction.actuators import Actuators
from tactr.friction.state import DriveState
from tactr.robot import Robot, TensionProfile
from tactr.statics.shape import Shape
from tactr.statics.solve import Prepared


def plain_shape(prepared: Prepared, given: Actuators, guess: Shape | None = None) -> Shape:
    """The shape at an actuation, without friction."""
    profiled = any(isinstance(t.tension, TensionProfile) for t in prepared.robot.tendons)
    pulled = ~np.isnan(given.displacement)
    return prepared.solve(
        tension=None if profiled else np.where(pulled, 0.0, given.tension),
        rotation=given.rotation,
        translation=given.translation,
        displacement=given.displacement if pulled.any() else None,
        guess=guess,
    )


def without_friction(robot: Robot, states: Sequence[DriveState]) -> tuple[Shape | None, ...]:
    """Shapes of a robot at what its actuators were given, each from the one before; None at rest."""
    first = next((state.given for state in states if state.given is not None), None)
    if first is None:
        return (None,) * len(states)
    prepared, found, near = Prepared(robot, stations=2), [], None
    for state in states:
        shape = None if state.given is None else plain_shape(prepared, state.given, near)
        found.append(shape)
        near = shape if shape is not None and shape.converged else near
    return tuple(found)
