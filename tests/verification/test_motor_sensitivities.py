"""Derivatives with the motors of tendons held, against differences of solves by displacement."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import Annulus, Material, PointLoad, Robot, Rod, Straight, Tendon, Tube, rest_lengths
from tactr.statics.parameters import value_of, with_value

METAL = Material(E=60e9, nu=0.3, density=6450.0)
TOLERANCE = 1e-10


def two_tubes(*, tied: bool) -> Robot:
    """Precurved and loaded; three motors, one of them left slack, and one tendon at its tension."""
    outer = Annulus(1.4e-3, 1.1e-3)
    tubes = [
        Tube("outer", length=0.12, section=outer, material=METAL, precurvature=(2.0, 1.0, 0.0)),
        Tube("inner", length=0.18, section=Rod(1e-3), material=METAL, precurvature=(0, 3, 0), rotation=0.4),
    ]
    tendons = [
        Tendon("a", "outer", Straight(5e-3, 0.0), displacement=1.5e-3, compliance=2e-4, pretension=1.0),
        Tendon("b", "inner", Straight.polar(4e-3, 2.0), displacement=2e-3, compliance=5e-4, pretension=0.5),
        Tendon("slack", "outer", Straight(-5e-3, 0.0), displacement=-4e-3),
        Tendon("held", "inner", Straight(0.0, -4e-3), tension=1.0),
    ]
    robot = Robot(tubes, tendons, [PointLoad("inner", force=(0.05, -0.03, 0.02))])
    if tied:
        lengths = rest_lengths(robot, tolerance=TOLERANCE)
        changed = [with_rest(tendon, lengths[tendon.name]) for tendon in robot.tendons]
        robot = robot.replace(tendons=tuple(changed))
    return robot


def with_rest(tendon: Tendon, length: float) -> Tendon:
    return Tendon(
        tendon.name, tendon.tube, tendon.routing, tension=tendon.tension, displacement=tendon.displacement,
        compliance=tendon.compliance, pretension=tendon.pretension, rest_length=length + 2e-4,
    )  # fmt: skip


PATHS = [
    "tendons.a.displacement",
    "tendons.a.compliance",
    "tendons.b.pretension",
    "tendons.slack.displacement",
    "tendons.held.tension",
    "tendons.b.routing.x",
    "tubes.outer.material.E",
    "tubes.inner.precurvature.0.1.y",
    "tubes.inner.length",
    "tubes.inner.rotation",
    "tubes.outer.translation",
    "loads.0.force.x",
]


@pytest.mark.parametrize("tied", [False, True], ids=["zeroed at rest", "tied"])
@pytest.mark.parametrize("path", [*PATHS, "tendons.a.rest_length"])
def test_the_tip_follows_a_number_with_the_motors_held(path: str, tied: bool) -> None:
    robot = two_tubes(tied=tied)
    if path.endswith("rest_length") and not tied:
        with pytest.raises(tactr.RobotError, match="None is not a number"):
            tactr.solve(robot).sensitivity([path])
        return
    shape = tactr.solve(robot, tolerance=TOLERANCE)
    assert shape.converged and shape.slack == ("slack",)
    value = value_of(robot, path)
    step = 1e-3 * abs(value) if abs(value) > 1e-6 else 1e-6
    one_sided = path.endswith("translation")  # tubes are only withdrawn
    places = (0, -1, -2, -3, -4) if one_sided else (-2, -1, 1, 2)
    weights = (25 / 12, -4.0, 3.0, -4 / 3, 1 / 4) if one_sided else (1 / 12, -2 / 3, 2 / 3, -1 / 12)

    def tip(k: int) -> np.ndarray:
        return tactr.solve(with_value(robot, path, value + k * step), tolerance=TOLERANCE).tip_position

    expected = sum(w * tip(k) for w, k in zip(weights, places, strict=True)) / step
    found = shape.sensitivity([path])[:3, 0]
    assert np.linalg.norm(found - expected) < 2e-5 * np.linalg.norm(expected) + 1e-11 / step


def test_one_motor_in_closed_form() -> None:
    """A straight rod, one tendon at r: T = d / (L/EA + r^2 L/EI + c), dT/dc = -T^2 / d, and the rod bends by
    the angle T r L / EI."""
    r, L, c, d = 5e-3, 0.2, 3e-4, 2e-3
    rod = Tube("rod", length=L, section=Rod(1e-3), material=METAL)
    shape = tactr.solve(Robot([rod], [Tendon("t", "rod", Straight(r, 0.0), displacement=d, compliance=c)]))
    EA, EI = METAL.E * math.pi * 1e-6 / 4, METAL.E * math.pi * 1e-12 / 64
    tension = d / (L / EA + r**2 * L / EI + c)
    turn = shape.sensitivity(["tendons.t.compliance", "tendons.t.displacement"])[4]
    assert turn == pytest.approx([-(tension**2) / d * r * L / EI, tension / d * r * L / EI], rel=1e-6)
