"""What friction between tubes does along a path: energy, memory, step size, no friction, the guide."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tactr
from tactr import (
    Annulus,
    Driven,
    DriveState,
    PointLoad,
    Robot,
    RobotError,
    Tube,
    TubeContact,
    TubeFriction,
    materials,
)

from .rods import COEFFICIENT, FULL, GJ, LENGTH, RADIUS, TORQUE, pressed_rod, soft
from .rods import Driven as Led


def curved(friction: float = 0.15) -> Robot:
    """Two precurved tubes, both held behind the guide's exit."""
    return Robot(
        tubes=(
            Tube(
                "outer",
                length=0.19,
                section=Annulus(2.0e-3, 1.6e-3),
                precurvature=[(0.0, (0, 0, 0)), (0.09, (7.0, 0, 0))],
                translation=-0.07,
                friction=friction,
                material=materials.nitinol,
            ),
            Tube(
                "inner",
                length=0.26,
                section=Annulus(1.5e-3, 1.1e-3),
                precurvature=[(0.0, (0, 0, 0)), (0.12, (10.0, 0, 0))],
                translation=-0.1,
                friction=friction,
                material=materials.nitinol,
            ),
        )
    )


def inner(state: DriveState) -> TubeContact:
    assert state.rubbing is not None
    return state.rubbing.contact("inner")


def turned(
    robot: Robot, angles: np.ndarray, state: DriveState | None = None, tolerance: float = 1e-6
) -> Driven:
    """The inner tube turned by angles."""
    path = [{"rotation": {robot.tubes[-1].name: float(a)}} for a in angles]
    driven = tactr.drive(robot, path, state=state, stations=2, tolerance=tolerance)
    assert driven.converged, driven.message
    return driven


def test_a_cycle_takes_what_its_loop_encloses() -> None:
    """Heat of the second cycle against the area of torque over base angle and the closed form
    4 mu f r (A L - mu f r L^3 / (3 GJ)) of amplitude A."""
    amplitude, steps = 2.0 * FULL, 200
    up = np.linspace(-amplitude, amplitude, steps + 1)
    angles = np.concatenate([[0.0, amplitude], up[::-1], up[1:], up[::-1][1:], up[1:]])
    driven = turned(pressed_rod(), angles, tolerance=1e-8)
    cycle = slice(2 + 2 * steps, None)
    torque = np.array([shape.actuator_forces.torque[1] for shape in driven])[cycle]
    area = float((0.5 * (torque[1:] + torque[:-1]) * np.diff(angles[cycle])).sum())
    heat = float(driven.tube_heat[cycle][1:, 1].sum())
    assert heat == pytest.approx(area, rel=1e-3)
    expected = 4.0 * TORQUE * (amplitude * LENGTH - TORQUE * LENGTH**3 / (3.0 * GJ))
    assert heat == pytest.approx(expected, rel=1.0 / (4 * 8**2) * 1.05)  # the error of eight cells
    stored = [driven[k].energy for k in (2 + 2 * steps, -1)]
    assert stored[0] == pytest.approx(stored[1], abs=1e-4 * area)


def test_every_step_takes_energy() -> None:
    driven = turned(curved(), np.array([0.0, 0.4, 0.1, 0.5, -0.3]))
    assert (driven.tube_heat >= -1e-12).all() and driven.tube_heat[1:].sum() > 0.0


@pytest.mark.parametrize("friction", [0.0, 1e-9])
def test_without_friction_it_is_plain_statics(friction: float) -> None:
    robot, angles = curved(friction), np.array([0.0, 0.7, -0.2])
    driven = turned(robot, angles, tolerance=1e-11)
    for angle, shape in zip(angles, driven, strict=True):
        plain = tactr.solve(curved(0.0), rotation={"inner": angle}, tolerance=1e-11)
        assert shape.tip_position == pytest.approx(plain.tip_position, abs=1e-9)


def test_friction_holds_the_tip_back() -> None:
    """Turned to and fro the tip lags on both sides of the frictionless one, and a flipped sign would lead."""
    angles = np.array([0.0, 0.6, 0.3, -0.3, 0.0, 0.3])
    driven = turned(curved(), angles)
    psi = np.array([shape.tubes[1].psi[-1] for shape in driven])
    free = tactr.solve(curved(), rotation={"inner": 0.3}).tubes[1].psi[-1]
    assert psi[5] < free - 1e-3 and psi[2] > free + 1e-3


@pytest.mark.parametrize("robot", [curved(0.3), pressed_rod()], ids=["curved", "rod"])
def test_a_model_changes_nothing_but_the_time(robot: Robot) -> None:
    """Steps that follow the model of the step before, or one that is far too old, find what steps find that
    look for an equilibrium for every estimate of the torques."""
    searching, following = Led(robot, with_models=False), Led(robot)
    first = following.to([0.0, 0.0])
    searching.to([0.0, 0.0])
    translation = np.array([tube.translation for tube in robot.tubes])
    marches = 0
    for angle in (0.1, 0.25, 0.3, 0.28, 0.1, -0.1, 0.2):
        before, last = searching.state, searching.last
        assert last is not None
        arrays = np.zeros(0), np.array([0.0, angle]), translation
        aged = searching.step(
            searching.prepared._core, arrays, before, guess=last.solution, model=first.model
        )
        found = [led.to([0.0, angle]) for led in (searching, following)] + [aged]
        marches += found[1].iterations
        for other in found[1:]:
            assert other.settled
            for a, b in zip(found[0].state.contacts, other.state.contacts, strict=True):
                assert b.torque == pytest.approx(a.torque, abs=1e-6 * max(a.limit.max(), 1e-12))
                assert b.twist == pytest.approx(a.twist, abs=1e-7)
    assert marches <= 7 * 6


