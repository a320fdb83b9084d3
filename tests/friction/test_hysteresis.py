"""Loops of tensions and displacements: dead band, closure, memory, heat."""

import copy
import json
import math
import pickle
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tactr
from tactr import Annulus, DriveState, Material, PointLoad, Robot, Straight, Tendon, Tube, _core
from tactr.friction.equilibrium import Equilibrium
from tactr.friction.profiles import FoundProfiles
from tactr.statics.solve import Prepared

from .robots import SOFT, bending, legs, pulled, rubbing_tubes, twisting_tubes, two_curved_tubes


@pytest.mark.parametrize("actuation", ["tension", "displacement"])
def test_without_friction_it_is_plain_statics(actuation):
    robot = bending(0.0, both=True, compliance=1e-4, pretension=1.0)
    rows = np.array([[2.0, 1.0], [5.0, 0.5], [1.0, 3.0]]) if actuation == "tension" else None
    rows = np.array([[1e-3, -1e-3], [3e-3, -3e-3], [-1e-3, 1e-3]]) if rows is None else rows
    driven = tactr.drive(robot, {actuation: rows})
    plain = [tactr.solve(robot, **{actuation: row}).tip_position for row in rows]
    assert driven.converged
    assert driven.tips == pytest.approx(np.array(plain), abs=1e-9)
    assert (driven.heat == 0.0).all()


def test_the_tip_rests_in_the_dead_band():
    """A stiff bow that rubs before a soft end that does not: nothing moves until exp(-2 mu angle)."""
    tube = Tube(
        "tube",
        length=0.2,
        section=Annulus(2e-3, 1.6e-3),
        material=[(0.0, Material(E=1e15, nu=0.3)), (0.1, SOFT)],
        precurvature=[(0.0, (math.pi / 2 / 0.1, 0.0, 0.0)), (0.1, (0.0, 0.0, 0.0))],
    )
    robot = Robot([tube], [Tendon("up", "tube", Straight(0, 1.2e-3), friction=[(0, 0.3), (0.1, 0.0)])])
    edge = 5.0 * math.exp(-2 * 0.3 * math.pi / 2)
    tips = tactr.drive(robot, pulled([5.0, 4.0, 3.0, 1.001 * edge, 0.9 * edge])).tips
    assert tips[1:4] == pytest.approx(
        np.broadcast_to(tips[0], (3, 3)), abs=1e-7
    )  # the bow still bends so much
    assert np.linalg.norm(tips[4] - tips[0]) > 5e-4


def test_the_way_back_differs_by_what_the_capstan_says():
    driven = tactr.drive(bending(), pulled([8.0, 4.0, 1.0, 4.0]))
    down, up = driven[1].tip_position, driven[3].tip_position
    assert np.linalg.norm(down - up) > 1e-3
    end = [float(state.tension("up", 0.2)[0]) for state in driven.states]
    assert end[1] > 4.0 > end[3]


def test_cuts_do_not_matter():
    corners = [1.0, 8.0, 5.0, 7.0, 2.0]
    tips = [tactr.drive(bending(), pulled(legs(corners, n))).tips[::n] for n in (1, 2, 7)]
    assert tips[0] == pytest.approx(tips[1], abs=1e-6)
    assert tips[2] == pytest.approx(tips[1], abs=1e-6)


@pytest.mark.parametrize("disks", [None, 6])
@pytest.mark.parametrize(("corners", "least"), [((0.0, 1.0), 1e-6), ((0.0, 1.0, 0.4), 1e-5)])
def test_half_the_steps_of_several_tendons(disks, corners, least):
    """Three tubes with a tendon each: from rest on one way, and back."""
    robot = rubbing_tubes(0.2, disks)
    tips = [
        tactr.drive(robot, {"tension": legs(corners, n)[:, None] * [3.0, 2.0, 1.0]}).tips[-1]
        for n in (4, 8, 16)
    ]
    assert tips[1] == pytest.approx(tips[0], abs=least)
    assert tips[2] == pytest.approx(tips[1], abs=least)


