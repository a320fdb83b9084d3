"""The robot: parts that fit, lookup by name, changes."""

import pickle
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest

from tactr.errors import RobotError
from tactr.robot import (
    Annulus,
    DistributedLoad,
    Gravity,
    PointLoad,
    Robot,
    Rod,
    Spline,
    Stiffness,
    Tendon,
    TensionProfile,
    Tube,
)


def test_parts_are_stored_as_tuples(robot: Robot) -> None:
    assert isinstance(robot.tubes, tuple)
    assert isinstance(robot.tendons, tuple)
    assert robot.loads == robot.assumed == ()
    assert Robot(robot.tubes, robot.tendons, name="two tubes") == robot
    assert hash(robot.replace(name="two tubes")) == hash(robot)
    assert pickle.loads(pickle.dumps(robot)) == robot
    with pytest.raises(FrozenInstanceError):
        robot.name = "other"  # type: ignore[misc]


def test_repr_is_short(robot: Robot) -> None:
    text = "<Robot 'two tubes'; 2 tubes: outer 140 mm, inner 180 mm; 2 tendons: pull 3 N, bend 2 N>"
    assert repr(robot) == text
    loaded = Robot(robot.tubes[:1], loads=[Gravity()])
    assert repr(loaded) == "<Robot; 1 tube: outer 140 mm; 1 load>"
    profile = robot.with_actuation(tension={"pull": TensionProfile((0, 0.1), (1, 2))})
    assert "pull (profile)" in repr(profile)


def test_lookup(robot: Robot) -> None:
    assert robot.tube("inner") is robot.tubes[1]
    assert robot.tendon("pull") is robot.tendons[0]
    with pytest.raises(
        RobotError, match=r"'Innr'; expected one of 'outer', 'inner' \(did you mean 'inner'\?\)"
    ):
        robot.tube("Innr")
    with pytest.raises(RobotError, match="expected none, because there are none"):
        robot.replace(tendons=()).tendon("pull")
    with pytest.raises(RobotError, match="no tube 0"):
        robot.tube(0)  # type: ignore[arg-type]


def test_tubes_and_tendons_may_share_a_name(outer: Tube, robot: Robot) -> None:
    same = replace(robot.tendons[0], name="outer")
    assert Robot([outer], [same]).tendon("outer") is same


def test_snug_fit_and_rounding(outer: Tube, inner: Tube) -> None:
    Robot([outer, replace(inner, section=Rod(0.0008))])
    Robot([outer, replace(inner, section=Rod(np.nextafter(0.0008, 1)))])


def test_unknown_diameters_are_not_checked(outer: Tube, inner: Tube) -> None:
    given = Stiffness(EA=1e4, GA=1e3, EI_x=1e-3, EI_y=1e-3, GJ=1e-3)
    Robot([outer, replace(inner, section=given)])
    Robot([replace(outer, section=given), replace(inner, section=Rod(0.1))])


def test_any_order_of_ends(outer: Tube, inner: Tube) -> None:
    withdrawn = replace(inner, translation=-0.1)
    assert Robot([outer, withdrawn]).tubes[1].tip == pytest.approx(0.08)


def test_eight_tubes(outer: Tube) -> None:
    nested = [
        replace(outer, name=f"t{k}", section=Annulus(0.01 - 0.001 * k, 0.0091 - 0.001 * k)) for k in range(8)
    ]
    assert len(Robot(nested).tubes) == 8


def test_loads_that_fit(robot: Robot) -> None:
    loads = [
        PointLoad("inner", force=(0, 0.1, 0)),
        PointLoad("outer", at=0.14, axes="body"),
        DistributedLoad(start=0.5, end=0.6),
        DistributedLoad("outer", end=0.14),
        Gravity(),
    ]
    assert robot.replace(loads=loads).loads == tuple(loads)


def test_errors_name_the_robot(robot: Robot) -> None:
    with pytest.raises(RobotError) as caught:
        robot.replace(tendons=[replace(robot.tendons[0], tube="outr")])
    assert str(caught.value).startswith("Robot 'two tubes': tendons[0].tube: there is no tube 'outr'")


