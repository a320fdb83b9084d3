"""Notched tubes: the wall left at a cut by numerical integration, and the series of cut and uncut lengths."""

import math
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import AsymmetricNotches, Material, PointLoad, Robot, RobotError, Stiffness, SymmetricNotches, Tube
from tactr.robot.notches import one_sided, two_sided

OUTER, INNER = 1.62e-3, 1.40e-3
NITINOL = Material(E=50e9, nu=0.3, density=6450)
NOTCHED: dict[str, Any] = {
    "outer_diameter": OUTER,
    "inner_diameter": INNER,
    "depth": 1.2e-3,
    "cut": 0.4e-3,
    "uncut": 0.6e-3,
}


def integrals(low: float, high: float) -> tuple[float, float, float, float]:
    """Area, first and second moments of the annulus between two chords y = low and y = high, by quadrature.

    The width of the wall at y has square-root ends at the radii: y = r sin(t) makes it smooth.
    """
    nodes, weights = np.polynomial.legendre.leggauss(200)
    sums = np.zeros(4)
    for radius, sign in ((OUTER / 2, 1.0), (INNER / 2, -1.0)):
        first, last = (math.asin(max(-1.0, min(1.0, y / radius))) for y in (low, high))
        t = first + (last - first) * (nodes + 1) / 2
        y, half, dy = radius * np.sin(t), radius * np.cos(t), radius * np.cos(t)
        f = np.array([2 * half, 2 * half * y, 2 * half * y**2, 2 * half**3 / 3])
        sums += sign * (f * dy) @ weights * (last - first) / 2
    area, moment, second, along = (float(number) for number in sums)
    return area, moment, second, along


@pytest.mark.parametrize("depth", [0.2e-3, 0.5e-3, 0.81e-3, 1.2e-3, 1.4e-3])
def test_wall_left_by_one_cut(depth: float) -> None:
    area, moment, second, along = integrals(-OUTER / 2, OUTER / 2 - depth)
    wall = one_sided(OUTER, INNER, depth)
    assert wall.area == pytest.approx(area, rel=1e-12)
    assert wall.centroid == pytest.approx(moment / area, rel=1e-11)
    assert wall.across == pytest.approx(second - moment**2 / area, rel=1e-9)
    assert wall.along == pytest.approx(along, rel=1e-12)


@pytest.mark.parametrize("depth", [0.2e-3, 0.5e-3, 0.7e-3])
def test_wall_left_by_two_cuts(depth: float) -> None:
    area, _, across, along = integrals(depth - OUTER / 2, OUTER / 2 - depth)
    wall = two_sided(OUTER, INNER, depth)
    assert (wall.area, wall.across, wall.along) == pytest.approx((area, across, along), rel=1e-11)
    assert wall.centroid == 0.0


def test_torsion_of_a_slit_tube() -> None:
    # nearly no cut: the open tube's J = 2 pi r t^3 / 3
    wall = one_sided(OUTER, INNER, 0.1101e-3)
    thickness, mean = (OUTER - INNER) / 2, (OUTER + INNER) / 4
    assert wall.torsion == pytest.approx(2 * math.pi * mean * thickness**3 / 3, rel=0.2)


