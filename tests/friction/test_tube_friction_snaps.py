"""Tubes that would snap, held by friction; and friction of tubes and tendons in one robot."""

from __future__ import annotations

import numpy as np
import pytest

import tactr
from tactr import Annulus, Robot, Straight, Tendon, Tube, TubeFriction, materials
from tactr.friction.tube_step import TubeFrictionStep
from tactr.statics.solve import Prepared

from .rods import LENGTH, RADIUS, soft


def opposed(friction: float) -> Robot:
    """Two curved tubes, alike, that snap when the inner one is turned far enough."""
    tube = Tube("outer", length=LENGTH, section=soft(), precurvature=(12.0, 0.0, 0.0))
    inner = Tube(
        "inner",
        length=LENGTH,
        section=soft(),
        precurvature=(12.0, 0.0, 0.0),
        friction=TubeFriction(friction, RADIUS, 3e-3) if friction else None,
    )
    return Robot(tubes=(tube, inner))


def snap_angle(robot: Robot, angles: np.ndarray) -> float:
    driven = tactr.drive(robot, [{"rotation": {"inner": float(a)}} for a in angles], stations=2)
    assert driven.converged, driven.message
    psi = np.array([shape.tubes[1].psi[-1] - shape.tubes[0].psi[-1] for shape in driven])
    return float(angles[int(np.argmax(np.abs(np.diff(psi)))) + 1])


def test_friction_puts_a_snap_off() -> None:
    up = np.linspace(2.6, 4.4, 19)
    free, rough = snap_angle(opposed(0.0), up), snap_angle(opposed(0.3), np.concatenate([[0.0, 1.3], up]))
    assert free == pytest.approx(3.2, abs=0.11)  # just beyond half a turn
    assert rough > free + 0.25


def test_places_that_hold_keep_an_unstable_shape() -> None:
    """At half a turn the tubes opposed all along are an equilibrium that falls over; held all along by
    friction it cannot."""
    robot = opposed(0.3)
    prepared = Prepared(robot)
    unstable = [shape for shape in prepared.branches(rotation=[0.0, np.pi]) if not shape.stable]
    assert len(unstable) == 1
    step = TubeFrictionStep(robot, prepared.tolerance, prepared.residual_tolerance)
    arrays = np.zeros(0), np.array([0.0, np.pi]), np.zeros(2)
    first = step(prepared._core, arrays, None, guess=unstable[0]._solution, stay=True)
    again = step(prepared._core, arrays, first.state, guess=first.solution, stay=True)
    assert first.settled and again.settled
    assert again.held == len(unstable[0].stability.conjugate_points) == 1
    slippery = TubeFrictionStep(opposed(0.0), prepared.tolerance, prepared.residual_tolerance)
    assert slippery(prepared._core, arrays, None, guess=unstable[0]._solution, stay=True).held == 0


def test_tubes_and_tendons_rub_in_one_robot() -> None:
    """Three tubes, one with a tendon that rubs: both take energy, and the way back is another."""
    tubes = [
        Tube(
            name,
            length=0.14 + 0.05 * k,
            section=Annulus(2.6e-3 - 0.6e-3 * k, 2.2e-3 - 0.6e-3 * k),
            material=materials.nitinol,
            precurvature=(5.0 + k, 0.0, 0.0),
            translation=-0.02 * k,
            friction=0.1,
        )
        for k, name in enumerate(("outer", "middle", "inner"))
    ]
    robot = Robot(tubes, [Tendon("tendon", "inner", Straight(0.0, 0.3e-3), friction=0.2)])
    way = [(0.0, 0.5), (0.6, 2.0), (1.0, 4.0), (0.6, 2.0)]
    path = [{"rotation": {"inner": a, "middle": -a}, "tension": {"tendon": t}} for a, t in way]
    driven = tactr.drive(robot, path, stations=2)
    assert driven.converged, driven.message
    assert (driven.tube_heat[1:, 1:].sum(axis=0) > 0.0).all() and driven.heat[1:].sum() > 0.0
    assert np.linalg.norm(driven.tips[3] - driven.tips[1]) > 1e-4
    assert driven.state.rubbing is not None
    assert {contact.outer for contact in driven.state.rubbing.contacts} == {None, "outer", "middle"}
