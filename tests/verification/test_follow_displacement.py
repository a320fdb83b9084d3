"""Paths under displacements, against closed forms, paths at held tensions and solves at the tensions."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, Material, PointLoad, Robot, RobotError, Straight, Tendon, Tube, examples
from tactr.statics import Followed, Shape

from .opposed_tubes import pair
from .test_follow import pendulum_fold

QUARTERS = np.radians([0, 90, 180, 270, 360, 450])
TURNS = np.column_stack([np.zeros(6), QUARTERS])


def tied(robot: Robot) -> Robot:
    """Motors that stand still where the tubes turn."""
    lengths = tactr.rest_lengths(robot)
    return robot.replace(tendons=[replace(t, rest_length=lengths[t.name]) for t in robot.tendons])


def pulled_pair(size: float, **tendon) -> Robot:
    return tied(pair(size).replace(tendons=[Tendon("pull", "inner", Straight(2e-3, 0.0), **tendon)]))


def turned(robot: Robot, displacement: float) -> Followed:
    return tactr.follow(robot, {"displacement": np.full((6, 1), displacement), "rotation": TURNS})


def check_anew(shape: Shape) -> None:
    """The displacements asked for are those of a solve at the tensions found."""
    asked = [tendon.displacement for tendon in shape.robot.tendons]
    again = tactr.solve(shape.robot.with_actuation(tension=shape.tension), guess=shape)
    np.testing.assert_allclose(again.tip_position, shape.tip_position, rtol=0.0, atol=2e-6)
    for pull, found, tension in zip(asked, again.displacement, again.tension, strict=True):
        assert pull is None or (abs(found - pull) < 2e-7 if tension > 0.0 else found > pull - 2e-7)


@pytest.mark.parametrize("size", [1.7, 2.0])
def test_a_slack_tendon_leaves_the_snap_where_the_pendulum_folds(size: float) -> None:
    followed = turned(pulled_pair(size), -0.05)
    assert followed.converged and len(followed.snaps) == 1
    assert followed.snaps[0].parameter * math.pi / 2 == pytest.approx(pendulum_fold(size)[1], abs=2e-4)
    assert all(shape.slack == ("pull",) for shape in followed.shapes)


@pytest.mark.parametrize("tension", [0.1, 0.3])
def test_a_very_soft_tendon_snaps_where_it_does_at_its_tension(tension: float) -> None:
    """With 1 m/N what the tubes shorten is a thousandth of what the tendon stretches."""
    soft = turned(pulled_pair(2.0, compliance=1.0), tension)
    robot = pair(2.0).replace(tendons=[Tendon("pull", "inner", Straight(2e-3, 0.0), tension=tension)])
    held = tactr.follow(robot, {"rotation": TURNS})
    assert len(soft.snaps) == len(held.snaps) == 1
    assert soft.snaps[0].parameter == pytest.approx(held.snaps[0].parameter, abs=3e-4)
    np.testing.assert_allclose(soft.tips, held.tips, rtol=0.0, atol=2e-4)


@pytest.mark.parametrize("pull", [1e-3, 3e-3])
def test_a_stiff_tendon_holds_on_beyond_the_fold_at_its_tension(pull: float) -> None:
    """The shape before the snap would fall over at its tension. By all equilibria at held tensions: a little
    before the snap the displacement is met among the neighbours, a little beyond it no more."""
    robot = pulled_pair(1.7)
    followed = turned(robot, pull)
    assert followed.converged and len(followed.snaps) == 1
    snap = followed.snaps[0]
    assert snap.before.stable and not snap.before.stability.stable
    assert snap.after.stable and np.linalg.norm(snap.after.tip_position - snap.before.tip_position) > 1e-3
    for shape in (*followed.shapes, snap.before, snap.after):
        check_anew(shape)

    def sides(parameter: float) -> set[bool]:
        over = []
        for tension in snap.before.tension[0] + np.linspace(-0.6, 0.6, 13):
            there = {"rotation": [0.0, parameter * math.pi / 2], "tension": [tension]}
            found = tactr.branches(robot, **there)
            gaps = [abs(turn_at_tip(shape) - turn_at_tip(snap.before)) for shape in found]
            over += [float(s.displacement[0]) > pull for s, gap in zip(found, gaps, strict=True) if gap < 0.3]
        return set(over)

    assert sides(snap.parameter - 0.01) == {True, False}
    assert sides(snap.parameter + 0.01) != {True, False}


def turn_at_tip(shape: Shape) -> float:
    """Of the inner tube against the outer at the tip, rad."""
    return float(shape.theta[1, -1])


def concentric(loads: tuple = ()) -> Robot:
    """Three precurved tubes, partly behind the guide, two soft tendons and one without compliance."""
    material = Material(E=60e9, nu=0.3)
    rows = (
        ("outer", 0.14, 2.0e-3, 1.7e-3, 3.0),
        ("middle", 0.2, 1.5e-3, 1.2e-3, 5.0),
        ("inner", 0.28, 1.0e-3, 0.7e-3, 6.0),
    )
    tubes = [
        Tube(
            name,
            length=length,
            section=Annulus(od, bore),
            material=material,
            precurvature=(k, 0, 0),
            translation=-0.04,
        )
        for name, length, od, bore, k in rows
    ]
    tendons = [
        Tendon("a", "outer", Straight(3e-3, 0.0), compliance=1e-4, pretension=0.5),
        Tendon("b", "middle", Straight(-2.5e-3, 1e-3), compliance=1e-5, pretension=0.5),
        Tendon("c", "inner", Helix(2e-3, 20.0), pretension=0.5),
        Tendon("d", "inner", Straight(0.0, 2e-3), tension=1.0),
    ]
    return tied(Robot(tubes, tendons, loads))


def wander(points: int, seed: int = 0) -> dict[str, np.ndarray]:
    """Rotations, insertions, displacements of a, b, c and tensions of d, straight between random corners."""
    rng = np.random.default_rng(seed)
    part = np.arange(points) / 25.0
    corners = int(part[-1]) + 2

    def between(low: float, high: float, columns: int) -> np.ndarray:
        rows = rng.uniform(low, high, (corners, columns))
        return np.column_stack([np.interp(part, np.arange(corners), column) for column in rows.T])

    pull = np.column_stack([between(-2e-3, 4e-3, 3), np.full(points, np.nan)])
    rotation, translation = between(-1.2, 1.2, 3), between(-0.08, 0.0, 3)
    tension = np.column_stack([np.full((points, 3), np.nan), between(0.0, 3.0, 1)])
    return {"rotation": rotation, "translation": translation, "displacement": pull, "tension": tension}


def as_points(rows: dict[str, np.ndarray]) -> list[dict]:
    return [
        {
            "rotation": rows["rotation"][k],
            "translation": rows["translation"][k],
            "displacement": dict(zip("abc", rows["displacement"][k, :3], strict=True)),
            "tension": {"d": rows["tension"][k, 3]},
        }
        for k in range(len(rows["rotation"]))
    ]


LOADS = (PointLoad("inner", force=(0.05, 0.02, -0.04)),)


@pytest.mark.parametrize("loads", [(), LOADS], ids=["free", "loaded"])
@pytest.mark.parametrize("points", [60, pytest.param(1000, marks=pytest.mark.slow)])
def test_a_random_path_is_followed_whole(points: int, loads: tuple) -> None:
    followed = tactr.follow(concentric(loads), as_points(wander(points)))
    assert followed.converged, followed
    slack = {shape.slack for shape in followed.shapes}
    assert len(slack) > 2
    for shape in followed.shapes[:: max(1, points // 20)]:
        check_anew(shape)
        assert shape.stable


def test_there_and_back_is_the_same_where_nothing_snaps() -> None:
    points = as_points(wander(40, seed=1))
    followed = tactr.follow(concentric(), points + points[::-1])
    assert followed.converged and not followed.snaps
    np.testing.assert_allclose(followed.tips[:40], followed.tips[:39:-1], rtol=0.0, atol=5e-6)
    there = np.array([shape.tension for shape in followed.shapes])
    np.testing.assert_allclose(there[:40], there[:39:-1], rtol=0.0, atol=2e-2)


def test_equilibria_of_a_slack_tendon_are_those_without_it() -> None:
    robot = pulled_pair(2.0).with_actuation(rotation={"inner": math.pi})
    found = tactr.branches(robot, displacement=[-0.05])
    expected = tactr.branches(pair(2.0, math.pi))
    assert len(found) == len(expected) == 3
    assert [shape.stable for shape in found] == [shape.stability.stable for shape in expected]
    assert [shape.stable for shape in found] == [True, True, False]
    tips = np.array(sorted(tuple(np.round(s.tip_position, 6)) for s in found))
    np.testing.assert_allclose(
        tips, sorted(tuple(np.round(s.tip_position, 6)) for s in expected), rtol=0.0, atol=3e-6
    )


def test_equilibria_about_a_snap() -> None:
    """Before it there are two stable shapes and one between them, beyond it one is left."""
    robot, pull = pulled_pair(2.0), 1e-3
    at = turned(robot, pull).snaps[0].parameter
    for parameter, stable in ((at - 0.05, [True, True, False]), (at + 0.05, [True])):
        found = tactr.branches(
            robot, rotation={"inner": parameter * math.pi / 2}, displacement={"pull": pull}
        )
        assert [shape.stable for shape in found] == stable
        for shape in found:
            check_anew(shape)


def test_a_path_keeps_to_tensions_or_displacements() -> None:
    robot = examples.load("two_tube_90")
    with pytest.raises(RobotError) as caught:
        tactr.follow(robot, [{"tension": {"inner": 1.0}}, {"displacement": {"inner": 1e-3}}])
    assert caught.value.field == "path[1].displacement"
    assert "path[0]" in str(caught.value)