@pytest.mark.parametrize("side", ["+x", "-x", "+y", "-y"])
@pytest.mark.parametrize("staggered", [False, True])
def test_the_equivalent_tube_bends_as_the_row_of_cuts(side: str, staggered: bool) -> None:
    """Against a tube with every cut described: 20 periods under a force and a moment at the tip."""
    notches = AsymmetricNotches(**NOTCHED, side=side, staggered=staggered)
    wall = notches.wall
    whole = tactr.Annulus(OUTER, INNER).stiffness(NITINOL)
    shear = NITINOL.shear_modulus

    def cut(sign: float) -> Stiffness:
        x, y = {"+x": (1, 0), "-x": (-1, 0), "+y": (0, 1), "-y": (0, -1)}[side]
        bending = (wall.along, wall.across) if x else (wall.across, wall.along)
        return Stiffness(
            EA=NITINOL.E * wall.area,
            GA=shear * wall.area,
            EI_x=NITINOL.E * bending[0],
            EI_y=NITINOL.E * bending[1],
            GJ=shear * wall.torsion,
            neutral_axis=(sign * wall.centroid * x, sign * wall.centroid * y),
        )

    pieces: list[Any] = [(0.0, whole)]
    for k in range(
        20
    ):  # cuts in the middle of their periods, sides + - - + when staggered: no lever is favoured
        pieces.append((k * 1e-3 + 0.3e-3, cut(-1.0 if staggered and k % 4 in (1, 2) else 1.0)))
        pieces.append((k * 1e-3 + 0.7e-3, whole))
    force, moment = (0.0, 0.0, -0.5), (1e-4, -2e-4, 3e-4)
    tips = []
    for section, material in ((pieces, None), (notches, NITINOL)):
        robot = Robot(
            [Tube("wrist", length=0.02, section=section, material=material)],
            loads=[PointLoad("wrist", force=force, moment=moment, axes="body")],
        )
        shape = tactr.solve(robot, tolerance=1e-10)
        tips.append((shape.tip_position, shape.tubes[0].frames[-1]))
    bent = np.linalg.norm(tips[1][0] - [0, 0, 0.02])
    assert bent > 1e-5
    assert np.linalg.norm(tips[0][0] - tips[1][0]) < 0.01 * bent
    np.testing.assert_allclose(tips[0][1], tips[1][1], atol=1e-4)


def test_neutral_axis_lies_away_from_the_cut() -> None:
    assert AsymmetricNotches(**NOTCHED, side="+y").stiffness(NITINOL).neutral_axis[1] < -0.5e-3
    assert AsymmetricNotches(**NOTCHED, side="-x").stiffness(NITINOL).neutral_axis[0] > 0.5e-3
    assert AsymmetricNotches(**NOTCHED, staggered=True).stiffness(NITINOL).neutral_axis == (0.0, 0.0)


def test_no_uncut_length_is_the_wall_alone() -> None:
    notches = AsymmetricNotches(**{**NOTCHED, "uncut": 0.0})
    k = notches.stiffness(NITINOL)
    assert k.EI_x == pytest.approx(50e9 * notches.wall.across, rel=1e-12)
    assert k.EA == pytest.approx(50e9 * notches.wall.area, rel=1e-9)
    assert k.neutral_axis[1] == pytest.approx(notches.wall.centroid, rel=1e-12)
    assert k.linear_density == pytest.approx(6450 * notches.wall.area, rel=1e-12)


def test_symmetric_notches_bend_easily_one_way() -> None:
    k = SymmetricNotches(**{**NOTCHED, "depth": 0.6e-3}, side="+x").stiffness(NITINOL)
    whole = tactr.Annulus(OUTER, INNER).stiffness(NITINOL)
    assert k.EI_y < 0.3 * k.EI_x < 0.3 * whole.EI_x
    assert k.neutral_axis == (0.0, 0.0)


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"depth": 0.1e-3}, "depth", "too small"),
        ({"depth": 1.55e-3}, "depth", "too large"),
        ({"cut": 0.0}, "cut", "above 0"),
        ({"uncut": -1e-3}, "uncut", "at least 0"),
        ({"side": "up"}, "side", "'\\+x'"),
        ({"inner_diameter": 2e-3}, "inner_diameter", "no wall"),
        ({"inner_diameter": 0.0}, "inner_diameter", "above 0"),
        ({"staggered": 1}, "staggered", "true or false"),
    ],
)
def test_bad_notches(change: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(RobotError, match=words) as caught:
        AsymmetricNotches(**{**NOTCHED, **change})
    assert caught.value.field == field


def test_symmetric_cuts_may_not_meet() -> None:
    with pytest.raises(RobotError, match="depth: 0.0009 m is too large"):
        SymmetricNotches(**{**NOTCHED, "depth": 0.9e-3})


def test_material_is_needed() -> None:
    with pytest.raises(RobotError, match="material: none is given"):
        Tube("wrist", length=0.02, section=AsymmetricNotches(**NOTCHED))