def test_half_the_steps_of_tubes_that_twist():
    """Torsion changes curvature ahead of the fronts, where no tension changes."""
    robot = twisting_tubes()
    tips = [
        tactr.drive(robot, {"tension": legs((0.0, 1.0, 0.7), n)[:, None] * [1.1, 10.6, 1.9]}).tips[:: n // 10]
        for n in (10, 20)
    ]
    assert tips[1] == pytest.approx(tips[0], abs=1e-5)


def test_what_many_steps_are_off_does_not_add_up():
    """The front of one tendon moves on in small steps; beyond it, it slides across the front of the other."""
    robot, full = two_curved_tubes(), np.array([10.6, 1.9])
    state = tactr.drive(robot, {"tension": legs((0.0, 1.0), 20)[:, None] * full}).state
    state = tactr.drive(robot, {"tension": legs((1.0, 0.64), 12)[:, None] * full}, state=state).state
    tips = [
        tactr.drive(robot, {"tension": legs((0.64, 0.61), n)[1:, None] * full}, state=state).tips[-1]
        for n in (16, 64)
    ]
    assert tips[1] == pytest.approx(tips[0], abs=1e-6)


def test_one_tube_needs_no_cuts_on_its_way_back():
    """Its curvature at a place waits for the front there, as its tension does: one step misses nothing."""
    driven = tactr.drive(bending(), pulled(legs([8.0, 3.0, 7.0], 20)))
    assert driven.steps == (1,) * 41


def test_what_a_step_misses_is_estimated():
    """Not by much too low: three tubes whose tendons are pulled out of step, one step against eight."""
    robot, turn = rubbing_tubes(0.15, None), np.linspace(0.0, 5.0, 25)[:, None]
    rows = (4.0 + 3.0 * np.cos(turn + np.arange(3.0))) * [0.75, 0.5, 0.25]
    fine = tactr.drive(robot, {"tension": legs(rows, 8)})
    channels = Equilibrium(Prepared(robot)).rows
    pairs = []
    for k in range(1, len(rows) - 1):
        before, after = fine.states[8 * k], fine.states[8 * k + 8]
        step = tactr.drive(robot, {"tension": rows[k + 1 : k + 2]}, state=before).state
        ends = before.along, step.along
        assert isinstance(ends[0], FoundProfiles) and isinstance(ends[1], FoundProfiles)
        pairs.append(
            (_core.friction_history_missed(channels, ends[0].found, ends[1].found, 1e-4), apart(step, after))
        )
    estimated, true = np.transpose([pair for pair in pairs if pair[1] > 1e-4])
    assert len(true) >= 4
    assert (estimated > 0.4 * true).all()


def apart(one: DriveState, other: DriveState) -> float:
    """Largest difference of log tension, fronts left away."""
    found = 0.0
    for tendon, profile in zip(one.tendons, one.profiles, strict=True):
        assert profile is not None
        sigma = np.linspace(0.0, profile.log.edges[-1], 400, endpoint=False)
        ratio = np.log(one.tension(tendon, sigma) / other.tension(tendon, sigma))
        found = max(found, float(np.sort(np.abs(ratio))[-4]))
    return found


@pytest.mark.parametrize("play", [0.0, 0.1])
def test_a_point_that_is_repeated_changes_no_steps(play):
    """In the kernel, and with backlash of a tube's motor in Python."""
    robot = bending()
    robot = robot.replace(tubes=tuple(replace(tube, rotation_play=play) for tube in robot.tubes))
    rows = legs([8.0, 3.0, 7.0], 2)
    once, twice = (tactr.drive(robot, pulled(line)) for line in (rows, np.repeat(rows, 2)))
    assert twice.steps[::2] == once.steps
    assert set(twice.steps[1::2]) == {1}
    assert twice.tips[1::2] == pytest.approx(once.tips, abs=1e-7)


@settings(max_examples=6, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=3, max_size=4), st.sampled_from([None, 5]))
def test_it_does_not_matter_how_many_points_the_kernel_takes_at_once(corners, disks):
    robot, rows = rubbing_tubes(0.2, disks), legs(corners, 5)[:, None] * [3.0, 2.0, 1.0]
    whole = tactr.drive(robot, {"tension": rows})
    for at_once in (7, 1):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(sys.modules["tactr.friction.drive"], "AT_ONCE", at_once)
            parts = tactr.drive(robot, {"tension": rows})
        assert parts.failed == whole.failed and parts.steps == whole.steps
        for name in ("tips", "heat", "creep", "tensions"):
            assert getattr(parts, name).tolist() == getattr(whole, name).tolist()


