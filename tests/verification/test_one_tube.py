"""One tube against closed forms: constant curvature, and strains that follow from algebra alone."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, PolarPolynomial, Polynomial, Robot, Stiffness, Straight, Tendon, Tube
from tactr.materials import nitinol
from tactr.robot import Routing
from tactr.statics import Shape

SECTION = Annulus(0.001, 0.0008)
LENGTH = 0.14


def one_tube(*tendons: tuple[Routing, float], **changes: object) -> Robot:
    tube = Tube("tube", length=LENGTH, section=SECTION, material=nitinol, **changes)  # pyright: ignore
    return Robot([tube], [Tendon(f"{j}", "tube", r, tension=t) for j, (r, t) in enumerate(tendons)])


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi, -2.0])
def test_straight_tendon_bends_to_constant_curvature(angle: float) -> None:
    offset, tension = 0.0065, 3.0
    shape = tactr.solve(one_tube((Straight.polar(offset, angle), tension)), tolerance=1e-9)
    k = SECTION.stiffness(nitinol)
    curvature, stretch = tension * offset / k.EI_x, 1.0 - tension / k.EA
    across = stretch / curvature * (1.0 - math.cos(curvature * LENGTH))
    along = stretch / curvature * math.sin(curvature * LENGTH)
    expected = (across * math.cos(angle), across * math.sin(angle), along)
    np.testing.assert_allclose(shape.tip_position, expected, rtol=0.0, atol=1e-9)
    u = np.tile([-curvature * math.sin(angle), curvature * math.cos(angle), 0.0], (101, 1))
    np.testing.assert_allclose(shape.tubes[0].u, u, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(shape.tubes[0].v, np.tile([0.0, 0.0, stretch], (101, 1)), rtol=0.0, atol=1e-14)
    assert shape.tendons[0].length == pytest.approx((stretch - curvature * offset) * LENGTH, rel=1e-9)


def test_tip_turns_by_the_whole_bend() -> None:
    shape = tactr.solve(one_tube((Straight(0.0065, 0.0), 3.0)), tolerance=1e-9)
    bend = 3.0 * 0.0065 / SECTION.stiffness(nitinol).EI_x * LENGTH
    c, s = math.cos(bend), math.sin(bend)
    np.testing.assert_allclose(shape.tip_orientation, [[c, 0, s], [0, 1, 0], [-s, 0, c]], rtol=0.0, atol=1e-8)


ROUTINGS = {
    "helix": Helix(0.0065, 40.0, 0.3),
    "oblique line": Polynomial((0.005, -0.04), (0.001, 0.03)),
    "parabola": Polynomial((0.004, 0.0, -0.3), (0.0, 0.05)),
    "spiral": PolarPolynomial((0.006, -0.02), (0.2, 15.0, 60.0)),
}


@pytest.mark.parametrize("name", ROUTINGS)
@pytest.mark.parametrize("precurvature", [(0.0, 0.0, 0.0), (4.0, -6.0, 3.0)])
def test_strains_without_external_load_follow_from_algebra(
    name: str, precurvature: tuple[float, float, float]
) -> None:
    pulls = ((ROUTINGS[name], 2.5), (Straight(-0.003, 0.004), 1.0))
    robot = one_tube(*pulls, precurvature=precurvature, rotation=0.9)
    shape = tactr.solve(robot, tolerance=1e-9)
    n, m = tendon_pull(shape, robot)
    tube = shape.tubes[0]
    np.testing.assert_allclose(tube.n, -n, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(tube.m, -m, rtol=0.0, atol=1e-11)
    k = SECTION.stiffness(nitinol)
    np.testing.assert_allclose(tube.n, (tube.v - [0, 0, 1]) * [k.GA, k.GA, k.EA], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(
        tube.m, (tube.u - np.array(precurvature)) * [k.EI_x, k.EI_y, k.GJ], rtol=0.0, atol=1e-12
    )


def tendon_pull(shape: Shape, robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Force sum lambda t and moment sum lambda r x t of the tendons at the shape's strains, body axes."""
    tube = shape.tubes[0]
    n, m = np.zeros_like(tube.n), np.zeros_like(tube.m)
    for tendon, found in zip(robot.tendons, shape.tendons, strict=True):
        xy, slope = tendon.routing.evaluate(tube.sigma)
        r, dr = (np.column_stack([a, np.zeros(len(a))]) for a in (xy, slope))
        q = np.cross(tube.u, r) + dr + tube.v
        t = q / np.linalg.norm(q, axis=1, keepdims=True)
        n += found.tension[:, None] * t
        m += found.tension[:, None] * np.cross(r, t)
    return n, m


def test_helical_tendon_of_a_whole_turn_leaves_no_mean_bend_of_a_stiff_rod() -> None:
    """To first order the bends of one turn cancel, and only the lean of the first half turn stays: the
    curvature is kappa (-sin, cos)(omega s) about (x, y), so that the tip is at (0, kappa L / omega)."""
    EI, offset, tension, rate = 1.0, 0.01, 1e-3, 2 * math.pi
    section = Stiffness(EA=1e9, GA=1e9, EI_x=EI, EI_y=EI, GJ=1e9)
    robot = Robot(
        [Tube("rod", length=1.0, section=section)], [Tendon("t", "rod", Helix(offset, rate), tension=tension)]
    )
    x, y, _ = tactr.solve(robot, tolerance=1e-12).tip_position
    slope = math.hypot(1.0, offset * rate)
    kappa = tension * offset / EI / slope
    np.testing.assert_allclose((x, y), (0.0, kappa / rate), rtol=0.0, atol=1e-3 * kappa)
