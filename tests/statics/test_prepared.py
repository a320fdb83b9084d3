"""Prepared robots: actuation as arrays, sequences and mappings; guesses; errors that name the field."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import Annulus, Material, PointLoad, Robot, RobotError, Rod, Straight, Tendon, TensionProfile, Tube
from tactr.materials import nitinol
from tactr.statics import Prepared, Shape

ACTUATION: dict[str, Any] = {
    "tension": [1.0, 2.0, 0.0],
    "rotation": [0.3, -0.4],
    "translation": [-0.01, -0.05],
}
NAMES = {"tension": ("a", "b", "c"), "rotation": ("outer", "inner"), "translation": ("outer", "inner")}


def assert_same(one: Shape, other: Shape, atol: float = 1e-12) -> None:
    assert one.converged and other.converged
    np.testing.assert_allclose(one.centreline, other.centreline, rtol=0.0, atol=atol)
    np.testing.assert_allclose(one.s, other.s, rtol=0.0, atol=1e-15)
    assert one.robot == other.robot


@pytest.mark.parametrize("names", [("tension",), ("rotation",), ("translation",), tuple(ACTUATION)])
def test_arrays_lists_and_mappings_are_one(robot: Robot, names: tuple[str, ...]) -> None:
    prepared = Prepared(robot)
    lists = {name: ACTUATION[name] for name in names}
    arrays = {name: np.array(values) for name, values in lists.items()}
    mappings = {name: dict(zip(NAMES[name], values, strict=True)) for name, values in lists.items()}
    expected = tactr.solve(robot.with_actuation(**lists))
    for given in (lists, arrays, mappings):
        assert_same(prepared.solve(**given), expected)
        assert_same(tactr.solve(robot, **given), expected)


def test_what_is_left_out_stays(robot: Robot, shape: Shape) -> None:
    prepared = Prepared(robot)
    prepared.solve(**ACTUATION)
    assert_same(prepared.solve(), shape)
    assert_same(prepared.solve(tension={"a": 2.0}), shape)


def test_a_shape_keeps_its_actuation_when_the_array_changes(robot: Robot) -> None:
    tension = np.array([1.0, 1.0, 1.0])
    shape = Prepared(robot).solve(tension=tension)
    tension[:] = 3.0
    assert [tendon.tension for tendon in shape.robot.tendons] == [1.0, 1.0, 1.0]


WRONG = [
    ("tension", [1.0, 2.0], "tension"),
    ("tension", [1.0, 2.0, 3.0, 4.0], "tension"),
    ("tension", [[1.0, 2.0, 3.0]], "tension"),
    ("tension", [1.0, math.nan, 0.0], "tendons[1].tension"),
    ("tension", [1.0, 0.0, math.inf], "tendons[2].tension"),
    ("tension", [-0.1, 0.0, 0.0], "tendons[0].tension"),
    ("tension", {"d": 1.0}, "tension"),
    ("tension", {"b": -1.0}, "tendons[1].tension"),
    ("tension", "abc", "tension"),
    ("rotation", [0.1], "rotation"),
    ("rotation", [0.1, math.nan], "tubes[1].rotation"),
    ("rotation", {"middle": 1.0}, "rotation"),
    ("translation", [0.0, 0.0, 0.0], "translation"),
    ("translation", [0.01, 0.0], "tubes[0].translation"),
    ("translation", [-0.1, 0.0], "tubes[0].translation"),
    ("translation", [0.0, -0.3], "tubes[1].translation"),
    ("translation", [math.nan, 0.0], "tubes[0].translation"),
    ("translation", [0.0, -0.16], "tendons[1].end"),
]


@pytest.mark.parametrize(("name", "values", "field"), WRONG)
def test_wrong_actuation_names_the_field(robot: Robot, name: str, values: Any, field: str) -> None:
    given = [values]
    if isinstance(values, list):
        given.append(np.array(values))
    for value in given:
        for call in (Prepared(robot).solve, lambda **actuation: tactr.solve(robot, **actuation)):
            with pytest.raises(RobotError) as caught:
                call(**{name: value})
            assert caught.value.field == field
            assert caught.value.expected


def test_wrong_name_lists_those_there_are(robot: Robot) -> None:
    with pytest.raises(RobotError, match="'a'.*'b'.*'c'"):
        Prepared(robot).solve(tension={"z": 1.0})


def rod(**changes: Any) -> Robot:
    tube = Tube("rod", length=0.2, section=Rod(0.001), material=nitinol)
    tendons = [
        Tendon("t", "rod", Straight(0.005, 0.0), tension=1.0),
        Tendon("u", "rod", Straight(0.0, 0.005)),
    ]
    return Robot([tube], tendons, **changes)


PROFILE = TensionProfile([0.0, 0.1, 0.2], [2.0, 1.5, 0.5])


def test_tension_profile_given_to_a_prepared_robot() -> None:
    expected = tactr.solve(rod().with_actuation(tension={"t": PROFILE}))
    assert_same(Prepared(rod()).solve(tension={"t": PROFILE}), expected)
    assert_same(tactr.solve(rod(), tension=[PROFILE, 0.0]), expected)
    assert abs(expected.tip_position[0] - tactr.solve(rod()).tip_position[0]) > 1e-4


def test_number_in_place_of_a_tension_profile() -> None:
    prepared = Prepared(rod().with_actuation(tension={"t": PROFILE}))
    expected = tactr.solve(rod())
    assert_same(prepared.solve(tension={"t": 1.0}), expected)
    assert_same(prepared.solve(tension=np.array([1.0, 0.0])), expected)


def test_a_profile_stays_when_another_tension_changes() -> None:
    prepared = Prepared(rod().with_actuation(tension={"t": PROFILE}))
    assert_same(prepared.solve(tension={"u": 0.5}), tactr.solve(rod(), tension=[PROFILE, 0.5]))


def test_a_flat_profile_is_a_tension() -> None:
    flat = TensionProfile([0.0, 0.2], [1.0, 1.0])
    one, other = tactr.solve(rod(), tension={"t": flat}), tactr.solve(rod())
    np.testing.assert_allclose(one.centreline, other.centreline, rtol=0.0, atol=1e-12)


def test_guess_of_a_neighbour_gives_the_same_shape(robot: Robot, shape: Shape) -> None:
    near = tactr.solve(robot, tension=[2.1, 1.05, 0.5], rotation=[0.05, 0.75])
    warm = Prepared(robot).solve(guess=near)
    assert_same(warm, shape, atol=1e-6)
    assert warm.iterations <= shape.iterations


def test_guess_of_another_robot_is_harmless(robot: Robot, shape: Shape) -> None:
    stranger = tactr.solve(rod(), tension=[0.5, 0.2])
    assert_same(tactr.solve(robot, guess=stranger), shape)
    cold = tactr.solve(rod())
    assert_same(tactr.solve(rod(), guess=shape), cold, atol=1e-6)


@pytest.mark.parametrize("translation", [-0.05, -0.19])
def test_guess_at_other_insertions(robot: Robot, shape: Shape, translation: float) -> None:
    """The sections of the guess differ in length, and in order where the inner tube is the shorter one."""
    changed = robot.replace(tendons=[robot.tendons[0]])
    cold = tactr.solve(changed)
    far = tactr.solve(changed, translation={"inner": translation})
    assert_same(tactr.solve(changed, guess=far), cold, atol=1e-6)


def test_guess_that_did_not_converge_is_left_aside(robot: Robot, shape: Shape) -> None:
    failed = tactr.solve(robot, tension=[1e6, 0.0, 0.0])
    assert not failed.converged
    assert_same(tactr.solve(robot, guess=failed), shape)


def test_loads_replace_those_of_the_robot() -> None:
    load = PointLoad("rod", force=(0.1, 0.0, 0.0))
    loaded = tactr.solve(rod(loads=[load]))
    assert_same(tactr.solve(rod(), loads=[load]), loaded)
    np.testing.assert_array_equal(
        tactr.solve(rod(loads=[load]), loads=[]).tip_position, tactr.solve(rod()).tip_position
    )
    with pytest.raises(RobotError) as caught:
        tactr.solve(rod(), loads=[PointLoad("mast", force=(1.0, 0.0, 0.0))])
    assert caught.value.field == "loads[0].tube"


def test_repr() -> None:
    assert repr(Prepared(rod())).startswith("<Prepared <Robot")


def test_a_stepped_tube_is_not_moved_to_where_it_does_not_fit():
    soft = Material(E=5e9, nu=0.3)
    narrowing = [(0.0, Annulus(3e-3, 2.5e-3)), (0.1, Annulus(3e-3, 1.5e-3))]
    stepped = [(0.0, Annulus(2e-3, 1e-3)), (0.1, Annulus(1.2e-3, 1e-3))]
    outer = Tube("outer", length=0.2, section=narrowing, material=soft)
    inner = Tube("inner", length=0.3, section=stepped, material=soft)
    prepared = Prepared(Robot([outer, inner]))
    assert prepared.solve(translation=np.array([0.0, -0.05])).converged
    with pytest.raises(RobotError, match="does not fit into the bore"):
        prepared.solve(translation=np.array([-0.05, 0.0]))