def test_short_ways_end():
    """Steps that come out a little longer than the shortest are taken as they are."""
    robot = rubbing_tubes(0.2, 5)
    loop = np.array([0.0, 1 / 3, 2 / 3, 1.0, 0.8, 0.6, 0.4])[:, None]
    assert tactr.drive(robot, {"tension": loop * [3.0, 2.25, 1.5]}).converged


def test_a_loop_gives_off_its_area():
    """Friction force times slip against the work of the motor."""
    driven = tactr.drive(bending(), pulled(legs([8.0, 2.0, 8.0], 80)))
    assert driven.tips[0] == pytest.approx(driven.tips[-1], abs=1e-7)
    work = tactr.work(driven.shapes)
    assert abs(work.stored) < 1e-5 * work.total
    assert work.total == pytest.approx(driven.heat.sum(), rel=1e-3)
    assert (driven.heat >= 0.0).all()


def test_a_loop_over_disks_gives_off_its_area():
    driven = tactr.drive(bending(contacts=[0.05, 0.1, 0.15]), pulled(legs([8.0, 2.0, 8.0], 60)))
    assert tactr.work(driven.shapes).total == pytest.approx(driven.heat.sum(), rel=1e-3)


@pytest.mark.parametrize("disks", [None, np.linspace(0.02, 0.2, 10) * 0.999])
def test_heat_is_known_to_second_order_where_tendons_drag_each_other(disks):
    """Against the area of the loop in fine steps, extrapolated: of two tendons out of step on one tube, with
    fronts that come by where the tube drags them."""
    robot, corners = bending(both=True, contacts=disks), [[8.0, 1.0], [2.0, 4.0], [3.0, 2.0], [8.0, 1.0]]

    def spent(cuts):
        cycle = legs(np.array(corners), cuts)
        driven = tactr.drive(robot, {"tension": np.concatenate([cycle, cycle[1:], cycle[1:]])})
        last = 2 * (len(cycle) - 1)
        return driven.heat[last + 1 :].sum(), tactr.work(driven.shapes[last:]).total

    area = (4.0 * spent(120)[1] - spent(60)[1]) / 3.0
    heat, work = spent(15)
    assert heat == pytest.approx(area, rel=3e-3)
    assert abs(heat - area) < 0.3 * abs(work - area)
    assert spent(30)[0] == pytest.approx(area, rel=6e-4)


def test_opposite_motors():
    robot = bending(both=True, compliance=1e-4, pretension=4.0)
    pull = legs([0.0, 1e-3, -1e-3, 1e-3], 8)
    driven = tactr.drive(robot, {"displacement": np.stack([pull, -pull], axis=1)})
    assert driven.converged
    assert max(shape.displacement_error for shape in driven) < 1e-7
    assert driven.tips[8] == pytest.approx(driven.tips[-1], abs=1e-6)
    assert np.linalg.norm(driven.tips[10] - driven.tips[22]) > 1e-5
    assert (driven.tensions > 0.0).all()


def test_a_slack_tendon_forgets():
    driven = tactr.drive(bending(), pulled([8.0, 0.0, 3.0]))
    fresh = tactr.drive(bending(), pulled([3.0]))
    assert driven.states[1].profiles == (None,)
    assert driven[1].tip_position == pytest.approx([0.0, 0.0, 0.2], abs=1e-9)
    assert driven.tips[2] == pytest.approx(fresh.tips[0], abs=1e-8)


