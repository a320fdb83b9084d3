"""Limits of stability known in closed form, to 0.1 % and better, and the determinant along the robot."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import root_scalar

import tactr
from tactr import Annulus, Material, PointLoad, Robot, Rod, Stiffness, Straight, Tendon, Tube
from tactr.statics import Shape, Stability

LENGTH, NU = 0.1, 0.3
ALLOWED = 1e-3  # what was promised; the limits come out to 1e-5


def find_root(f: Callable[[float], float], low: float, high: float, *, xtol: float = 1e-12) -> float:
    """The root of f between low and high."""
    return float(root_scalar(f, bracket=(low, high), xtol=xtol).root)


def opposed(size: float, *, behind: tuple[float, float] = (0.0, 0.0), beyond: float = 0.0) -> Robot:
    """Two tubes curved alike over LENGTH, turned to opposite sides, size = sqrt(c) L, c = (1 + nu) k^2.

    behind: straight parts in the guide, m; beyond: how much further the inner tube reaches, m.
    """
    k = size / LENGTH / math.sqrt(1 + NU)
    rows = (("outer", 1.0, 0.0, behind[0], 0.0), ("inner", 3.0, math.pi, behind[1], beyond))
    tubes = []
    for name, f, rotation, straight, more in rows:
        curved = (straight, (k, 0.0, 0.0))
        tubes.append(
            Tube(
                name,
                length=LENGTH + straight + more,
                translation=-straight,
                section=Stiffness(
                    EA=1e4 * f, GA=4e3 * f, EI_x=1e-3 * f, EI_y=1e-3 * f, GJ=1e-3 * f / (1 + NU)
                ),
                precurvature=[(0.0, (0.0, 0.0, 0.0)), curved] if straight else [(0.0, curved[1])],
                rotation=rotation,
            )
        )
    return Robot(tubes)


def opposed_shape(size: float, **options) -> Shape:
    """The shape in which the tubes stay opposed, stable or not: followed there from small curvature."""
    small = tactr.solve(opposed(0.1, **options), tolerance=1e-9)
    return tactr.solve(opposed(size, **options), guess=small, tolerance=1e-9)


def limit(stability: Callable[[float], Stability], low: float, high: float) -> float:
    """Where stability is lost, by bisection."""
    assert stability(low).stable and not stability(high).stable
    while high - low > 1e-6 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stability(middle).stable else (low, middle)
    return low


@pytest.mark.parametrize("behind", [(0.0, 0.0), (0.05, 0.05), (0.2, 0.2), (0.03, 0.15)])
def test_two_opposed_tubes(behind: tuple[float, float]) -> None:
    """tan(sqrt(c) L) = 1 / (b sqrt(c)); unequal straight parts count by their torsional compliance:
    b = (b_1 / GJ_1 + b_2 / GJ_2) / (1 / GJ_1 + 1 / GJ_2)."""
    b = (behind[0] + behind[1] / 3.0) / (1.0 + 1.0 / 3.0) / LENGTH
    expected = math.pi / 2
    if b > 0.0:
        expected = find_root(lambda x: math.cos(x) - b * x * math.sin(x), 1e-3, math.pi / 2)
    found = limit(lambda size: opposed_shape(size, behind=behind).stability, 0.5 * expected, 1.2 * expected)
    assert found == pytest.approx(expected, rel=1e-4)


def test_a_tube_that_reaches_further_changes_nothing() -> None:
    found = limit(lambda size: opposed_shape(size, beyond=0.04).stability, 1.0, 2.0)
    assert found == pytest.approx(math.pi / 2, rel=1e-4)


@pytest.mark.parametrize("size", [0.8, 1.5, 5.0, 9.0])
def test_determinant_of_opposed_tubes(size: float) -> None:
    """D(s) = cos(sqrt(c) (L - s)): it is zero at odd multiples of pi / 2."""
    stability = opposed_shape(size).stability
    x = size / LENGTH * (LENGTH - stability.s)
    np.testing.assert_allclose(stability.determinant, np.cos(x), rtol=0.0, atol=1e-5)
    zeros = [LENGTH - z * LENGTH / size for z in math.pi * (np.arange(8) + 0.5) if z < size]
    np.testing.assert_allclose(stability.conjugate_points, zeros[::-1], rtol=0.0, atol=1e-7)
    assert stability.stable is (size < math.pi / 2)
    assert stability.margin == pytest.approx(math.cos(min(size, math.pi)), abs=1e-2)


@pytest.mark.parametrize("behind", [0.02, 0.3])
def test_the_determinant_falls_evenly_in_the_guide(behind: float) -> None:
    stability = opposed_shape(0.6, behind=(behind, behind)).stability
    s, x = np.minimum(stability.s, 0.0), 0.6 / LENGTH * (LENGTH - np.maximum(stability.s, 0.0))
    expected = np.cos(x) + s * 0.6 / LENGTH * np.sin(x)
    np.testing.assert_allclose(stability.determinant, expected, rtol=0.0, atol=1e-6)
    assert stability.s[0] == pytest.approx(-behind) and stability.s[-1] == pytest.approx(LENGTH)


def rod(force: float, *, flat: float = 1.0) -> Robot:
    """A straight rod, force as a share of Euler's load; flat: EI_y over EI_x."""
    section = Stiffness(EA=1e7, GA=1e7, EI_x=1e-2, EI_y=1e-2 * flat, GJ=8e-3)
    euler = math.pi**2 * 1e-2 / (4 * LENGTH**2)
    loads = [PointLoad("rod", force=(0.0, 0.0, -force * euler))] if force else []
    return Robot([Tube("rod", length=LENGTH, section=section)], loads=loads)


