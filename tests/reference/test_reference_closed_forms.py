"""The reference against closed forms and against numbers published for the limits of the model."""

from __future__ import annotations

import numpy as np
import pytest

from tactr import reference
from tactr.robot import (
    Gravity,
    Helix,
    Material,
    PointLoad,
    Robot,
    Rod,
    Stiffness,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

RIGID = 1e9
"""Axial and shear stiffness, times EI in 1/m^2, of tubes that hardly stretch or shear."""


def thin(EI: float, GJ: float) -> Stiffness:
    """Return a section that hardly stretches or shears."""
    return Stiffness(EA=EI * RIGID, GA=EI * RIGID, EI_x=EI, EI_y=EI, GJ=GJ)


def test_straight_tendon_bends_an_arc() -> None:
    tube = Tube("tube", length=0.2, section=Rod(1e-3), material=Material(E=60e9, nu=0.3))
    k = tube.stiffness
    shape = reference.solve(Robot([tube], [Tendon("t", "tube", Straight(5e-3, 0.0), tension=2.0)]))
    kappa, v3 = 2.0 * 5e-3 / k.EI_x, 1.0 - 2.0 / k.EA
    angle = kappa * 0.2
    tip = v3 / kappa * np.array([1.0 - np.cos(angle), 0.0, np.sin(angle)])
    assert shape.tip == pytest.approx(tip, abs=1e-11)
    assert shape.iterations == 0


def test_tension_profile_bends_in_proportion() -> None:
    """No external load: the moment of the section is minus that of the tendon, wherever it is."""
    tube = Tube("tube", length=0.2, section=Rod(1e-3), material=Material(E=60e9, nu=0.3))
    profile = TensionProfile((0.0, 0.05, 0.2), (2.0, 2.0, 0.5))
    robot = Robot([tube], [Tendon("t", "tube", Straight(5e-3, 0.0), tension=profile)])
    bent = reference.solve(robot, stations=[0.0, 0.02, 0.05, 0.1, 0.15, 0.2]).tubes[0]
    tension = np.array([2.0, 2.0, 2.0, 1.5, 1.0, 0.5])
    assert bent.u[:, 1] == pytest.approx(tension * 5e-3 / tube.stiffness.EI_x, rel=1e-9)
    assert bent.n[:, 2] == pytest.approx(-tension, rel=1e-9)


@pytest.mark.parametrize(
    ("load", "aside", "shortening", "angle"),
    [(1.0, 0.30172077, 0.05643324, 0.46135195), (5.0, 0.71379152, 0.38762836, 1.21536812)],
)
def test_elastica(load: float, aside: float, shortening: float, angle: float) -> None:
    robot = Robot(
        [Tube("beam", length=1.0, section=thin(1.0, 1.0))], (), [PointLoad("beam", force=(load, 0, 0))]
    )
    shape = reference.solve(robot)
    assert shape.tip == pytest.approx([aside, 0.0, 1.0 - shortening], abs=3e-8)
    frame = shape.frames[-1]
    assert np.arctan2(frame[0, 2], frame[2, 2]) == pytest.approx(angle, abs=1e-8)


@pytest.mark.parametrize(("root_c_L", "base", "tip"), [(0.5, 60, 54.127346), (1.5, 150, 87.706341)])
def test_two_precurved_tubes_wind_up(root_c_L: float, base: float, tip: float) -> None:
    robot = precurved_pair(root_c_L, np.deg2rad(base), 1.0)
    outer, inner = reference.solve(robot, stations=[0.1]).tubes
    relative = outer.frames[0].T @ inner.frames[0]
    assert np.rad2deg(np.arctan2(relative[1, 0], relative[0, 0])) == pytest.approx(tip, abs=1e-6)


def test_two_precurved_tubes_tip() -> None:
    tip = reference.solve(precurved_pair(1.0, np.pi / 2, 3.0)).tip
    assert tip == pytest.approx([0.033112489, -0.012085393, 0.091048082], abs=2e-9)


def precurved_pair(root_c_L: float, angle: float, ratio: float) -> Robot:
    """Return two tubes of 0.1 m and Poisson ratio 0.3 whose relative twist obeys a'' = c sin a."""
    nu, length = 0.3, 0.1
    u_star = (root_c_L / length / np.sqrt(1.0 + nu), 0.0, 0.0)
    return Robot(
        [
            Tube("outer", length=length, section=thin(1.0, 1.0 / (1.0 + nu)), precurvature=u_star),
            Tube(
                "inner",
                length=length,
                section=thin(ratio, ratio / (1.0 + nu)),
                precurvature=u_star,
                rotation=angle,
            ),
        ]
    )


@pytest.mark.parametrize(
    ("force", "tip"),
    [(300.0, (22.1152, 40.4748, 58.5405)), (600.0, (15.5603, 53.6049, 46.8968))],
)
def test_bend_of_45_degrees(force: float, tip: tuple[float, float, float]) -> None:
    """Bathe's curved cantilever under a dead force out of its plane."""
    section = Stiffness(EA=1e7, GA=5e6, EI_x=1e7 / 12, EI_y=1e7 / 12, GJ=5e6 * 0.141)
    beam = Tube("beam", length=25 * np.pi, section=section, precurvature=(0.0, 0.01, 0.0))
    shape = reference.solve(Robot([beam], (), [PointLoad("beam", force=(0.0, force, 0.0))]))
    assert shape.tip == pytest.approx(tip, abs=6e-5)


@pytest.mark.parametrize(
    ("turns", "gravity", "tip"),
    [(0.0, True, (0.182212, 0.0, 0.453229)), (1.0, True, (0.0122099, 0.0581888, 0.4933483))],
)
def test_backbone_with_tendon_and_gravity(
    turns: float, gravity: bool, tip: tuple[float, float, float]
) -> None:
    backbone = Tube(
        "backbone", length=0.5, section=Rod(2e-3), material=Material(E=200e9, G=80e9, density=8000.0)
    )
    tendon = Tendon("t", "backbone", Helix(15.06e-3, turns * 4 * np.pi), tension=15.0)
    loads = [Gravity((9.81, 0.0, 0.0))] if gravity else []
    shape = reference.solve(Robot([backbone], [tendon], loads))
    assert shape.tip == pytest.approx(tip, abs=5e-7)


def two_segments(*loads: PointLoad) -> Robot:
    """Return a backbone of two segments with three tendons each, one in each pulled."""
    backbone = Tube("backbone", length=0.4, section=Rod(1.4e-3), material=Material(E=54e9, nu=0.3))
    tendons = [
        Tendon("first", "backbone", Straight.polar(10e-3, np.pi / 2), tension=4.0, end=0.2),
        Tendon("second", "backbone", Straight.polar(10e-3, -np.pi / 6), tension=2.0),
    ]
    return Robot([backbone], tendons, loads)


def test_two_segments_without_load() -> None:
    for transitions in ("resultant", "published"):
        tip = reference.solve(two_segments(), transitions=transitions).tip
        assert tip == pytest.approx([0.1276076, 0.1434674, 0.3364068], abs=1e-7)


@pytest.mark.parametrize(
    ("load", "tip", "kink"),
    [
        (PointLoad("backbone", force=(0.1, 0.0, 0.0)), (0.2366288, 0.1069716, 0.2690231), 7.2e-5),
        (PointLoad("backbone", moment=(0.0, 0.0, 0.005)), (0.1089906, 0.1600873, 0.3362428), 4.2e-4),
    ],
)
def test_two_segments_with_load(load: PointLoad, tip: tuple[float, float, float], kink: float) -> None:
    """The code behind these numbers carries the elastic part over; the kink moves the tip by `kink`."""
    robot = two_segments(load)
    published = reference.solve(robot, transitions="published")
    assert published.tip == pytest.approx(tip, abs=1e-7)
    whole = reference.solve(robot, guess=(published.u_base, published.v_base))
    assert np.linalg.norm(whole.tip - published.tip) == pytest.approx(kink, rel=0.05)
