"""Shape and friction settle together where tendons run nearly straight, or just bear what they held before."""

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
