"""Friction between tubes against closed forms: a torsion bar under an even contact force, and concentrated
contact where a straight tube leaves a curved one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tactr import Robot, Tube, TubeFriction

from .rods import COEFFICIENT, EI, FULL, GJ, LENGTH, PRESS, RADIUS, TORQUE, Driven, pressed_rod, soft


def torque_at_base(driven: Driven) -> float:
    """What turns the inner tube at its base: the sum of what holds it further out."""
    contact = driven.contact
    return -float(contact.torque.sum())


def test_rest_takes_no_torque() -> None:
    driven = Driven(pressed_rod())
    driven.to(rotation=[0.0, 0.0])
    assert not driven.contact.torque.any()
    assert driven.contact.limit[1:-1].sum() == pytest.approx(TORQUE * LENGTH, rel=1e-5)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.5, 0.9])
def test_front_of_a_first_turn(share: float) -> None:
    """theta(s) = mu f r (front - s)^2 / (2 GJ), front = sqrt(2 GJ alpha / (mu f r)); the tip stands still."""
    cells = 32
    driven = Driven(pressed_rod(), cells=cells)
    driven.to(rotation=[0.0, 0.0])
    driven.to(rotation={"inner": share * FULL})
    contact = driven.contact
    front = np.sqrt(2.0 * GJ * share * FULL / TORQUE)
    expected = TORQUE * np.clip(front - contact.s, 0.0, None) ** 2 / (2.0 * GJ)
    assert contact.twist == pytest.approx(expected, abs=FULL / (4.0 * cells**2) * 1.01)
    assert driven.tip_angle() == pytest.approx(0.0, abs=1e-7)
    assert torque_at_base(driven) == pytest.approx(TORQUE * front, rel=1e-2)


def test_order_of_the_places() -> None:
    """Twist between base and front against the torque there: second order in the length of a cell."""
    errors = []
    for cells in (4, 8, 16, 32):
        worst = 0.0
        for share in np.linspace(0.05, 0.95, 19):
            driven = Driven(pressed_rod(), cells=cells)
            driven.to(rotation=[0.0, 0.0])
            driven.to(rotation={"inner": share * FULL})
            worst = max(worst, abs(torque_at_base(driven) ** 2 / (2.0 * GJ * TORQUE) - share * FULL))
        errors.append(worst / FULL)
        assert worst / FULL <= 1.0 / (4.0 * cells**2) * 1.02
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.3)


def test_lag_of_the_tip_when_all_slides() -> None:
    """The tip lags by mu f r L^2 / (2 GJ), exactly, whatever the number of places."""
    for cells in (2, 8):
        driven = Driven(pressed_rod(), cells=cells)
        tips = driven.turn(np.array([0.0, 2.0, 3.0, -3.0, -4.0]) * FULL)
        lags = np.array([2.0, 3.0, -3.0, -4.0]) * FULL - tips[1:]
        assert lags == pytest.approx([FULL, FULL, -FULL, -FULL], rel=1e-5)


def test_dead_band_of_a_reversal_is_twice_the_first() -> None:
    driven = Driven(pressed_rod())
    driven.turn(np.array([0.0, 3.0]) * FULL)
    still = driven.tip_angle()
    assert driven.turn(np.array([2.5, 2.0, 1.01]) * FULL) == pytest.approx(still, abs=1e-7)
    moved = driven.turn(np.array([0.9]) * FULL)[0]
    assert moved == pytest.approx(still - 0.1 * FULL, abs=1e-5 * FULL)


def test_second_front_after_a_reversal() -> None:
    """Beyond the second front sqrt(GJ turned back / (mu f r)) the first turn's twist stays."""
    cells = 32
    driven = Driven(pressed_rod(), cells=cells)
    driven.turn(np.array([0.0, 0.9, 0.5]) * FULL)
    s = driven.contact.s
    first = np.sqrt(2.0 * GJ * 0.9 * FULL / TORQUE)
    second = np.sqrt(GJ * 0.4 * FULL / TORQUE)
    expected = TORQUE / (2.0 * GJ) * np.clip(first - s, 0.0, None) ** 2
    expected -= TORQUE / GJ * np.clip(second - s, 0.0, None) ** 2
    assert driven.contact.twist == pytest.approx(expected, abs=2.0 * FULL / (4.0 * cells**2))


def test_friction_resists() -> None:
    """The torque on the inner tube points against its slip; turned the other way all signs change."""
    for sign in (1.0, -1.0):
        driven = Driven(pressed_rod())
        tips = driven.turn(sign * np.array([0.0, 2.0]) * FULL)
        contact = driven.contact
        assert sign * tips[1] == pytest.approx(FULL, rel=1e-5)
        assert (sign * contact.torque[1:-1] < 0.0).all() and (sign * contact.slides[1:-1] > 0.0).all()


