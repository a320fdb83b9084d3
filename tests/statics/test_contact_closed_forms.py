"""Contact between two tubes against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import DistributedLoad, PointLoad, Robot, Stiffness, Straight, Tendon, Tube
from tactr.statics import Contact

LENGTH, NU = 0.1, 0.3


def tube(name: str, scale: float, **options) -> Tube:
    section = Stiffness(
        EA=1e4 * scale, GA=4e3 * scale, EI_x=1e-3 * scale, EI_y=1e-3 * scale, GJ=1e-3 * scale / (1 + NU)
    )
    return Tube(name, **({"length": LENGTH, "section": section} | options))


def contact(robot: Robot) -> Contact:
    (found,) = tactr.solve(robot, tolerance=1e-11).contacts
    assert (found.outer, found.inner) == ("outer", "inner")
    return found


def test_aligned_tubes_touch_at_their_ends_only() -> None:
    """Both bend to the mean of k1, k2 weighted by EI; the inner then carries EI2 (kappa - k2) from end to
    end, and nothing but moments at its ends keeps it bent."""
    k1, k2, f = 3.0, 11.0, 0.4
    found = contact(
        Robot([tube("outer", 1.0, precurvature=(k1, 0, 0)), tube("inner", f, precurvature=(k2, 0, 0))])
    )
    moment = 1e-3 * f * ((k1 + f * k2) / (1 + f) - k2)
    np.testing.assert_allclose(found.force, 0.0, atol=1e-9)
    np.testing.assert_allclose(found.moment, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.points.s, [0.0, LENGTH], atol=1e-15)
    np.testing.assert_allclose(found.points.moment, [[-moment, 0, 0], [moment, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(found.points.force, 0.0, atol=1e-12)


def test_a_shorter_inner_tube_presses_at_its_tip() -> None:
    found = contact(
        Robot([tube("outer", 1.0), tube("inner", 0.5, length=0.06, precurvature=(0.0, 8.0, 0.0))])
    )
    moment = 1e-3 * 0.5 * (0.5 * 8.0 / 1.5 - 8.0)
    np.testing.assert_allclose(found.points.s, [0.0, 0.06], atol=1e-15)
    np.testing.assert_allclose(found.points.moment[1], (0.0, moment, 0.0), atol=1e-12)


@pytest.mark.parametrize("angle", [60, 120, 170])
def test_turned_tubes_exchange_moment_like_a_pendulum(angle: float) -> None:
    """Of two equal tubes with relative angle a each turns by a/2 from a frame that does not twist, in which
    kappa = k cos(a/2) e1 and M_2 = -EI k sin(a/2) e2 + GJ a'/2 e3; the balance of moments leaves
    (EI + GJ) k cos(a/2) |a'|/2, and a'^2/2 = c (cos a_tip - cos a), c = (1 + nu) k^2."""
    k = 1.5 / LENGTH / math.sqrt(1 + NU)
    tubes = [
        tube("outer", 1.0, precurvature=(k, 0, 0)),
        tube("inner", 1.0, precurvature=(k, 0, 0), rotation=math.radians(angle)),
    ]
    shape = tactr.solve(Robot(tubes), tolerance=1e-11)
    (found,) = shape.contacts
    a = shape.theta[1]
    rate = k * np.sqrt(2 * (1 + NU) * np.abs(np.cos(a[-1]) - np.cos(a)))
    expected = 1e-3 * (1 + 1 / (1 + NU)) * k * np.cos(a / 2) * rate / 2
    size = expected.max()
    assert size > 1e-3
    np.testing.assert_allclose(np.linalg.norm(found.moment, axis=1), expected, rtol=0.0, atol=1e-6 * size)
    np.testing.assert_allclose(found.force, 0.0, atol=1e-7)


def test_shear_is_shared_by_shear_stiffness_and_bending_by_bending_stiffness() -> None:
    """Straight tubes under a small load q on the outer one: the inner carries the share GA_2 / sum of q; its
    own shear force does the same to its moment, of which the share is EI_2 / sum: the contact moment
    -(M_2' + e3 x N_2) = q (L - s) (EI_2 / sum - GA_2 / sum) fills the gap."""
    q, section = 1e-4, Stiffness(EA=1e4, GA=4e3, EI_x=2e-3, EI_y=2e-3, GJ=1e-3)
    found = contact(
        Robot(
            [tube("outer", 1.0), Tube("inner", length=LENGTH, section=section)],
            loads=[DistributedLoad("outer", force=(q, 0.0, 0.0))],
        )
    )
    np.testing.assert_allclose(found.force[:, 0], q / 2, rtol=1e-6)
    np.testing.assert_allclose(
        found.moment[:, 1], q * (LENGTH - found.s) * (2 / 3 - 1 / 2), rtol=1e-6, atol=1e-12
    )


def test_a_tip_force_reaches_the_outer_tube_where_both_end() -> None:
    force = 1e-4
    found = contact(
        Robot([tube("outer", 1.0), tube("inner", 3.0)], loads=[PointLoad("inner", force=(force, 0, 0))])
    )
    tilt = force * LENGTH**2 / (2 * 4e-3)  # of the axis, across which contact acts
    np.testing.assert_allclose(found.points.force[-1], (-force / 4, 0.0, force / 4 * tilt), atol=1e-11)
    np.testing.assert_allclose(found.points.force[0], (-3 * force / 4, 0.0, 0.0), atol=1e-11)


def test_a_tendon_on_the_outer_tube_bends_the_inner_by_its_ends() -> None:
    """The tendon's own press lambda kappa is carried by the tube that guides it: the inner tube keeps its
    share EI_2 kappa of the moment lambda r from the exit to its tip."""
    tension, r, f = 0.5, 0.005, 0.25
    tendon = Tendon("t", "outer", Straight(r, 0.0), tension=tension)
    found = contact(Robot([tube("outer", 1.0), tube("inner", f)], [tendon]))
    moment = tension * r * f / (1 + f)
    np.testing.assert_allclose(found.moment, 0.0, atol=1e-12)
    np.testing.assert_allclose(found.force, 0.0, atol=1e-9)
    np.testing.assert_allclose(found.points.moment[0], (0.0, -moment, 0.0), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found.points.moment[1]), moment, rtol=1e-9)