def test_replace_lists_fields(robot: Robot) -> None:
    assert robot.replace(description="x", assumed=["diameters"]).assumed == ("diameters",)
    with pytest.raises(RobotError, match=r"did you mean 'tubes'\?"):
        robot.replace(tube=())


@pytest.mark.parametrize("tension", [(1, 4), [1, 4], np.array([1, 4]), {"bend": 4, "pull": 1}])
def test_tension(robot: Robot, tension: Any) -> None:
    pulled = robot.with_actuation(tension=tension)
    assert [tendon.tension for tendon in pulled.tendons] == [1.0, 4.0]
    assert all(type(tendon.tension) is float for tendon in pulled.tendons)
    assert [tendon.tension for tendon in robot.tendons] == [3.0, 2.0]


def test_actuation_equals_building_anew(robot: Robot) -> None:
    moved = robot.with_actuation(
        tension={"pull": 5}, rotation={"inner": 0.5}, translation=np.array([-0.01, -0.02])
    )
    outer, inner = robot.tubes
    assert moved == robot.replace(
        tubes=[replace(outer, translation=-0.01), replace(inner, rotation=0.5, translation=-0.02)],
        tendons=[replace(robot.tendons[0], tension=5), robot.tendons[1]],
    )
    assert hash(moved) != hash(robot)
    assert moved.tubes[0].stiffness == outer.stiffness


def test_no_actuation_changes_nothing(robot: Robot) -> None:
    assert robot.with_actuation() == robot
    assert robot.with_actuation(tension={}, rotation={}) == robot


def test_nothing_cached_on_a_robot_survives_a_change(robot: Robot) -> None:
    robot.__dict__["_prepared"] = object()
    assert "_prepared" not in robot.with_actuation(tension=(1, 1)).__dict__


BAD: list[tuple[dict[str, Any], str, str]] = [
    (
        {"tension": {"bnd": 1}},
        "tension",
        "no tendon 'bnd'; expected one of 'pull', 'bend' (did you mean 'bend'?)",
    ),
    ({"rotation": {"x": 1}}, "rotation", "no tube 'x'; expected one of 'outer', 'inner'"),
    (
        {"tension": (1,)},
        "tension",
        "1 values for 2 tendons; expected a mapping from names to values, or 2 values",
    ),
    ({"tension": (1, 2, 3)}, "tension", "in the order 'pull', 'bend'"),
    ({"tension": 5}, "tension", "5 is not a list"),
    ({"tension": (1, -2)}, "tendons[1].tension", "-2 N is too small"),
    ({"tension": {"bend": -2}}, "tendons[1].tension", "Tendon 'bend'"),
    ({"tension": {"pull": np.nan}}, "tendons[0].tension", "nan"),
    ({"tension": {"pull": True}}, "tendons[0].tension", "True"),
    ({"rotation": (0, "x")}, "tubes[1].rotation", "'x' is text"),
    ({"translation": (0, 0.01)}, "tubes[1].translation", "0.01 m is too large"),
    ({"translation": (0, -0.18)}, "tubes[1].translation", "nothing of 'inner' outside the guide"),
]


@pytest.mark.parametrize(("change", "field", "part"), BAD)
def test_bad_actuation(robot: Robot, change: dict[str, Any], field: str, part: str) -> None:
    with pytest.raises(RobotError) as caught:
        robot.with_actuation(**change)
    assert caught.value.field == field
    assert part in str(caught.value)


def test_retracting_checks_tendon_ends(robot: Robot) -> None:
    short = robot.replace(tendons=[replace(robot.tendons[0], end=0.05)])
    with pytest.raises(RobotError, match="inside the guide") as caught:
        short.with_actuation(translation={"outer": -0.06})
    assert caught.value.field == "tendons[0].end"


def test_routing_must_reach_the_end_of_the_tendon(outer: Tube) -> None:
    spline = Spline((0, 0.1), ((0.01, 0), (0.01, 0)))
    Robot([outer], [Tendon("t", "outer", spline, end=0.1)])
    with pytest.raises(RobotError, match=r"runs along 'outer' to 0\.14 m"):
        Robot([outer], [Tendon("t", "outer", spline)])
