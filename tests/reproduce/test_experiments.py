"""The experiments: solved shapes, fits and verdicts, against what is known without them."""

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Annulus, examples
from tactr.reproduce import printed, steel_tube
from tactr.reproduce.fitting import displacement, fit, scaled
from tactr.reproduce.helical import telescoped
from tactr.reproduce.published import tip_apart

KEYS = ["two_tubes", "helical", "loading", "three_tubes", "assignment", "ctr", "tacter", "exonav"]


def found(experiment, words):
    """The one check whose statement has these words."""
    (check,) = [check for check in experiment.checks if words in check.statement]
    return check


def test_every_experiment_is_there_and_solved(reproduction):
    assert [each.key for each in reproduction.experiments] == KEYS
    for each in reproduction.experiments:
        assert all(case.shape.converged for case in each.cases)
        assert each.setting and each.caption and each.figure
        assert each.count("cannot be checked") == 1
        assert sum(each.count(verdict) for verdict in ("holds", "fitted", "does not hold")) >= 2
        assert reproduction[each.key] is each
    with pytest.raises(KeyError, match="there are two_tubes, helical"):
        reproduction["ctrs"]


def test_what_was_chosen_for_a_number_is_not_said_to_hold(reproduction):
    fitted = {each.key: each.count("fitted") for each in reproduction.experiments}
    assert {key: count for key, count in fitted.items() if count} == {"two_tubes": 1, "ctr": 1, "tacter": 2}


def test_only_the_helical_percentage_fails(reproduction):
    failed = {each.key: each.count("does not hold") for each in reproduction.experiments}
    assert failed == {key: 2 if key == "helical" else 0 for key in KEYS}


def test_the_fit_meets_the_printed_motion():
    """Solved anew from the robot file, with nothing but the fitted diameter."""
    robot = examples.load("two_tube_0")
    used, *others = steel_tube.fits()
    assert used.used
    assert not any(other.used for other in others)
    steel = replace(robot.tubes[1], section=Annulus(used.value, 0.4e-3))
    tip = tactr.solve(robot.replace(tubes=(robot.tubes[0], steel))).tip_position
    assert np.linalg.norm(tip - [0, 0, 0.180]) == pytest.approx(90.14e-3, abs=1e-8)
    assert used.span[0] < used.value < used.span[1]


def test_the_fit_less_and_more_than_printed():
    """The ends of the span move the tip by the printed error less and more; thinner tubes farther."""
    robot = examples.load("two_tube_0")
    used = steel_tube.fits()[0]
    paths = ["tubes.inner.section.outer_diameter"]
    reached = [displacement(tactr.solve(scaled(robot, paths, value / used.start))) for value in used.span]
    assert reached == pytest.approx([90.14e-3 + 4.34e-3, 90.14e-3 - 4.34e-3], abs=1e-8)


def test_other_fits_meet_it_too():
    robot = examples.load("two_tube_0")
    paths = {
        "outer diameter of the nitinol tube": ["tubes.outer.section.outer_diameter"],
        "offset of both tendons": ["tendons.outer.routing.y", "tendons.inner.routing.y"],
    }
    for other in steel_tube.fits():
        if other.what in paths:
            shape = tactr.solve(scaled(robot, paths[other.what], other.value / other.start))
            assert displacement(shape) == pytest.approx(90.14e-3, abs=1e-8)


def test_a_fit_that_cannot_be_met():
    with pytest.raises((tactr.NotConverged, tactr.RobotError)):
        fit(examples.load("two_tube_0"), "", ["tubes.inner.section.outer_diameter"], 0.5, within=1e-3)


def test_outer_tendon_alone_bends_the_two_tubes_to_an_arc(reproduction):
    """kappa = T r / (EI_1 + EI_2) of thin rods bent by a tendon at offset r, straight beyond its end."""
    robot = reproduction["two_tubes"].cases[0].robot
    shape = tactr.solve(robot, tension={"inner": 0.0})
    bending = sum(tube.stiffness.EI_x for tube in robot.tubes)
    kappa, length, beyond = 3.0 * 6.5e-3 / bending, 0.140, 0.040
    turn = kappa * length
    y = (1 - np.cos(turn)) / kappa + beyond * np.sin(turn)
    z = np.sin(turn) / kappa + beyond * np.cos(turn)
    assert shape.tip_position == pytest.approx([0, y, z], abs=2e-4)


def test_three_tubes_have_the_fitted_steel_tube(reproduction):
    value = steel_tube.fits()[0].value
    for key in ("three_tubes", "assignment"):
        for case in reproduction[key].cases:
            assert case.robot.tubes[1].outer_diameter == value
    assert reproduction["loading"].cases[0].robot.tubes[1].outer_diameter == value


def test_loading_ends_where_a_solve_from_cold_does(reproduction):
    experiment = reproduction["loading"]
    _, outer, inner = experiment.figure[0]
    x, y, _ = 1e3 * experiment.cases[0].shape.tip_position
    assert inner.lines[0].y[-1] == pytest.approx(x, abs=1e-3)
    assert outer.lines[0].y[0] == pytest.approx(0, abs=1e-9)
    assert outer.lines[0].x[-1] == 3.0
    assert inner.lines[0].x[-1] == 2.0
    for graph in (outer, inner):
        assert graph.lines[1].y == pytest.approx(graph.lines[0].y, abs=2e-3)
    only_outer = tactr.solve(experiment.cases[0].robot, tension={"inner": 0.0}).tip_position
    assert outer.lines[0].y[-1] == pytest.approx(1e3 * only_outer[1], abs=1e-3)
    assert y == pytest.approx(51.7, abs=0.1)


