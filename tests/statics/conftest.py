"""A robot with a little of everything, and its shape."""

from __future__ import annotations

import pytest

import tactr
from tactr import Annulus, DistributedLoad, Helix, Material, PointLoad, Robot, Straight, Tendon, Tube
from tactr.statics import Shape

NITINOL = Material(E=60e9, G=23e9)


@pytest.fixture(scope="session")
def robot() -> Robot:
    """Two precurved tubes, one pushed back; a tendon on each and one on whichever is outermost; two loads."""
    tubes = [
        Tube("outer", length=0.1, section=Annulus(0.0014, 0.0011), material=NITINOL, precurvature=(4, 0, 0)),
        Tube(
            "inner",
            length=0.2,
            section=Annulus(0.001, 0.0007),
            material=NITINOL,
            precurvature=(0, 6, 1),
            translation=-0.03,
            rotation=0.8,
        ),
    ]
    tendons = [
        Tendon("a", "outer", Straight(0.006, 0.0), tension=2.0),
        Tendon("b", "inner", Helix(0.005, 20.0), tension=1.0, end=0.15),
        Tendon("c", "inner", Straight(0.0, 0.005), host="outermost", tension=0.5),
    ]
    loads = [PointLoad("inner", force=(0.02, 0.0, -0.03)), DistributedLoad("outer", force=(0.0, 0.1, 0.0))]
    return Robot(tubes, tendons, loads, name="pair")


@pytest.fixture(scope="session")
def shape(robot: Robot) -> Shape:
    """Its shape."""
    return tactr.solve(robot)
