"""A slender cantilever under a dead load at its tip: the elastica, neither stretched nor sheared."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import PointLoad, Robot, Stiffness, Tube
from tactr.robot.load import Axes

RIGID = 1e12  # axial and shear stiffness, N, where PL^2/EI is of the order 1
TABLE = {  # P L^2 / EI: deflection w/L, shortening u/L, tip angle
    1.0: (0.30172077, 0.05643324, 0.46135195),
    2.0: (0.49345748, 0.16064172, 0.78174983),
    5.0: (0.71379152, 0.38762836, 1.21536812),
    10.0: (0.81060902, 0.55499560, 1.43028554),
}


def cantilever(load: PointLoad, *, length: float = 1.0, EI: float = 1.0) -> Robot:
    section = Stiffness(EA=RIGID, GA=RIGID, EI_x=EI, EI_y=EI, GJ=EI)
    return Robot([Tube("rod", length=length, section=section)], loads=[load])


@pytest.mark.parametrize("load", TABLE)
@pytest.mark.parametrize("direction", [0.0, 2.0])
def test_table_of_the_elastica(load: float, direction: float) -> None:
    c, s = math.cos(direction), math.sin(direction)
    shape = tactr.solve(cantilever(PointLoad("rod", force=(load * c, load * s, 0.0))), tolerance=1e-9)
    x, y, z = shape.tip_position
    w, u, angle = TABLE[load]
    assert x * c + y * s == pytest.approx(w, abs=1e-8)
    assert y * c - x * s == pytest.approx(0.0, abs=1e-8)
    assert 1.0 - z == pytest.approx(u, abs=1e-8)
    assert math.acos(shape.tip_orientation[2, 2]) == pytest.approx(angle, abs=1e-8)


def test_shape_depends_on_the_load_number_only() -> None:
    """A rod of 0.2 m and 0.003 N m^2 under the force of load number 5."""
    shape = tactr.solve(
        cantilever(PointLoad("rod", force=(5.0 * 0.003 / 0.2**2, 0.0, 0.0)), length=0.2, EI=0.003),
        tolerance=1e-9,
    )
    w, u, _ = TABLE[5.0]
    np.testing.assert_allclose(shape.tip_position, (0.2 * w, 0.0, 0.2 * (1.0 - u)), rtol=0.0, atol=5e-9)


@pytest.mark.parametrize("axes", ["world", "body"])
def test_moment_of_2_pi_EI_over_L_closes_a_circle(axes: Axes) -> None:
    shape = tactr.solve(
        cantilever(PointLoad("rod", moment=(0.0, 2 * math.pi, 0.0), axes=axes)), tolerance=1e-9, stations=5
    )
    np.testing.assert_allclose(shape.tip_position, 0.0, atol=1e-8)
    r = 1.0 / (2 * math.pi)
    quarters = [(0, 0, 0), (r, 0, r), (2 * r, 0, 0), (r, 0, -r), (0, 0, 0)]
    np.testing.assert_allclose(shape.centreline, quarters, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(shape.tip_orientation, np.eye(3), rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("load", [100.0, 200.0])
@pytest.mark.parametrize("angle", [0.7, 1.6, 2.5, 3.0])
def test_hanging_from_a_large_force(load: float, angle: float) -> None:
    """A long rod bends into the force's direction next to the clamp and is straight from there on, up to a
    share exp(-k): sin(phi / 2) = sech(k s + c), k = sqrt(P / EI), the pendulum that comes to rest upside
    down."""
    c, s = math.cos(angle), math.sin(angle)
    along, aside = np.array([0.8 * s, 0.6 * s, c]), np.array([-0.8 * c, -0.6 * c, s])
    k = math.sqrt(load)
    shape = tactr.solve(cantilever(PointLoad("rod", force=tuple(load * along))))
    assert shape.converged and shape.stable
    tip = (1.0 - 2.0 / k * (1.0 - math.cos(0.5 * angle))) * along + 2.0 / k * math.sin(0.5 * angle) * aside
    np.testing.assert_allclose(shape.tip_position, tip, rtol=0.0, atol=1e-6 + 8.0 * math.exp(-k))
