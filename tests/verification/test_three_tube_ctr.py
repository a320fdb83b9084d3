"""A published concentric tube robot of three tubes, pushed and turned behind the guide."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import tactr
from tactr import Annulus, Material, PointLoad, Robot, Stiffness, Tube
from tactr.robot.load import Load

CURVED = 0.05
ROWS = {  # length, inner radius, outer radius (m), rest curvature (1/m) about x on the last 50 mm
    "outer": (0.199, 1.03e-3, 1.175e-3, 7.0),
    "middle": (0.3305, 0.81e-3, 0.9e-3, 5.0),
    "inner": (0.463, 0.65e-3, 0.762e-3, 10.0),
}
PUSHED = {"outer": -0.1, "middle": -0.2, "inner": -0.3}
TURNED = {"outer": 1.0, "middle": 0.5, "inner": 0.0}
LOADED = {
    "force along x": ((0.05, 0.0, 0.0), (22.0227e-3, -23.8035e-3, 156.0354e-3)),
    "force along z": ((0.0, 0.0, -0.1), (20.9380e-3, -24.6521e-3, 156.0092e-3)),
}
PRINTED = 6e-8  # m, half a unit of the last digit and a little


def ctr(
    translations: dict[str, float] = PUSHED,
    rotations: dict[str, float] = TURNED,
    loads: Sequence[Load] = (),
    *,
    rigid: bool = False,
) -> Robot:
    tubes = []
    for name, (length, bore, radius, curvature) in ROWS.items():
        section, material = Annulus(2 * radius, 2 * bore), Material(E=58e9, nu=0.3)
        k = section.stiffness(material)
        limit = Stiffness(EA=1e9, GA=1e9, EI_x=k.EI_x, EI_y=k.EI_y, GJ=k.GJ)
        tubes.append(
            Tube(
                name,
                length=length,
                section=limit if rigid else section,
                material=material,
                precurvature=[(0.0, (0.0, 0.0, 0.0)), (length - CURVED, (curvature, 0.0, 0.0))],
                translation=translations[name],
                rotation=rotations[name],
            )
        )
    return Robot(tubes, loads=loads)


def tip_of(robot: Robot) -> np.ndarray:
    shape = tactr.solve(robot, tolerance=1e-9)
    assert shape.converged, shape.message
    return shape.tip_position


def test_unloaded() -> None:
    np.testing.assert_allclose(tip_of(ctr()), (20.3188e-3, -23.9604e-3, 156.3476e-3), rtol=0.0, atol=PRINTED)


def test_pulled_back() -> None:
    robot = ctr(
        {"outer": -0.15, "middle": -0.24, "inner": -0.35}, {"outer": 1.2, "middle": -0.7, "inner": 0.3}
    )
    np.testing.assert_allclose(tip_of(robot), (15.9476e-3, -18.9430e-3, 108.7724e-3), rtol=0.0, atol=PRINTED)


@pytest.mark.parametrize("name", LOADED)
def test_loaded(name: str) -> None:
    force, tip = LOADED[name]
    robot = ctr(loads=[PointLoad("inner", force=force)])
    np.testing.assert_allclose(tip_of(robot), tip, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("name", LOADED)
def test_loaded_without_shear_and_stretch(name: str) -> None:
    """The published numbers are of Kirchhoff rods, 0.3 micrometres from those with shear and stretch."""
    force, tip = LOADED[name]
    robot = ctr(loads=[PointLoad("inner", force=force)], rigid=True)
    np.testing.assert_allclose(tip_of(robot), tip, rtol=0.0, atol=PRINTED)


def test_tubes_twist_behind_the_guide_at_a_constant_rate() -> None:
    """A straight tube in the guide carries a constant torque: the angle at s = 0 is alpha + b tau(0)."""
    shape = tactr.solve(ctr(), tolerance=1e-10)
    for tube, described in zip(shape.tubes, shape.robot.tubes, strict=True):
        d1 = tube.frames[0, :, 0]
        wound = math.atan2(d1[1], d1[0]) - described.rotation
        assert wound == pytest.approx(-described.translation * tube.u[0, 2], abs=1e-8)