@settings(max_examples=8, deadline=None)
@given(st.floats(1.5, 4.0), st.floats(0.1, 0.9), st.floats(0.1, 0.9))
def test_inner_loops_are_wiped_out(low, up, down):
    """Return-point memory: a minor loop inside another ends where it began, and leaves nothing behind."""
    high = low + up * (8.0 - low)
    inner = high - down * (high - low)
    driven = tactr.drive(bending(), pulled([8.0, low, high, inner, high, low, 8.0]))
    assert driven.tips[4] == pytest.approx(driven.tips[2], abs=1e-6)
    assert driven.tips[5] == pytest.approx(driven.tips[1], abs=1e-6)
    assert driven.tips[6] == pytest.approx(driven.tips[0], abs=1e-6)
    (profile,) = driven.states[6].profiles
    assert profile is not None and len(profile.slides) == 1


@settings(max_examples=6, deadline=None)
@given(st.lists(st.floats(0.5, 8.0), min_size=2, max_size=4))
def test_cycles_close_after_the_first(corners):
    cycle = [*corners, corners[0]]
    driven = tactr.drive(bending(0.3), pulled([*cycle, *cycle[1:], *cycle[1:]]))
    n = len(corners)
    assert driven.converged
    assert driven.tips[-n:] == pytest.approx(driven.tips[-2 * n : -n], abs=1e-6)


def test_a_state_is_all_there_is_to_remember():
    robot, corners = bending(), [8.0, 3.0, 6.0, 2.0, 5.0]
    whole = tactr.drive(robot, pulled(corners))
    first = tactr.drive(robot, pulled(corners[:3]))
    kept = DriveState.from_dict(json.loads(json.dumps(first.state.to_dict())))
    second = tactr.drive(robot, pulled(corners[3:]), state=kept)
    assert second.tips == pytest.approx(whole.tips[3:], abs=1e-8)
    assert tactr.drive(robot, pulled(corners[3:]), state=kept).tips == pytest.approx(second.tips, abs=1e-12)


def test_copies_of_a_state_mean_the_same():
    """A state keeps the kernel's profiles; what is copied or pickled is plain, and goes on alike."""
    robot = bending(both=True)
    state = tactr.drive(robot, {"tension": [[8.0, 1.0], [3.0, 1.0]]}).state
    plain = DriveState.from_dict(state.to_dict())
    copies = [pickle.loads(pickle.dumps(state)), copy.deepcopy(state), plain]
    ahead = {"tension": [[5.0, 2.0]]}
    tip = tactr.drive(robot, ahead, state=state).tips
    for other in copies:
        assert json.dumps(other.to_dict()) == json.dumps(state.to_dict())
        assert tactr.drive(robot, ahead, state=other).tips.tolist() == tip.tolist()


def test_a_state_goes_on_where_another_tendon_rubs():
    """What the state says of the tendons that rub now counts: here that friction saw no tension."""
    first, second = bending(both=True), bending(both=True)
    first = first.replace(tendons=(first.tendons[0], replace(first.tendons[1], friction=0.0)))
    second = second.replace(tendons=(replace(second.tendons[0], friction=0.0), second.tendons[1]))
    state = tactr.drive(first, {"tension": [[8.0, 1.0], [3.0, 1.0]]}).state
    assert state.profiles[0] is not None and state.profiles[1] is None
    plain = DriveState.from_dict(state.to_dict())
    tips = [tactr.drive(second, {"tension": [[5.0, 2.0]]}, state=s).tips.tolist() for s in (state, plain)]
    assert tips[0] == tips[1]
    alone = tactr.drive(second, {"tension": [[3.0, 0.0], [5.0, 2.0]]}).tips
    assert tips[0][0] == pytest.approx(alone[1], abs=1e-8)