def test_the_result_does_not_depend_on_the_steps() -> None:
    robot = curved()
    for angles, most in (([0.0, 0.8], 1e-6), ([0.0, 0.8, -0.4, 0.5], 1e-5)):
        tips = []
        for pieces in (1, 2, 4, 8):
            path = [np.linspace(a, b, pieces + 1)[1:] for a, b in itertools.pairwise(angles)]
            tips.append(turned(robot, np.concatenate([[0.0], *path])).tips[-1])
        assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() < most


def test_loops_close_after_the_first_cycle() -> None:
    angles = np.array([0.0, *np.tile([0.7, -0.7], 3)])
    tips = turned(curved(), angles).tips
    assert np.linalg.norm(tips[3] - tips[5]) < 1e-6 and np.linalg.norm(tips[4] - tips[6]) < 1e-6


shares = st.floats(0.05, 0.95)


@settings(max_examples=15, deadline=None)
@given(st.floats(0.3, 3.0), shares, shares, shares)
def test_return_point_memory(top: float, down: float, up: float, on: float) -> None:
    """A loop inside another is forgotten when its turning point is passed again."""
    first, second = top * FULL, (1.0 - 2.0 * down) * top * FULL
    inside = second + up * (first - second)
    last = second - on * FULL
    plain = turned(pressed_rod(), np.array([0.0, first, second, last]), tolerance=1e-8)
    looped = turned(pressed_rod(), np.array([0.0, first, second, inside, second, last]), tolerance=1e-8)
    for one, other in ((plain.states[2], looped.states[4]), (plain.state, looped.state)):
        a, b = inner(one), inner(other)
        assert a.twist == pytest.approx(b.twist, abs=1e-6 * FULL + 1e-9)
        assert a.torque == pytest.approx(b.torque, abs=1e-5 * TORQUE * LENGTH)


def test_a_state_goes_through_json() -> None:
    robot = curved()
    whole = turned(robot, np.array([0.0, 0.5, 0.2]))
    half = turned(robot, np.array([0.0, 0.5]))
    again = DriveState.from_dict(json.loads(json.dumps(half.state.to_dict())))
    rest = turned(robot, np.array([0.2]), state=again)
    assert rest.tips[-1] == pytest.approx(whole.tips[-1], abs=1e-7)


def test_a_state_of_another_cut_is_refused() -> None:
    state = turned(pressed_rod(), np.array([0.0, FULL])).state
    data = state.to_dict()
    for key in ("s", "torque", "twist", "limit", "slides"):
        data["rubbing"]["contacts"][0][key] = data["rubbing"]["contacts"][0][key][:3]
    other = DriveState.from_dict(data)
    with pytest.raises(RobotError, match="rubs at 3 places"):
        turned(pressed_rod(), np.array([0.0]), state=other)


def test_the_guide() -> None:
    """A straight tube under a force F across its tip is held at the exit by F and the moment F L, that is by
    forces F L / lever -+ F / 2; it lags by mu r times both, times the length behind the exit over GJ."""
    behind, force, lever = 0.05, 1e-3, 5e-3
    tube = Tube(
        "rod",
        length=LENGTH + behind,
        section=soft(),
        translation=-behind,
        friction=TubeFriction(COEFFICIENT, RADIUS, lever),
    )
    robot = Robot([tube], loads=[PointLoad("rod", force=(force, 0.0, 0.0))])
    bound = COEFFICIENT * RADIUS * 2.0 * force * LENGTH / lever
    lag = bound * behind / GJ
    angles = np.array([0.0, 0.5, 3.0, 1.5, 0.5]) * lag
    driven = turned(robot, angles, tolerance=1e-9)
    x = np.array([shape.tip_orientation[:, 0] for shape in driven])
    psi = np.arctan2(x[:, 1], x[:, 0])
    assert psi == pytest.approx(np.array([0.0, 0.0, 2.0, 2.0, 1.5]) * lag, abs=1e-3 * lag)


def test_sliding_along_wipes_the_torque_away() -> None:
    """Friction points against the whole slip: a tube pushed on does not resist its turning any more."""
    robot = pressed_rod()
    path = [
        {"rotation": {"inner": 0.0}},
        {"rotation": {"inner": 2.0 * FULL}},
        {"rotation": {"inner": 2.0 * FULL}, "translation": {"inner": -1e-3}},
    ]
    driven = tactr.drive(robot, path, stations=2)
    held, wiped = (abs(inner(driven.states[k]).torque).sum() for k in (1, 2))
    assert held > 0.9 * TORQUE * LENGTH and wiped < 0.02 * held


def test_a_plain_solve_says_what_it_leaves_out() -> None:
    assert "friction of 'outer', 'inner'" in tactr.solve(curved()).message
    assert "friction" not in turned(curved(), np.array([0.0]))[0].message


def test_a_tube_clamped_at_the_exit_is_withdrawn_as_it_was_turned():
    bent = Tube(
        "bent",
        length=0.1,
        section=Annulus(2e-3, 1.5e-3),
        material=materials.nitinol,
        precurvature=(5.0, 0.0, 0.0),
        friction=0.2,
    )
    robot = Robot([bent], [], [PointLoad("bent", force=(0.3, 0.0, 0.0))])
    driven = tactr.drive(robot, {"rotation": [[0.0], [1.0], [1.0]], "translation": [[0.0], [0.0], [-1e-7]]})
    contacts = [state.rubbing.contact("bent") for state in driven.states if state.rubbing]
    assert [contact.twist[0] for contact in contacts] == pytest.approx([0.0, 1.0, 1.0], abs=1e-6)
    after = contacts[-1]
    assert abs(after.torque[0]) < 1e-2 * after.limit[0]  # it slid along only
