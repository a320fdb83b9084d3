"""Shape and friction settle together where tendons run nearly straight or just bear what they held."""

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, Material, Robot, Straight, Tendon, Tube

from .robots import legs

PULLS = np.array([3.143, 7.093])


def wound(precurvature: tuple[float, float, float], friction: float) -> Robot:
    """A thin stiff tube round a soft one, which a wound and a straight tendon bend against each other."""
    outer = Tube(
        "outer",
        length=0.1415,
        section=Annulus(1.183e-3, 1.001e-3),
        material=Material(E=60e9, nu=0.34),
        precurvature=precurvature,
        rotation=2.503,
    )
    inner = Tube(
        "inner",
        length=0.1556,
        section=Annulus(0.944e-3, 0.414e-3),
        material=Material(E=2.32e9, nu=0.37),
        precurvature=(-0.245, 3.473, 0.0),
        rotation=0.836,
    )
    tendons = [
        Tendon("wound", "inner", Helix(3.37e-3, -100.4, -0.609), friction=friction),
        Tendon("straight", "inner", Straight(2.114e-3, -0.805e-3), host="outermost", friction=friction),
    ]
    return Robot([outer, inner], tendons)


def out_of_step() -> np.ndarray:
    turn = np.linspace(0.0, 4.0 * np.pi, 81)[:14, None]
    return 0.7 + 0.3 * np.cos(turn + np.array([0.0, 2.0]))


@pytest.mark.parametrize(
    ("precurvature", "friction", "share"),
    [((0.0, 3.0, 0.0), 0.15, out_of_step()), ((3.0, 0.0, 0.0), 0.3, legs([0.0, 1.0, 0.4, 1.0], 20)[:, None])],
)
def test_every_point_settles(precurvature, friction, share):
    assert tactr.drive(wound(precurvature, friction), {"tension": share * PULLS}).converged


def curved_tubes(friction: float) -> Robot:
    """Three precurved tubes turned apart, with a tendon each."""
    rows = [
        (0.14, 1.35e-3, 1.07e-3, 65e9, 24.4e9, (2.0, 0.0, 0.0), 0.0),
        (0.187, 1.0e-3, 0.8e-3, 45e9, 16.91e9, (4.0, 1.0, 0.0), 0.6),
        (0.246, 0.7e-3, 0.4e-3, 215e9, 80e9, (0.0, 6.0, 0.0), 1.2),
    ]
    tubes = [
        Tube(
            f"tube {i}",
            length=length,
            section=Annulus(outer, inner),
            material=Material(E=E, G=G),
            precurvature=rest,
            rotation=angle,
        )
        for i, (length, outer, inner, E, G, rest, angle) in enumerate(rows)
    ]
    routings = Straight(0.0, 6.5e-3), Straight(-5.63e-3, 3.25e-3), Helix(6.5e-3, 3.0)
    tendons = [
        Tendon(f"tendon {i}", f"tube {i}", routing, friction=friction) for i, routing in enumerate(routings)
    ]
    return Robot(tubes, tendons)


@pytest.mark.parametrize("friction", [0.3, 0.35, 0.4, 0.45])
@pytest.mark.parametrize(("corners", "cuts"), [((2.0, 1.75), 3), ((2.0, 0.75, 1.75), 7)])
def test_displacements_back_and_forth(friction, corners, cuts):
    """As long as a front has only begun to move, the tendons' lengths hardly answer their tensions."""
    plain = curved_tubes(0.0)
    pulls = [
        tactr.solve(plain, tension=row).displacement for row in legs(corners, cuts)[:, None] * [3.0, 2.0, 1.0]
    ]
    driven = tactr.drive(curved_tubes(friction), {"displacement": np.array(pulls)})
    assert driven.converged
    assert max(shape.displacement_error for shape in driven) < 1e-7


def test_displacements_from_a_cold_start_after_a_reversal():
    """Next to a turning point no step from the point before is found; from cold, tensions may not leap."""
    robot = tactr.examples.load("three_tube_a")
    rows = legs([0.0, 1.0, 0.3], 20)[:23, None] * np.array([t.tension for t in robot.tendons])
    pulls = np.array([tactr.solve(robot, tension=row).displacement for row in rows])
    rubbing = robot.replace(tendons=tuple(replace(t, friction=0.2) for t in robot.tendons))
    driven = tactr.drive(rubbing, {"displacement": pulls})
    assert driven.converged
    assert max(shape.displacement_error for shape in driven) < 1e-7


@pytest.mark.parametrize("cuts", [5, 10])
def test_displacements_with_much_friction(cuts):
    """Next to a turning point the shortest step may not be found, but the rest of the way is."""
    robot = tactr.examples.load("three_tube_a")
    rows = legs([0.0, 1.0, 0.3], cuts)[: cuts + 2, None] * np.array([t.tension for t in robot.tendons])
    pulls = np.array([tactr.solve(robot, tension=row).displacement for row in rows])
    rubbing = robot.replace(tendons=tuple(replace(t, friction=0.4) for t in robot.tendons))
    assert tactr.drive(rubbing, {"displacement": pulls}).converged