def test_backlash_of_a_motor():
    """2 mm of play: what is passed on follows 1 mm behind, and rests over 2 mm at a reversal."""
    loose, tight = (bending(0.0, compliance=1e-4, play=play) for play in (2e-3, 0.0))
    path = {"displacement": np.array([[4e-3], [3e-3], [2e-3], [1e-3], [4e-3]])}
    driven = tactr.drive(loose, path)
    passed = [float(state.passed.displacement[0]) for state in driven.states]
    assert passed == pytest.approx([3e-3, 3e-3, 3e-3, 2e-3, 3e-3], abs=1e-12)
    exact = tactr.drive(tight, {"displacement": np.array([[3e-3], [2e-3]])}).tips
    assert driven.tips[[0, 3]] == pytest.approx(exact, abs=1e-8)


def test_backlash_of_a_tube():
    tube = Tube(
        "tube",
        length=0.1,
        section=Annulus(2e-3, 1.6e-3),
        material=SOFT,
        precurvature=(5.0, 0.0, 0.0),
        rotation_play=0.2,
        translation_play=2e-3,
    )
    rows = {
        "rotation": np.array([[1.0], [0.9], [0.7]]),
        "translation": np.array([[-0.02], [-0.019], [-0.015]]),
    }
    states = tactr.drive(Robot([tube]), rows).states
    assert [float(s.passed.rotation[0]) for s in states] == pytest.approx([0.9, 0.9, 0.8])
    assert [float(s.passed.translation[0]) for s in states] == pytest.approx([-0.019, -0.019, -0.016])


def pushed_rod(compliance, force):
    section = Annulus(2e-3, 1.6e-3)
    rod = Tube(
        "rod",
        length=0.15,
        section=section,
        material=SOFT,
        translation=-0.05,
        translation_compliance=compliance,
    )
    return Robot([rod], [], [PointLoad("rod", force=(0.0, 0.0, -force))])


def test_a_pushed_rod_gives_way_by_force_times_compliance():
    robot = pushed_rod(2e-4, 0.2)
    rigid = pushed_rod(0.0, 0.2)
    path = {"translation": np.array([[-0.05], [-0.04], [-0.05]])}
    driven, plain = tactr.drive(robot, path), tactr.drive(rigid, path)
    assert driven.converged
    assert driven.tips[:, 2] == pytest.approx(plain.tips[:, 2] - 2e-4 * 0.2, abs=1e-7)
    assert [s.robot.tubes[0].translation for s in driven] == pytest.approx(
        [-0.05004, -0.04004, -0.05004], abs=1e-7
    )
    assert "give of 'rod'" in tactr.solve(robot).message


def test_springs_of_bent_tubes_agree_with_the_forces_found():
    robot = rubbing_tubes(0.2, None)
    tubes = [replace(t, translation=-0.01, translation_compliance=1e-4, friction=0.1) for t in robot.tubes]
    robot = robot.replace(tubes=tuple(tubes))
    tension = np.array([[1.0, 2.0, 1.5], [2.0, 3.0, 2.0], [1.0, 1.5, 2.5]])
    driven = tactr.drive(robot, {"tension": tension})
    assert driven.converged
    for shape in driven:
        places = [tube.translation for tube in shape.robot.tubes]
        expected = -0.01 - 1e-4 * shape.actuator_forces.force
        assert np.abs(shape.actuator_forces.force).max() > 0.1
        assert places == pytest.approx(expected, abs=2e-7)
    again = tactr.drive(robot, {"tension": tension[2:]}, state=driven.states[1])
    assert again.tips[0] == pytest.approx(driven.tips[2], abs=1e-7)


def test_wrong_input_is_named():
    robot = bending()
    state = tactr.drive(robot, pulled([1.0])).state
    with pytest.raises(tactr.RobotError, match="tension"):
        tactr.drive(bending(tension=tactr.TensionProfile([0.0], [1.0])), [{}])
    with pytest.raises(tactr.RobotError, match="state"):
        tactr.drive(
            bending(both=True),
            pulled([1.0]) | {"tension": [[1, 1]]},
            state=tactr.drive(robot, pulled([1])).state,
        )
    with pytest.raises(tactr.RobotError, match="state"):
        tactr.drive(robot, {"displacement": [[1e-3]]}, state=state)
    with pytest.raises(tactr.RobotError, match="cannot be read"):
        DriveState.from_dict({})


