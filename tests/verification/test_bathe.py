"""The 45-degree bend (Bathe and Bolourchi): a curved beam loaded out of its plane, with shear and stretch."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import PointLoad, Robot, Stiffness, Tube

RADIUS = 100.0
CASES = [  # J, P, tip along the base tangent, in plane, out of plane
    (0.141, 300.0, (58.5405, 22.1152, 40.4748)),
    (0.141, 450.0, (51.9748, 18.3720, 48.7010)),
    (0.141, 600.0, (46.8968, 15.5603, 53.6049)),
    (1 / 6, 600.0, (47.1504, 15.6848, 53.4749)),
]
PRINTED = 5e-5  # half a unit of the last digit; relative to the tip's distance less than 1e-6


def bend(J: float, P: float) -> Robot:
    """Bends from z towards y: d3' = u_y d1 - u_x d2, so u_x = -1/R; loaded along x."""
    section = Stiffness(EA=1e7, GA=5e6, EI_x=1e7 / 12, EI_y=1e7 / 12, GJ=5e6 * J)
    tube = Tube("beam", length=RADIUS * math.pi / 4, section=section, precurvature=(-1.0 / RADIUS, 0.0, 0.0))
    return Robot([tube], loads=[PointLoad("beam", force=(P, 0.0, 0.0))])


@pytest.mark.parametrize(("J", "P", "tip"), CASES)
def test_tip_of_the_45_degree_bend(J: float, P: float, tip: tuple[float, float, float]) -> None:
    shape = tactr.solve(bend(J, P), tolerance=1e-6)
    assert shape.converged, shape.message
    x, y, z = shape.tip_position
    np.testing.assert_allclose((z, y, x), tip, rtol=0.0, atol=PRINTED)


def test_rest_shape_is_an_eighth_of_a_circle() -> None:
    tip = tactr.solve(bend(0.141, 0.0), tolerance=1e-6).tip_position
    half = math.sqrt(0.5)
    np.testing.assert_allclose(tip, (0.0, RADIUS * (1 - half), RADIUS * half), rtol=0.0, atol=1e-6)
