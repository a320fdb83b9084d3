"""One solution along a path: where it snaps, to where, and what it does when tube ends pass each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tactr
from tactr import (
    Annulus,
    Helix,
    Material,
    PointLoad,
    Robot,
    RobotError,
    Stiffness,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

from .opposed_tubes import LENGTH, NU, find_root, pair


def pendulum_base(tip: float, size: float) -> float:
    """The angle at the base for one at the tip: a'' = size^2 sin a over unit length, a' = 0 at the tip."""
    path = solve_ivp(
        lambda _, a: (a[1], size**2 * math.sin(a[0])), (1.0, 0.0), (tip, 0.0), rtol=1e-12, atol=1e-13
    )
    return float(path.y[0, -1])


def pendulum_fold(size: float) -> tuple[float, float]:
    """Tip and base angle where the base angle is largest: where its slope in the tip angle is zero."""

    def slope(tip: float) -> float:
        return pendulum_base(tip + 1e-5, size) - pendulum_base(tip - 1e-5, size)

    tip = find_root(slope, 0.1, 3.1)
    return tip, pendulum_base(tip, size)


def turned(*degrees: float) -> list[dict]:
    return [{"rotation": {"inner": math.radians(angle)}} for angle in degrees]


@pytest.mark.parametrize("size", [1.7, 2.0, 3.0])
def test_two_tubes_snap_where_the_pendulum_folds(size: float) -> None:
    """The base angle has a maximum over the tip angle; beyond it the tip goes on to the next branch: that of
    a base turned by another 360 degrees less."""
    fold_tip, fold_base = pendulum_fold(size)
    followed = tactr.follow(pair(size), turned(0, 90, 180, 270, 360, 450), tolerance=1e-9)
    assert followed.converged and len(followed.shapes) == 6 and len(followed.snaps) == 1
    snap = followed.snaps[0]
    assert snap.parameter * math.pi / 2 == pytest.approx(fold_base, abs=2e-4)
    assert snap.before.stability.stable and snap.after.stability.stable
    assert snap.before.stability.margin < 0.1 and snap.after.potential_energy < snap.before.potential_energy
    base = snap.parameter * math.pi / 2 - 2 * math.pi
    landed = find_root(lambda x: pendulum_base(x, size) - base, -fold_tip, 0.0, xtol=1e-12) + 2 * math.pi
    assert float(snap.after.theta[1, -1]) == pytest.approx(landed, abs=1e-6)
    assert float(followed.shapes[4].theta[1, -1]) == pytest.approx(2 * math.pi, abs=1e-6)


def test_there_and_back_leaves_a_loop() -> None:
    """Between the two snaps the shape depends on where it came from: a loop about 180 degrees."""
    followed = tactr.follow(pair(2.0), turned(0, 360, 0))
    there, back = (snap.parameter * 360.0 for snap in followed.snaps)
    assert there == pytest.approx(197.7856, abs=0.05)
    assert 720.0 - back == pytest.approx(360.0 - 197.7856, abs=0.05)


@pytest.mark.parametrize("size", [0.5, 1.5])
def test_gentle_tubes_never_snap(size: float) -> None:
    followed = tactr.follow(pair(size), turned(0, 180, 360, 720), tolerance=1e-9)
    assert followed.converged and not followed.snaps
    np.testing.assert_allclose(
        [s.theta[1, -1] for s in followed.shapes], np.radians([0, 180, 360, 720]), atol=1e-6
    )


def three_tubes(loads: tuple = ()) -> Robot:
    """Three precurved tubes with tendons, the inner two helical or led by the outermost tube's disks."""
    material = Material(E=60e9, nu=0.3)
    rows = (
        ("outer", 0.10, 2.0e-3, 1.7e-3, 4.0),
        ("middle", 0.14, 1.5e-3, 1.2e-3, 6.0),
        ("inner", 0.2, 1.0e-3, 0.7e-3, 8.0),
    )
    tubes = [
        Tube(
            name,
            length=length,
            section=Annulus(od, bore),
            material=material,
            precurvature=(k, 0, 0),
            rotation=0.4 * k,
        )
        for name, length, od, bore, k in rows
    ]
    tendons = [
        Tendon("a", "outer", Straight(3e-3, 0.0), tension=2.0),
        Tendon("b", "inner", Helix(2e-3, 20.0), tension=1.0),
    ]
    return Robot(tubes, tendons, loads)


