"""What assumptions do to the tip: exact derivatives against differences of solved shapes."""

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import examples
from tactr.reproduce.assumptions import assumed_fields, assumptions
from tactr.reproduce.effects import effects
from tactr.reproduce.records import Case

SMALL = 1e-2  # of the change that the report shows


def tip(robot) -> np.ndarray:
    shape = tactr.solve(robot, tolerance=1e-9)
    assert shape.converged
    return shape.tip_position


def cases_of(reproduction):
    for experiment in reproduction.experiments:
        for case in experiment.cases if experiment.effects else ():
            yield experiment, case


def test_first_order_is_the_limit_of_solved_differences(reproduction):
    """Fourth order in the change, so that 1 % of it leaves 1e-8 of the curve."""
    count = 0
    for experiment, case in cases_of(reproduction):
        moved = {effect.fields: effect for effect in experiment.effects}
        for one in assumptions(case.robot):
            (move,) = [m for m in moved[one.fields].moves if m.label == case.label]
            robots = [one.applied(case.robot, k * SMALL) for k in (-2, -1, 1, 2)]
            assert None not in robots
            a, b, c, d = map(tip, robots)
            difference = np.linalg.norm((a - 8 * b + 8 * c - d) / 12) / SMALL
            assert move.first_order == pytest.approx(difference, rel=1e-4, abs=2e-6), (case.label, one.what)
            count += 1
    assert count > 60


def test_solved_moves_are_those_of_a_robot_changed_by_hand(reproduction):
    experiment = reproduction["three_tubes"]
    case = experiment.cases[2]
    (effect,) = [e for e in experiment.effects if e.fields == ("tendons[2].tension",)]
    for factor, solved in ((0.9, effect.moves[2].less), (1.1, effect.moves[2].more)):
        moved = tactr.solve(case.robot, tension={"inner": factor * 0.5})
        assert solved == pytest.approx(np.linalg.norm(moved.tip_position - case.shape.tip_position), abs=1e-9)


def test_tubes_that_no_longer_fit_are_left_out(reproduction):
    """1.05 mm and 5 % more does not slide into a bore of 1.07 mm."""
    (effect,) = [e for e in reproduction["helical"].effects if e.fields == ("tubes[1].outer_diameter",)]
    assert effect.moves[0].more is None
    assert effect.moves[0].less > 1e-3


def test_a_robot_s_size_of_stiffness_does_not_matter_without_loads(reproduction):
    (effect,) = [e for e in reproduction["ctr"].effects if e.fields[0] == "tubes[0].stiffness"]
    assert effect.fields == ("tubes[0].stiffness", "tubes[1].stiffness")
    assert effect.largest < 1e-9


def test_longer_robots_reach_farther(reproduction):
    (effect,) = [e for e in reproduction["ctr"].effects if e.fields[0] == "tubes[0].length"]
    for move in effect.moves:
        assert move.first_order == pytest.approx(1e-3, rel=0.02)


@pytest.mark.parametrize("name", ["two_tube_90", "three_tube_c", "tendon_assignment_b", "ctr", "exonav2"])
def test_every_assumed_number_is_varied(name):
    robot = examples.load(name)
    varied = {field for one in assumptions(robot) for field in one.fields}
    drawn = {field for field, reason in assumed_fields(robot).items() if "only drawn" in reason}
    assert varied == assumed_fields(robot).keys() - drawn


def test_readings_have_no_derivative(reproduction):
    for key in ("helical", "exonav"):
        reading = reproduction[key].effects[0]
        assert all(move.first_order is None and move.more > 1e-3 for move in reading.moves)


def test_as_above_is_changed_together():
    robot = examples.load("two_tube_0")
    offsets = assumptions(robot)[-1]
    assert offsets.fields == ("tendons[0].routing", "tendons[1].routing")
    grown = offsets.applied(robot, 1.0)
    assert grown is not None
    assert [tendon.routing.r(0.0)[1] for tendon in grown.tendons] == pytest.approx([7.15e-3, 7.15e-3])
    assert offsets.value == "6.5 mm"


def test_remarks_that_name_no_field_are_passed_over():
    robot = replace(examples.load("two_tube_0"), assumed=("everything", "tubes[0].length: a guess"))
    (one,) = effects([Case("", tactr.solve(robot))])
    assert one.reason == "a guess"
    assert one.value == "140 mm"


def test_unstable_or_missing_shapes_give_no_number():
    """A tension far too large has no shape to compare with."""
    robot = replace(examples.load("two_tube_0"), assumed=("tendons[1].tension: a guess",))
    (assumption,) = assumptions(robot)
    broken = assumption.applied(robot, -20.0)
    assert broken is None  # a negative tension
