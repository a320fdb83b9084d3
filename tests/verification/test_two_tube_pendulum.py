"""Two precurved tubes: their relative angle is a pendulum's, a'' = c sin a, whatever their stiffness."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import Robot, Shape, Stiffness, Tube

LENGTH, NU = 0.1, 0.3
ANGLES = (60, 90, 120, 150, 170)
TABLE = {  # sqrt(c) L: angle at the tip in degrees for these angles at the base
    0.5: (54.127346, 82.878568, 113.488657, 146.071764, 168.614873),
    1.0: (40.327106, 63.566480, 91.667796, 128.967951, 161.700817),
    1.5: (26.467344, 41.783153, 60.599841, 87.706341, 121.521690),
}


def pair(size: float, angle: float, *, ratio: float = 3.0, behind: float = 0.0) -> Robot:
    """Two tubes of equal rest curvature k, size = sqrt(1 + nu) k L; behind: straight part in the guide, m."""
    k = size / LENGTH / math.sqrt(1 + NU)
    rest = [(0.0, (k, 0.0, 0.0))] if behind == 0.0 else [(0.0, (0.0, 0.0, 0.0)), (behind, (k, 0.0, 0.0))]
    tubes = [
        Tube(
            name,
            length=LENGTH + behind,
            translation=-behind,
            section=Stiffness(EA=1e4 * f, GA=4e3 * f, EI_x=1e-3 * f, EI_y=1e-3 * f, GJ=1e-3 * f / (1 + NU)),
            precurvature=rest,
            rotation=rotation,
        )
        for name, f, rotation in (("outer", 1.0, 0.0), ("inner", ratio, angle))
    ]
    return Robot(tubes)


@pytest.mark.parametrize("ratio", [0.3, 3.0])
@pytest.mark.parametrize("size", TABLE)
def test_relative_angle_at_the_tip(size: float, ratio: float) -> None:
    for angle, expected in zip(ANGLES, TABLE[size], strict=True):
        shape = tactr.solve(pair(size, math.radians(angle), ratio=ratio), tolerance=1e-10)
        assert math.degrees(shape.theta[1, -1]) == pytest.approx(expected, abs=1e-6)
        assert math.degrees(shape.theta[1, 0]) == pytest.approx(angle, abs=1e-7)


def test_tip_of_two_tubes_at_a_right_angle() -> None:
    shape = tactr.solve(pair(LENGTH * 8.770580 * math.sqrt(1 + NU), math.pi / 2), tolerance=1e-10)
    np.testing.assert_allclose(
        shape.tip_position, (0.033112489, -0.012085393, 0.091048082), rtol=0.0, atol=2e-9
    )


def test_turning_angle_keeps_the_energy_of_the_pendulum() -> None:
    """a'^2 / 2 + c cos a is the same at every station."""
    shape = tactr.solve(pair(1.5, math.radians(150)), tolerance=1e-10)
    rate = shape.tubes[1].u[:, 2] - shape.tubes[0].u[:, 2]
    energy = 0.5 * rate**2 + (1.5 / LENGTH) ** 2 * np.cos(shape.theta[1])
    np.testing.assert_allclose(energy, energy[-1], rtol=0.0, atol=1e-6 * (1.5 / LENGTH) ** 2)


def opposed(size: float, **options: float) -> Shape:
    """The shape in which the tubes stay opposed, stable or not: a cold start leaves it for a stable one."""
    gentle = tactr.solve(pair(0.1, math.pi, **options), tolerance=1e-10)
    return tactr.solve(pair(size, math.pi, **options), guess=gentle, tolerance=1e-10)


@pytest.mark.parametrize("size", [0.5, 1.0, 1.5, 1.57, 1.58, 2.0])
def test_opposed_tubes_lose_their_stability_at_a_right_angle(size: float) -> None:
    """Around a = pi the base turns cos(sqrt(c) L) times as far as the tip: not at all where they snap."""
    shape = opposed(size)
    np.testing.assert_allclose(shape.theta[1], math.pi, rtol=0.0, atol=1e-9)
    assert shape._solution.base_determinant == pytest.approx(math.cos(size), abs=1e-6)


@pytest.mark.parametrize("behind", [0.05, 0.2])
def test_a_straight_part_in_the_guide_brings_the_limit_nearer(behind: float) -> None:
    """cos x = (b / L) x sin x at the limit, that is, tan(sqrt(c) L) = 1 / (b sqrt(c))."""
    for size in (0.3, 0.8, 1.2):
        shape = opposed(size, behind=behind)
        expected = math.cos(size) - behind / LENGTH * size * math.sin(size)
        assert shape._solution.base_determinant == pytest.approx(expected, abs=1e-6)