def test_assumed_friction_opens_a_loop(reproduction):
    """A tendon that rubs pulls less at the tip than the motor does, and more on the way back."""
    experiment = reproduction["loading"]
    for graph, axis in zip(experiment.figure[0][1:], (1, 0), strict=True):
        plain, _, loading, unloading = graph.lines
        without = np.interp(loading.x, plain.x, plain.y)
        assert loading.x[0] == 0.0 and (loading.y[1:] < without[1:]).all(), axis
        assert (unloading.y[1:-1] > without[1:-1]).all(), axis
    outer = experiment.figure[0][1].lines[2]
    # Far from the others the outer tendon bends its tube by 3 N (1 - exp(-mu theta)) / (mu theta) on average.
    shape = experiment.cases[0].shape
    bend = tactr.solve(shape.robot, tension=[3.0, 0.0])
    theta = np.arccos(bend.sample([0.14]).tubes[0].frames[0][2, 2])
    mean = (1.0 - np.exp(-0.15 * theta)) / (0.15 * theta)
    less = tactr.solve(shape.robot, tension=[3.0 * mean, 0.0]).tip_position[1]
    assert outer.y[-1] == pytest.approx(1e3 * less, abs=0.5)
    effect = experiment.effects[0]
    assert effect.fields[0] == "tendons[0].friction" and "assumed" in experiment.setting
    (move,) = effect.moves
    assert move.less is not None and move.more is not None
    assert move.more == pytest.approx(2.0 * move.less, rel=0.15)  # half less and once more, nearly linear


def test_assignments_are_as_far_apart_as_their_errors_allow(reproduction):
    a, b = (case.shape.tip_position for case in reproduction["assignment"].cases)
    assert 34.28e-3 - 4.69e-3 < np.linalg.norm(a - b) < 34.28e-3 + 4.69e-3
    check = found(reproduction["assignment"], "All pulled")
    assert f"{1e3 * np.linalg.norm(a - b):.2f} mm" in check.found
    assert "29.59 to 38.97 mm" in check.statement


def test_ctr_at_0_is_an_arc_of_the_printed_radius(reproduction):
    """Tubes of equal curvature, aligned, do not act on each other."""
    tip = reproduction["ctr"].cases[0].shape.tip_position
    radius, turn = 0.219, 0.150 / 0.219
    assert tip == pytest.approx([0, -radius * (1 - np.cos(turn)), radius * np.sin(turn)], abs=1e-6)


def test_ctr_angles(reproduction):
    turned = [np.degrees(case.robot.tubes[1].rotation) for case in reproduction["ctr"].cases]
    assert turned == pytest.approx([0, 45, 90, 135, 180])


def test_tacter_poses(reproduction):
    half, left, right = reproduction["tacter"].cases
    assert left.robot.tubes[1].tip == pytest.approx(75.7e-3)
    assert half.robot.tubes[1].tip == pytest.approx(40e-3 + (75.7e-3 - 40e-3) / 2)
    assert left.shape.tip_position[1] > right.shape.tip_position[1]


def test_the_paper_s_rest_frame_of_exonav_gives_a_helix_along_z(reproduction):
    from tactr.reproduce.exonav import turned_about_z

    robot = examples.load("exonav2")
    k = np.hypot(0.822, 52.35)
    radius = 0.822 / k**2
    line = tactr.solve(turned_about_z(robot), tension=[0.0]).centreline
    angle = np.pi / 2 + k * np.linspace(0, 75.4e-3, len(line))
    wanted = radius * np.column_stack([np.cos(angle), np.sin(angle) - 1])
    assert line[:, :2] == pytest.approx(wanted, abs=1e-8)
    assert radius == pytest.approx(0.3e-3, rel=1e-3)


def test_the_other_reading_of_the_helix():
    robot = examples.load("helical")
    other = telescoped(robot)
    assert [tube.length for tube in other.tubes] == [0.140, 0.280]
    assert [tube.section for tube in other.tubes] == [tube.section for tube in robot.tubes]
    assert other.tendons[0].routing == robot.tendons[0].routing
    assert other.tendons[0].tube == "inner"


def test_published_conditions_matter_for_slanted_tendons_only():
    """A slanted tendon's direction jumps where the curvature does, a straight one's does not (theory)."""
    assert tip_apart(tactr.solve(examples.load("two_tube_90"))) < 1e-7
    assert 5e-5 < tip_apart(tactr.solve(examples.load("helical"))) < 2e-4


def test_rigid_disks_on_the_rod(reproduction):
    (text,) = [words for words in reproduction["three_tubes"].findings if "disks" in words]
    share = 1 - float(printed.ROD_COVERED) / float(printed.ROD_FREE)
    assert f"{255 * share:.1f} GPa" in text
    assert f"{98 * share:.1f} GPa" in text


def test_poisson_s_ratios(reproduction):
    """G = E / (2 (1 + nu)): 45 / 33.82 - 1 and 215 / 160 - 1."""
    (text,) = [words for words in reproduction["two_tubes"].findings if "Poisson" in words]
    assert "0.33 (outer tube), 0.34 (inner tube)" in text