def straight_shape(force: float, **options) -> Shape:
    """The straight rod, stable or not."""
    return tactr.solve(rod(force, **options), guess=tactr.solve(rod(0.1, **options)))


def test_euler() -> None:
    found = limit(lambda force: straight_shape(force).stability, 0.5, 1.5)
    assert found == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize(("force", "roots"), [(0.99, 0), (1.02, 2), (5.0, 2), (8.9, 2), (9.1, 4), (30.0, 6)])
def test_a_round_rod_buckles_both_ways_at_once(force: float, roots: int) -> None:
    """det = cos^2 never changes its sign: every conjugate point is double."""
    stability = straight_shape(force).stability
    assert len(stability.conjugate_points) == roots and stability.stable is (roots == 0)
    odd = np.repeat(2 * np.arange(roots // 2) + 1, 2)[::-1]
    np.testing.assert_allclose(
        stability.conjugate_points, LENGTH * (1 - odd / math.sqrt(force)), rtol=0.0, atol=1e-5
    )


@pytest.mark.parametrize("flat", [1.001, 1.5])
def test_a_flat_rod_buckles_one_way_first(flat: float) -> None:
    found = limit(lambda force: straight_shape(force, flat=flat).stability, 0.5, 1.2)
    assert found == pytest.approx(1.0, rel=1e-4)
    ways = [
        len(straight_shape(f, flat=flat).stability.conjugate_points)
        for f in (0.9995, 0.5 * (1 + flat), 1.1 * flat)
    ]
    assert ways == [0, 1, 2]


def test_without_loads_one_tube_is_stable() -> None:
    tube = Tube(
        "rod", length=0.2, section=Rod(1e-3), material=Material(E=54e9, nu=0.3), precurvature=(9, 3, 1)
    )
    shape = tactr.solve(Robot([tube], [Tendon("t", "rod", Straight(5e-3, 0.0), tension=3.0)]))
    assert shape.stability.stable and shape.stability.margin == 1.0
    assert repr(shape.stability) == "<Stability: stable, margin 1>"
    assert str(shape.stability) == "stable, margin 1"


def test_words() -> None:
    assert "near the limit" in str(opposed_shape(1.55).stability)
    assert "unstable (1 direction of" in str(opposed_shape(1.7).stability)
    assert repr(straight_shape(1.5).stability).count("18.35") == 2


def loaded(tension: float, force: float) -> Robot:
    """Two precurved tubes with a tendon and a force at the tip."""
    material = Material(E=60e9, nu=0.3)
    tubes = [
        Tube("outer", length=0.1, section=Annulus(1.4e-3, 1.1e-3), material=material, precurvature=(4, 0, 0)),
        Tube(
            "inner", length=0.15, section=Rod(0.9e-3), material=material, precurvature=(0, 6, 0), rotation=1.0
        ),
    ]
    tendon = Tendon("t", "inner", Straight(2e-3, 1e-3), tension=tension)
    return Robot(tubes, [tendon], [PointLoad("inner", force=(force, 0.02, -0.1))])


def test_energy_falls_by_the_work_of_a_force_and_rises_by_a_tendons_length() -> None:
    """At equilibrium dE/dlambda is the tendon's length and dE/dF minus the displacement of the tip."""
    shape = tactr.solve(loaded(1.0, 0.05), tolerance=1e-10)

    def slope(dt: float, df: float) -> float:
        high, low = (
            tactr.solve(loaded(1.0 + s * dt, 0.05 + s * df), guess=shape, tolerance=1e-10) for s in (1, -1)
        )
        return (high.potential_energy - low.potential_energy) / 2

    assert slope(1e-3, 0.0) / 1e-3 == pytest.approx(shape.tendons[0].length, rel=1e-5)
    assert slope(0.0, 1e-3) / 1e-3 == pytest.approx(-shape.tip_position[0], rel=1e-4)