def test_contact_force_of_a_tube_that_bears_its_share() -> None:
    """Of an even load on the inner tube the outer one bears EI_o / (EI_o + EI_i), whatever their shear."""
    inner = soft()
    outer = type(inner)(EA=1e5, GA=1e4, EI_x=3e4 * EI, EI_y=3e4 * EI, GJ=1e4 * GJ)
    inner = type(inner)(EA=1e5, GA=9e4, EI_x=1e4 * EI, EI_y=1e4 * EI, GJ=GJ)
    robot = pressed_rod()
    tubes = (
        Tube("outer", length=LENGTH, section=outer),
        Tube("inner", length=LENGTH, section=inner, friction=TubeFriction(COEFFICIENT, RADIUS, 10.0)),
    )
    driven = Driven(robot.replace(tubes=tubes))
    driven.to(rotation=[0.0, 0.0])
    limit = driven.contact.limit
    even = COEFFICIENT * RADIUS * 0.75 * PRESS * LENGTH / 8
    assert limit[1:-1] == pytest.approx(even, rel=1e-4)
    assert len(limit) == 10


def curved_pair(lever: float = 4e-3) -> Robot:
    friction = TubeFriction(COEFFICIENT, RADIUS, lever)
    return Robot(
        tubes=(
            Tube("outer", length=LENGTH, section=soft(3.0), precurvature=(8.0, 0.0, 0.0)),
            Tube("inner", length=LENGTH, section=soft(), friction=friction),
        )
    )


def test_straight_tube_in_a_curved_one() -> None:
    """Only the couples at base and end press: the inner tube's moment M = EI kappa on forces M / lever apart.

    The end holds until its torque is mu r 2 M / lever, so that the tip first stands still for that torque
    times L / GJ of both tubes, which it winds up in opposite ways, and then lags by as much.
    """
    lever = 40e-3
    driven = Driven(curved_pair(lever), tolerance=1e-9)
    kappa = 8.0 * 3.0 / 4.0
    bound = COEFFICIENT * RADIUS * 2.0 * EI * kappa / lever
    lag = bound * LENGTH * (1.0 / GJ + 1.0 / (3.0 * GJ))
    tips = driven.turn(np.array([0.0, 0.5, 2.0, 0.5, -1.0]) * lag)
    assert driven.contact.limit[-1] == pytest.approx(bound, rel=2e-3)
    assert driven.contact.limit[1:-1].max() < 0.02 * bound
    assert tips == pytest.approx(np.array([0.0, 0.0, 1.0, 1.0, 0.0]) * lag, abs=0.03 * lag)


def test_contact_force_of_two_curved_tubes() -> None:
    """Kirchhoff's rods, alike and each turned by half the angle theta between them: the transverse force is
    (EI + GJ) kappa cos(theta/2) theta'/2, and what presses is its change along s."""
    kappa, turned, cells = 12.0, 2.0, 64
    friction = TubeFriction(1e-9, RADIUS, 1e9)
    tube = {"length": LENGTH, "section": soft(), "precurvature": (kappa, 0.0, 0.0)}
    driven = Driven(
        Robot(tubes=(Tube("outer", **tube), Tube("inner", **tube, friction=friction))), cells=cells
    )
    driven.to(rotation=[0.0, turned])

    # GJ theta'' = EI kappa^2 sin(theta), theta(0) = turned, theta'(L) = 0
    def pendulum(end: float) -> Any:
        def rate(_s: float, y: np.ndarray) -> list[float]:
            return [y[1], EI / GJ * kappa**2 * np.sin(y[0])]

        return solve_ivp(rate, (LENGTH, 0.0), [end, 0.0], rtol=1e-11, atol=1e-13, dense_output=True).sol

    end = brentq(lambda end: pendulum(end)(0.0)[0] - turned, 0.01, turned, xtol=1e-13)
    theta = pendulum(float(end))  # type: ignore[arg-type]
    s = np.linspace(0.0, LENGTH, 20001)
    angle, slope = theta(s)
    force = 0.5 * (EI + GJ) * kappa * np.cos(0.5 * angle) * slope
    press = np.abs(np.gradient(force, s))
    cell = np.minimum((s * cells / LENGTH).astype(int), cells - 1)
    expected = np.array([np.trapezoid(press[cell == k], s[cell == k]) for k in range(cells)])
    limit = driven.contact.limit / (1e-9 * RADIUS)
    assert limit[1:-1] == pytest.approx(expected, rel=0.02, abs=0.02 * expected.max())
    assert limit[0] == pytest.approx(abs(force[0]), rel=1e-3)
    assert limit[-1] == pytest.approx(0.0, abs=1e-3 * limit[0])
