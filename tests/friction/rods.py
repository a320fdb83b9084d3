"""Robots for which friction between tubes has a closed form."""

from __future__ import annotations

import numpy as np

from tactr import DistributedLoad, Robot, Tube, TubeFriction
from tactr.friction.tube_state import TubeContact, TubeFrictionState
from tactr.friction.tube_step import Rubbed, TubeFrictionStep
from tactr.robot import Stiffness
from tactr.robot.robot import Numbers
from tactr.statics.solve import Prepared

LENGTH, GJ, EI = 0.12, 8e-3, 1e-2
RADIUS, COEFFICIENT, PRESS = 0.6e-3, 0.2, 30.0  # m, -, N/m
TORQUE = COEFFICIENT * RADIUS * PRESS  # N m/m
FULL = TORQUE * LENGTH**2 / (2.0 * GJ)  # rad, base ahead of the tip when all slides


def soft(factor: float = 1.0) -> Stiffness:
    return Stiffness(EA=1e5, GA=4e4, EI_x=factor * EI, EI_y=factor * EI, GJ=factor * GJ)


def pressed_rod(friction: TubeFriction | float | None = None, stiff: float = 1e6) -> Robot:
    """A straight tube pressed on an all but rigid one by an even force, its base at the guide's exit."""
    if friction is None:
        friction = TubeFriction(COEFFICIENT, RADIUS)
    return Robot(
        tubes=(
            Tube("outer", length=LENGTH, section=soft(stiff)),
            Tube("inner", length=LENGTH, section=soft(), friction=friction),
        ),
        loads=(DistributedLoad(tube="inner", force=(PRESS, 0.0, 0.0), axes="body"),),
    )


class Driven:
    """A robot led from one actuation to the next; with_models: each step takes over the model of the last."""

    def __init__(
        self, robot: Robot, *, cells: int = 8, tolerance: float = 1e-8, with_models: bool = True
    ) -> None:
        self.with_models = with_models
        self.prepared = Prepared(robot, tolerance=tolerance)
        self.step = TubeFrictionStep(robot, tolerance, self.prepared.residual_tolerance, cells)
        self.state: TubeFrictionState | None = None
        self.last: Rubbed | None = None

    def to(self, rotation: Numbers) -> Rubbed:
        actuated = self.prepared._actuated(None, rotation, None)
        assert not isinstance(actuated, Prepared)
        last = self.last
        guess = None if last is None else last.solution
        model = last.model if last is not None and self.with_models else None
        self.last = self.step(self.prepared._core, actuated.arrays, self.state, guess=guess, model=model)
        assert self.last.settled
        self.state = self.last.state
        return self.last

    @property
    def contact(self) -> TubeContact:
        """Of the inner tube."""
        assert self.state is not None
        return self.state.contact("inner")

    def tip_angle(self) -> float:
        """Of the inner tube in the outer one."""
        assert self.last is not None
        psi = self.last.solution.free_end_psi
        return float(psi[1] - psi[0])

    def turn(self, angles: np.ndarray) -> np.ndarray:
        """Angle of the inner tube's tip at each base angle."""
        return np.array([self.to(rotation={"inner": a}) and self.tip_angle() for a in angles])