@pytest.mark.parametrize(
    "loads", [(), (PointLoad("inner", force=(0.05, 0.02, -0.04)),)], ids=["free", "loaded"]
)
def test_tube_ends_pass_each_other(loads: tuple) -> None:
    """The inner tube is drawn in until it ends first: the tip goes on smoothly, and there and back agree."""
    out, back = (0.0, -0.02, -0.04), (0.0, -0.02, -0.15)
    points = [{"translation": np.array(out) + x * (np.array(back) - out)} for x in np.linspace(0.0, 1.0, 23)]
    followed = tactr.follow(three_tubes(loads), points + points[::-1])
    ends = [np.argsort([tube.tip for tube in shape.robot.tubes]).tolist() for shape in followed.shapes]
    assert len({tuple(order) for order in ends}) > 2
    assert followed.converged and not followed.snaps
    np.testing.assert_allclose(followed.tips[:23], followed.tips[:22:-1], rtol=0.0, atol=2e-6)
    cold = tactr.solve(followed.shapes[22].robot)
    np.testing.assert_allclose(followed.shapes[22].tip_position, cold.tip_position, rtol=0.0, atol=2e-6)


def test_a_guess_is_used_where_the_sections_differ() -> None:
    """In the unstable opposed shape: from cold it would be left."""
    k = 2.0 / LENGTH / math.sqrt(1 + NU)
    section = Stiffness(EA=1e4, GA=4e3, EI_x=1e-3, EI_y=1e-3, GJ=1e-3 / (1 + NU))

    def robot(size: float, drawn: float) -> Robot:
        rest = (size / 2.0 * k, 0.0, 0.0)
        outer = Tube("outer", length=LENGTH, section=section, precurvature=rest)
        inner = Tube(
            "inner", length=LENGTH, section=section, precurvature=rest, rotation=math.pi, translation=-drawn
        )
        return Robot([outer, inner])

    unstable = tactr.solve(robot(2.0, 0.0), guess=tactr.solve(robot(0.1, 0.0)))
    shorter = tactr.solve(robot(2.0, 0.01), guess=unstable)
    np.testing.assert_allclose(shorter.theta[1][shorter.s <= LENGTH - 0.01], math.pi, rtol=0.0, atol=1e-6)
    assert not shorter.stability.stable


def test_paths_as_arrays_and_as_mappings() -> None:
    robot = pair(1.0)
    rotation = np.array([[0.0, 0.0], [0.0, 1.0], [0.5, 2.0]])
    arrays = tactr.follow(robot, {"rotation": rotation})
    mappings = tactr.follow(robot, [{"rotation": row} for row in rotation], start=tactr.solve(robot))
    np.testing.assert_allclose(arrays.tips, mappings.tips, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(
        arrays.tips[2], tactr.solve(robot, rotation=rotation[2]).tip_position, atol=1e-6
    )
    assert [tube.rotation for tube in arrays.shapes[2].robot.tubes] == [0.5, 2.0]
    assert repr(arrays) == "<Followed: 3 of 3 points converged, 0 snaps>"


def test_a_profile_stays() -> None:
    profile = TensionProfile(sigma=(0.0, 0.1), values=(2.0, 1.0))
    robot = three_tubes()
    robot = robot.replace(tendons=[Tendon("a", "outer", Straight(3e-3, 0.0), tension=profile)])
    robot = robot.replace(tendons=[*robot.tendons, Tendon("b", "inner", Helix(2e-3, 20.0), tension=1.0)])
    turn = {"inner": 1.0}
    followed = tactr.follow(robot, [{}, {"rotation": turn, "tension": {"b": 2.0}}])
    assert followed.shapes[1].robot.tendons[1].tension == 2.0
    assert followed.converged and followed.shapes[1].robot.tendons[0].tension == profile
    np.testing.assert_allclose(
        followed.shapes[1].tip_position,
        tactr.solve(robot, rotation=turn, tension={"b": 2.0}).tip_position,
        atol=2e-6,
    )


def test_a_path_that_leads_nowhere_comes_back() -> None:
    robot = three_tubes()
    followed = tactr.follow(robot, [{}, {"tension": {"a": 1e6}}, {"tension": {"a": 1.0}}])
    assert [shape.converged for shape in followed.shapes] == [True, False, True]
    assert not followed.converged and "2 of 3" in repr(followed)


@pytest.mark.parametrize(
    ("path", "field"),
    [
        ([], "path"),
        ("ahead", "path"),
        (3.0, "path"),
        ([{"rotation": {"inner": 0.0}}, 3.0], "path[1]"),
        ([{"turn": {"inner": 0.0}}], "path[0]"),
        ([{"rotation": {"innre": 0.0}}], "path[0].rotation"),
        ({"rotation": [0.0, 1.0]}, "path"),
        ({"rotation": [[0.0, 1.0]], "translation": [[0.0, 0.0], [0.0, 0.0]]}, "path"),
        ({}, "path"),
    ],
)
def test_wrong_paths(path, field: str) -> None:
    with pytest.raises(RobotError) as caught:
        tactr.follow(pair(1.0), path)
    assert caught.value.field == field


@pytest.mark.parametrize("tolerance", [0.0, -1.0, math.nan, 2.0, "fine"])
def test_wrong_snap_tolerance(tolerance) -> None:
    with pytest.raises(RobotError) as caught:
        tactr.follow(pair(1.0), turned(0.0), snap_tolerance=tolerance)
    assert caught.value.field == "snap_tolerance"
