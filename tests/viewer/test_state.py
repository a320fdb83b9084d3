"""Controls, their limits, and the robot that they make."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import PointLoad, RobotError, TendonLimits, TubeLimits, examples
from tactr.viewer.controls import controls, most_tension, round_up
from tactr.viewer.readings import columns, row
from tactr.viewer.session import Session
from tactr.viewer.state import State, as_python


def _limited() -> tactr.Robot:
    robot = examples.load("two_tube_90")
    outer = replace(robot.tubes[0], limits=TubeLimits(rotation=(-1.0, 2.0), translation=(-0.06, -0.01)))
    pull = replace(robot.tendons[0], limits=TendonLimits(tension=(0.5, 7.0)))
    pushed = replace(
        robot.tendons[1], tension=0.0, displacement=2e-3, limits=TendonLimits(displacement=(-1e-3, 4e-3))
    )
    return robot.replace(tubes=(outer, robot.tubes[1]), tendons=(pull, pushed))


def test_limits_come_from_the_robot():
    found = {control.key: control for control in controls(_limited())}
    assert list(found) == [
        ("tension", "outer"), ("displacement", "inner"), ("rotation", "outer"), ("rotation", "inner"),
        ("insertion", "outer"), ("insertion", "inner"), ("force", "x"), ("force", "y"), ("force", "z"),
    ]  # fmt: skip
    tension, pull = found["tension", "outer"], found["displacement", "inner"]
    assert (tension.low, tension.high, tension.value, tension.unit) == (0.5, 7.0, 3.0, "N")
    assert (pull.low, pull.high, pull.value, pull.unit) == (-1.0, 4.0, 2.0, "mm")
    turned = found["rotation", "outer"]
    assert (turned.low, turned.high) == pytest.approx((math.degrees(-1.0), math.degrees(2.0)))
    inserted = found["insertion", "outer"]  # 140 mm long; now at 0, beyond its limits
    assert (inserted.low, inserted.high, inserted.value) == pytest.approx((80.0, 140.0, 140.0))


@pytest.mark.parametrize("name", examples.names())
def test_every_place_of_every_slider_is_a_robot(name):
    robot = examples.load(name)
    for control in controls(robot):
        assert control.low <= control.value <= control.high
        assert 50 <= (control.high - control.low) / control.step <= 200.0001
        for value in (control.low, control.high):
            moved = State(robot).with_value(control.key, value / control.factor).actuated
            assert len(moved.tubes) == len(robot.tubes)
    assert most_tension(robot) > 0


def test_a_tendon_that_ends_early_stays_outside():
    robot = examples.load("two_tube_90")
    tendon = replace(robot.tendons[0], end=0.05)
    low = next(c.low for c in controls(robot.replace(tendons=(tendon,))) if c.key == ("insertion", "outer"))
    assert low == pytest.approx(91.0)  # of 140 mm; the tendon ends 50 mm from the proximal end
    stuck = replace(robot.tendons[0], end=1e-4)
    found = next(c for c in controls(robot.replace(tendons=(stuck,))) if c.key == ("insertion", "outer"))
    assert (found.low, found.high) == (140.0, 140.0) and found.step > 0


def test_the_robot_of_a_state():
    robot = examples.load("two_tube_90").replace(loads=(PointLoad("outer", force=(0, 0.01, 0)),))
    state = State(robot)
    assert state.actuated == robot
    state = state.with_value(("tension", "outer"), 1.5).with_value(("insertion", "inner"), 0.15)
    state = replace(state.with_value(("force", "z"), 0.05), host="own (B)", loads=False)
    made = state.actuated
    assert made.tendon("outer").tension == 1.5
    assert made.tube("inner").translation == pytest.approx(-0.03)
    assert made.loads == (PointLoad("inner", force=(0.0, 0.0, 0.05)),)
    assert {tendon.host for tendon in made.tendons} == {"own"}
    assert made.tendon("inner").tension == robot.tendon("inner").tension


@pytest.mark.parametrize(
    ("host", "loads", "force"),
    [("as in the file", True, 0.0), ("outermost (A)", False, 0.02), ("own (B)", True, 0.01)],
)
def test_python_that_is_copied_finds_the_same_tip(host, loads, force):
    state = replace(State(examples.load("till_helical")), host=host, loads=loads)
    state = state.with_value(("tension", "tendon"), 10.0).with_value(("rotation", "backbone"), 0.3)
    if force:
        state = state.with_value(("force", "y"), force)
    names: dict[str, Any] = {}
    exec(as_python(state, 'tactr.examples.load("till_helical")'), names)
    np.testing.assert_allclose(
        names["shape"].tip_position, tactr.solve(state.actuated).tip_position, atol=1e-9
    )


def test_a_row_has_a_value_for_every_column():
    session = Session()
    for name in ("three_tube_a", "three_tube_ctr", "rucker_webster"):
        robot = examples.load(name)
        session.start()
        own = controls(robot)
        heads = columns(robot, own)
        outcome = session.solve(State(robot))
        values = dict(zip(heads, row(1.0, outcome, own), strict=True))
        assert outcome.shape is not None
        x, y, z = 1e3 * outcome.shape.tip_position
        assert [values[f"tip {axis} [mm]"] for axis in "xyz"] == pytest.approx([x, y, z])
        assert all(np.isfinite(list(values.values())))
        failed = session.solve(State(robot).with_value(("force", "x"), 1e6))
        values = dict(zip(heads, row(2.0, failed, own), strict=True))
        assert np.isnan(values["tip x [mm]"]) and values["force x [N]"] == 1e6


def test_round_up():
    assert [round_up(x) for x in (1.0, 1.1, 3.0, 5.0, 7.0, 0.02, 0.03)] == [1, 2, 5, 5, 10, 0.02, 0.05]


def test_a_state_that_makes_no_robot_raises():
    with pytest.raises(RobotError):
        _ = State(examples.load("two_tube_90")).with_value(("tension", "outer"), -1.0).actuated