def dragging(ups, down=1.0):
    """Of two opposite tendons, one held at a tension."""
    return {"tension": np.stack([ups, np.full_like(ups, down)], axis=1)}


@pytest.mark.parametrize("cuts", [1, 10, 100])
def test_a_tendon_dragged_by_another_is_told(cuts):
    """Held at a tension while the other bends the tube: its profile stays, and at the base it slips by what
    its path gets longer."""
    driven = tactr.drive(bending(both=True), dragging(legs([1.0, 4.0, 2.0], cuts)))
    longer = driven.lengths[:, 1] - driven.lengths[0, 1]
    assert longer[cuts] > 2e-4
    assert driven.creep[:, 1] == pytest.approx(longer, abs=1e-9)
    assert driven.creep[:, 0].max() < 1e-9


@pytest.mark.parametrize("cuts", [1, 10, 100])
def test_a_tendon_dragged_over_disks_is_told(cuts):
    """At the first disk, beyond which 0.16 m of the path get longer as the tube turns and shorter as it is
    compressed, both evenly where there is hardly any friction."""
    robot = bending(1e-3, both=True, contacts=np.linspace(0.0, 0.2, 11)[2:] * (1.0 - 1e-6))
    driven = tactr.drive(robot, dragging(legs([1.0, 4.0], cuts)))
    turned = turn(driven[-1]) - turn(driven[0])
    longer = 0.16 * (1.2e-3 * turned / 0.2 - 3.0 / robot.tubes[0].stiffness.EA)
    assert driven.creep[-1, 1] == pytest.approx(longer, rel=0.01)


def turn(shape):
    """Of the tip against the base, rad."""
    return math.acos(shape.tip_orientation[2, 2])


def test_what_dragged_a_tendon_is_told_where_steps_are_made_in_python():
    """Its antagonist pulled by a displacement, or the tube with backlash of its motor."""
    robot = bending(both=True, compliance=1e-4)
    path = [{"displacement": {"up": 1e-3 * up}, "tension": {"down": 1.0}} for up in (1.0, 1.2, 1.4, 1.1)]
    (tube,) = robot.tubes
    loose = robot.replace(tubes=(replace(tube, rotation_play=0.1),))
    for driven in (tactr.drive(robot, path), tactr.drive(loose, dragging(np.array([1.0, 2.0, 4.0, 3.0])))):
        longer = driven.lengths[:, 1] - driven.lengths[0, 1]
        assert longer[2] > 5e-5
        assert driven.creep[:, 1] == pytest.approx(longer, abs=1e-9)


def test_creep_begins_again_where_a_tendon_slides():
    """Places from the base on, as far as the front has come: what is left is what lies beyond; and where a
    drive goes on from a state."""
    robot, rows = bending(both=True), np.array([[1.0, 1.0], [4.0, 1.0], [4.0, 1.03], [4.0, 6.0], [3.0, 6.0]])
    driven = tactr.drive(robot, {"tension": rows})
    assert 0.0 < driven.creep[2, 1] < 0.9 * driven.creep[1, 1]
    assert driven.creep[3, 1] == 0.0
    assert driven.creep[4, 1] == pytest.approx(driven.lengths[3, 1] - driven.lengths[4, 1], rel=1e-6)
    state = tactr.drive(robot, {"tension": rows[:2]}).state
    again = tactr.drive(robot, {"tension": rows[2:3]}, state=state)
    assert 0.0 < again.creep[0, 1] < 0.1 * driven.creep[2, 1]


def test_a_driven_shape_has_no_plain_sensitivity():
    (shape,) = tactr.drive(bending(), pulled([3.0]))
    assert "without" not in shape.message
    with pytest.raises(tactr.RobotError, match="drive"):
        shape.sensitivity(["tendons.up.friction"])
