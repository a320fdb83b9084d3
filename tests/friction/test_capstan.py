"""Tensions along a tendon against Euler's and Eytelwein's formula, in closed form."""

import math

import numpy as np
import pytest

import tactr
from tactr import Helix, Polynomial, Robot, Straight, Tendon, Tube
from tactr.robot.friction import FrictionLike

from .robots import STIFF, bending

ARC = math.pi / 2
MU = 0.3


def drive(robot, path, **options):
    return tactr.drive(robot, path, tolerance=1e-11, **options)


def arc(friction: FrictionLike = MU, **fields):
    """Too stiff to bend; precurved to a quarter of a circle."""
    return bending(friction, material=STIFF, precurvature=(ARC / 0.2, 0.0, 0.0), **fields)


def test_one_tendon_round_an_arc():
    driven = drive(arc(), {"tension": [[5.0]]})
    sigma = np.linspace(0.0, 0.2, 21)
    assert driven.state.tension("up", sigma) == pytest.approx(5.0 * np.exp(-MU * ARC * sigma / 0.2), rel=1e-9)


def test_the_shape_carries_that_tension():
    (tendon,) = drive(arc(), {"tension": [[5.0]]})[0].tendons
    assert tendon.tension == pytest.approx(5.0 * np.exp(-MU * ARC * tendon.s / 0.2), rel=1e-9)


def test_the_whole_cone_is_crossed_in_the_dead_band():
    """Reversal: nothing moves at the end until the base has come down to exp(-2 mu angle)."""
    edge = 5.0 * math.exp(-2 * MU * ARC)
    driven = drive(arc(), {"tension": [[5.0], [4.0], [1.02 * edge], [0.9 * edge]]})
    tip = [float(state.tension("up", 0.2)[0]) for state in driven.states]
    held = 5.0 * math.exp(-MU * ARC)
    assert tip[:3] == pytest.approx([held] * 3, rel=1e-9)
    assert tip[3] == pytest.approx(0.9 * edge * math.exp(MU * ARC), rel=1e-9)


def test_the_front_of_a_reversal():
    """5 exp(-mu angle) falling meets 4 exp(mu angle) rising where exp(2 mu angle) = 5/4."""
    state = drive(arc(), {"tension": [[5.0], [4.0]]}).state
    front = 0.2 * math.log(5 / 4) / (2 * MU * ARC)
    assert list(state.stuck("up", [front - 1e-6, front + 1e-6])) == [False, True]
    assert state.tension("up", [0.5 * front]) == pytest.approx(4.0 * math.exp(MU * ARC * 0.5 * front / 0.2))


def test_coefficients_in_pieces():
    rough = arc([(0.0, 0.1), (0.05, 0.4)])
    angle = 0.1 * ARC / 4 + 0.4 * ARC * 3 / 4
    found = drive(rough, {"tension": [[2.0]]}).state.tension("up", [0.2])
    assert found == pytest.approx(2.0 * math.exp(-angle), rel=1e-9)


def test_disks_bear_the_turn_between_spans():
    """Chords of a circle between disks every 40 mm: half a step's turn at the first, then a whole one."""
    robot = arc(contacts=[0.04, 0.08, 0.12, 0.16])
    tension = drive(robot, {"tension": [[5.0]]}).state.tension("up", [0.02, 0.06, 0.1, 0.14, 0.18])
    assert tension == pytest.approx(5.0 * np.exp(-MU * ARC / 5 * np.arange(5)), rel=1e-9)


def test_a_disk_at_the_base():
    robot = arc(contacts=[0.0, 0.1])
    tension = drive(robot, {"tension": [[5.0]]}).state.tension("up", [0.05, 0.15])
    assert tension == pytest.approx(5.0 * np.exp(-MU * ARC * np.array([0.25, 0.75])), rel=1e-9)


def test_a_helix_round_a_straight_tube():
    """Its direction makes the angle atan(r w) with the axis and turns by sin(that) w per length."""
    rate, radius = 2 * math.pi / 0.05, 1.2e-3
    tube = Tube("tube", length=0.2, section=tactr.Annulus(2e-3, 1.6e-3), material=STIFF)
    robot = Robot([tube], [Tendon("wound", "tube", Helix(radius, rate), friction=MU)])
    turn = rate * radius / math.hypot(1.0, rate * radius) * rate * 0.2
    found = drive(robot, {"tension": [[3.0]]}).state.tension("wound", [0.2])
    assert found == pytest.approx(3.0 * math.exp(-MU * turn), rel=1e-8)


def test_a_tendon_that_turns_one_way_and_then_the_other():
    """y = y0 + c (sigma - inflection)^3 makes the angle atan(3 c (sigma - inflection)^2) with the axis: how
    much it turns has a cusp where the angle is 0."""
    inflection, c = 0.0713, 0.2
    cubic = (1e-3 - c * inflection**3, 3.0 * c * inflection**2, -3.0 * c * inflection, c)
    tube = Tube("tube", length=0.2, section=tactr.Annulus(2e-3, 1.6e-3), material=STIFF)
    robot = Robot([tube], [Tendon("bent", "tube", Polynomial(x=(1e-3,), y=cubic), friction=MU)])
    sigma = np.linspace(0.0, 0.2, 41)
    angle = np.arctan(3.0 * c * (sigma - inflection) ** 2)
    turned = angle[0] + np.where(sigma < inflection, -angle, angle)
    found = drive(robot, {"tension": [[3.0]]}).state.tension("bent", sigma)
    assert found == pytest.approx(3.0 * np.exp(-MU * turned), rel=1e-10)


def test_behind_the_guide_a_straight_tendon_does_not_rub():
    tube = Tube(
        "tube",
        length=0.2,
        section=tactr.Annulus(2e-3, 1.6e-3),
        material=STIFF,
        precurvature=(ARC / 0.2, 0.0, 0.0),
        translation=-0.05,
    )
    robot = Robot([tube], [Tendon("up", "tube", Straight(0, 1.2e-3), friction=MU)])
    found = drive(robot, {"tension": [[5.0]]}).state.tension("up", [0.05, 0.2])
    assert found == pytest.approx([5.0, 5.0 * math.exp(-MU * ARC * 0.75)], rel=1e-9)


def test_monotone_loading_gives_the_closed_profile():
    """In any shape: tension times exp(mu angle) is the same all along, the angle read from the drawn path."""
    driven = drive(bending(), {"tension": [[1.0], [3.0], [5.0], [8.0]]}, stations=2001)
    (tendon,) = driven[-1].tendons
    steps = np.diff(tendon.path, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    cosine = np.clip(np.einsum("ka,ka->k", steps[1:], steps[:-1]), -1, 1)
    sine = np.linalg.norm(np.cross(steps[1:], steps[:-1]), axis=1)
    angle = np.cumsum(np.arctan2(sine, cosine))
    middles = 0.5 * (tendon.tension[1:] + tendon.tension[:-1])
    assert angle[-1] > 0.7
    assert middles[1:] == pytest.approx(middles[0] * np.exp(-0.2 * angle), rel=1e-6)
