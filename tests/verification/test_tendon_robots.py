"""Single-backbone tendon robots computed by public codes: J. Till's, Rucker's, tdcr-modeling."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import tactr
from tactr import Gravity, Helix, Material, PointLoad, Robot, Rod, Straight, Tendon, Tube
from tactr.robot import Routing
from tactr.robot.load import Load


def check_tip(robot: Robot, tip: Sequence[float]) -> None:
    shape = tactr.solve(robot, tolerance=1e-9)
    assert shape.converged, shape.message
    np.testing.assert_allclose(shape.tip_position, tip, rtol=0.0, atol=1e-6)


TURN = 2 * math.pi / 0.5
TILL = {
    "straight with gravity": (Straight(0.01506, 0.0), 9.81, (0.182212, 0.0, 0.453229)),
    "straight": (Straight(0.01506, 0.0), 0.0, (0.1721480, 0.0, 0.4580019)),
    "helical with gravity": (Helix(0.01506, TURN), 9.81, (0.0122099, 0.0581888, 0.4933483)),
    "helical": (Helix(0.01506, TURN), 0.0, (0.0000734, 0.0581596, 0.4932688)),
}


@pytest.mark.parametrize("name", TILL)
def test_till(name: str) -> None:
    routing, gravity, tip = TILL[name]
    steel = Material(E=200e9, G=80e9, density=8000.0)
    rod = Tube("rod", length=0.5, section=Rod(0.002), material=steel)
    loads = [Gravity((gravity, 0.0, 0.0))] if gravity else []
    check_tip(Robot([rod], [Tendon("t", "rod", routing, tension=15.0)], loads), tip)


THREE = [Straight.polar(0.008, math.radians(angle)) for angle in (0, 120, 240)]
RUCKER_WEBSTER: dict[str, tuple[Sequence[Routing], Sequence[float], tuple[float, float, float]]] = {
    "5 N on one tendon": (THREE, (5.0, 0.0, 0.0), (0.1752944, 0.0, 0.0792301)),
    "5 N and 2 N": (THREE, (5.0, 2.0, 0.0), (0.1572040, 0.0680713, 0.1101617)),
    "5 N on a helix": ([Helix(0.008, 2 * math.pi / 0.242)], (5.0,), (0.0002114, 0.0850188, 0.2083838)),
}


@pytest.mark.parametrize("name", RUCKER_WEBSTER)
def test_rucker_and_webster(name: str) -> None:
    routings, tensions, tip = RUCKER_WEBSTER[name]
    rod = Tube("rod", length=0.242, section=Rod(0.0008), material=Material(E=210e9, G=80e9))
    tendons = [
        Tendon(str(j), "rod", routing, tension=tension)
        for j, (routing, tension) in enumerate(zip(routings, tensions, strict=True))
    ]
    check_tip(Robot([rod], tendons), tip)


def two_segments(first: Sequence[float], second: Sequence[float], loads: Sequence[Load] = ()) -> Robot:
    """tdcr-modeling's robot: three tendons end at 200 mm, three more at the tip."""
    rod = Tube("rod", length=0.4, section=Rod(0.0014), material=Material(E=54e9, nu=0.3))
    tendons = [
        Tendon(f"{segment}.{j}", "rod", Straight.polar(0.01, math.radians(angle)), tension=tension, end=end)
        for segment, tensions, end in ((1, first, 0.2), (2, second, 0.4))
        for j, (angle, tension) in enumerate(zip((90, -30, 210), tensions, strict=True))
    ]
    return Robot([rod], tendons, loads)


@pytest.mark.parametrize(
    ("first", "second", "tip"),
    [
        ((4.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.1276076, 0.1434674, 0.3364068)),
        ((8.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.3273325, 0.1271853)),
    ],
)
def test_two_segments_without_load(
    first: Sequence[float], second: Sequence[float], tip: Sequence[float]
) -> None:
    check_tip(two_segments(first, second), tip)


TIP_LOADS = {
    "force": (PointLoad("rod", force=(0.1, 0.0, 0.0)), (0.2366288, 0.1069716, 0.2690231)),
    "moment": (PointLoad("rod", moment=(0.0, 0.0, 0.005)), (0.1089906, 0.1600873, 0.3362428)),
}


@pytest.mark.parametrize("name", TIP_LOADS)
def test_two_segments_with_tip_load(name: str) -> None:
    """The load twists the rod, so tendons of segment 2 change direction where those of segment 1 end. The
    public code carries the elastic part over there, as the published model does, and so leaves the force of
    that kink out: 0.07 mm (force) and 0.42 mm (moment) at the tip. With that transition the published model
    gives the code's numbers; with the one that balances (tactr.reference.transitions), the kernel's."""
    load, tip = TIP_LOADS[name]
    robot = two_segments((4.0, 0.0, 0.0), (0.0, 2.0, 0.0), [load])
    shape = tactr.solve(robot, tolerance=1e-9)
    printed = tactr.reference.solve(robot, stations=2, transitions="published")
    balanced = tactr.reference.solve(robot, stations=2, guess=(printed.u_base, printed.v_base))
    np.testing.assert_allclose(printed.tip, tip, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(shape.tip_position, balanced.tip, rtol=0.0, atol=1e-8)
    assert 5e-5 < np.linalg.norm(shape.tip_position - tip) < 5e-4
