"""Solves under displacements: round trips, slack, control, derivatives, failures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import PointLoad, RobotError, Status, Straight, Tendon, examples
from tactr.statics import Prepared
from tactr.statics.parameters import value_of, with_value


def sprung(robot, compliance=1e-4):
    return robot.replace(tendons=[replace(tendon, compliance=compliance) for tendon in robot.tendons])


@pytest.mark.parametrize("seed", [1, 2, 5, 8, 12, 14, 17, 23, 29, 31, 37, 41])
def test_round_trip(random_robot, seed):
    """Tensions to lengths to displacements to the same tensions; from cold, so perhaps on another branch."""
    robot = sprung(random_robot(seed))
    if not robot.tendons:
        pytest.skip("no tendons")
    prepared = Prepared(robot, tolerance=1e-8, stations=2)
    given = prepared.solve()
    assert given.status is Status.CONVERGED
    shape = prepared.solve(displacement=given.displacement)
    assert shape.status is Status.CONVERGED, shape.message
    assert shape.displacement_error <= 1e-9
    near = prepared.solve(displacement=given.displacement, guess=given)
    assert near.converged
    assert near.tension == pytest.approx(given.tension, abs=2e-5)
    assert near.tip_position == pytest.approx(given.tip_position, abs=1e-7)
    assert near.slack == tuple(t.name for t, T in zip(robot.tendons, near.tension, strict=True) if T == 0.0)
    if len(robot.tubes) == 1 and not robot.loads:  # one equilibrium
        assert shape.tension == pytest.approx(given.tension, abs=2e-5)


def test_round_trip_of_the_robot_with_a_little_of_everything(robot):
    given = tactr.solve(sprung(robot))
    for chosen in (["a"], ["b", "c"], ["a", "b", "c"]):
        pull = {t.name: d for t, d in zip(robot.tendons, given.displacement, strict=True) if t.name in chosen}
        shape = tactr.solve(sprung(robot), displacement=pull)
        assert shape.converged
        assert shape.tension == pytest.approx(given.tension, abs=1e-3)
        assert shape.robot.tendon("a").displacement == pull.get("a")


def test_no_displacement_is_the_rest_shape(robot):
    rest = tactr.solve(robot, tension=[0.0] * 3, loads=[])
    shape = tactr.solve(robot, displacement=[0.0] * 3, loads=[])
    assert shape.tension == pytest.approx([0.0] * 3, abs=1e-9)
    assert shape.tip_position == pytest.approx(rest.tip_position, abs=1e-12)


def test_paid_out_tendons_are_slack(robot):
    shape = tactr.solve(robot, displacement=[-0.02] * 3)
    assert shape.slack == ("a", "b", "c")
    assert (shape.tension == 0.0).all()
    assert "slack: 'a', 'b', 'c'" in shape.message
    assert shape.tip_position == pytest.approx(tactr.solve(robot, tension=[0.0] * 3).tip_position, abs=1e-9)


def antagonists():
    robot = examples.load("two_tube_90")
    inner = robot.tendon("inner")
    assert isinstance(inner.routing, Straight)
    back = Straight(-inner.routing.x, -inner.routing.y)
    return robot.replace(tendons=[*robot.tendons, Tendon("back", "inner", back)])


def test_a_path_through_slack_is_continuous():
    prepared = Prepared(antagonists(), stations=2)
    shape, before = None, None
    states = set()
    for pull in np.linspace(-4e-3, 4e-3, 81):
        shape = prepared.solve(displacement=np.array([np.nan, pull, -pull - 2e-5]), guess=shape)
        assert shape.converged, shape.message
        cold = prepared.solve(displacement=np.array([np.nan, pull, -pull - 2e-5]))
        assert cold.tension == pytest.approx(shape.tension, abs=0.05)
        states.add(shape.slack)
        if before is not None:
            assert np.linalg.norm(shape.tip_position - before) < 3e-3
        before = shape.tip_position
    assert {("inner",), ("back",)} <= states


HELD = [  # displacements, m; NaN: a tension instead
    np.array([1.5e-3, 3e-3, -2.9e-3]),
    np.array([1.5e-3, 3e-3, -9e-3]),
    np.array([np.nan, 3e-3, -2.9e-3]),
]


def motion(after, before):
    """Shift and turn of the tip, (6,)."""
    turn = after.tip_orientation @ before.tip_orientation.T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return np.concatenate([after.tip_position - before.tip_position, 0.5 * axis])


@pytest.mark.parametrize("tied", [False, True])
@pytest.mark.parametrize("given", HELD, ids=["taut", "one slack", "one by tension"])
def test_derivatives_with_the_motors_held(given, tied):
    """Of every actuator, the others held; of lengths, moduli and motors; and the compliance of the tip."""
    robot = antagonists().replace(tendons=[replace(t, compliance=1e-4) for t in antagonists().tendons])
    robot = robot.with_actuation(translation={"inner": -0.02, "outer": -0.03})
    if tied:
        lengths = tactr.rest_lengths(robot)
        robot = robot.replace(tendons=[replace(t, rest_length=lengths[t.name]) for t in robot.tendons])
    asked = {t.name: d for t, d in zip(robot.tendons, given, strict=True) if not np.isnan(d)}
    robot = robot.with_actuation(displacement=asked)
    shape = tactr.solve(robot, tolerance=1e-10)

    def check(column, path, step):
        value = value_of(robot, path)
        ends = [
            tactr.solve(with_value(robot, path, value + k * step), guess=shape, tolerance=1e-10)
            for k in (1, -1, 2, -2)
        ]
        expected = (8 * motion(ends[0], ends[1]) - motion(ends[2], ends[3])) / (12 * step)
        scale = max(abs(value), 100 * step)
        for rows in (slice(0, 3), slice(3, 6)):
            size = max(scale * np.abs(expected[rows]).max(), 1e-6)
            assert scale * column[rows] == pytest.approx(scale * expected[rows], abs=1e-5 * size), path

    jacobian = shape.tip_jacobian()
    for j, tendon in enumerate(robot.tendons):
        if tendon.displacement is None:
            check(jacobian.tension[:, j], f"tendons.{tendon.name}.tension", 1e-3)
            assert not jacobian.displacement[:, j].any()
        else:
            check(jacobian.displacement[:, j], f"tendons.{tendon.name}.displacement", 1e-5)
            assert not jacobian.tension[:, j].any()
    for i, tube in enumerate(robot.tubes):
        check(jacobian.rotation[:, i], f"tubes.{tube.name}.rotation", 1e-3)
        check(jacobian.translation[:, i], f"tubes.{tube.name}.translation", 2e-5)
    paths = [
        "tubes.inner.length",
        "tubes.outer.material.E",
        "tendons.inner.compliance",
        "tendons.inner.routing.x",
    ]
    for path, column in zip(paths, shape.sensitivity(paths).T, strict=True):
        check(column, path, 1e-4 * abs(value_of(robot, path)))

    def pushed(row, h):
        force, moment = np.split(h * np.eye(6)[row], 2)
        load = PointLoad("inner", force=tuple(force), moment=tuple(moment))
        return tactr.solve(robot.replace(loads=[load]), guess=shape, tolerance=1e-10)

    for row, h in enumerate([1e-3] * 3 + [1e-4] * 3):
        near, far = (motion(pushed(row, k * h), pushed(row, -k * h)) / (2 * k * h) for k in (1, 2))
        expected = (4 * near - far) / 3
        assert shape.compliance()[:, row] == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_tied_tendons_keep_their_length_where_the_tubes_turn(robot):
    lengths = tactr.rest_lengths(robot)
    tied = robot.replace(
        tendons=[replace(t, rest_length=lengths[t.name], compliance=1e-4) for t in robot.tendons]
    )
    for angle in (0.8, 2.0):
        shape = tactr.solve(tied, displacement=[1e-3] * 3, rotation={"inner": angle}, loads=[])
        taut = shape.tension > 0.0
        stretched = np.array([lengths[t.name] for t in robot.tendons]) - 1e-3 + 1e-4 * shape.tension
        found = np.array([t.length for t in shape.tendons])
        assert taut.any()
        assert found[taut] == pytest.approx(stretched[taut], abs=1e-7)
    free = tactr.solve(sprung(robot), displacement=[0.0] * 3, rotation={"inner": 2.0}, loads=[])
    assert free.tension == pytest.approx([0.0] * 3, abs=1e-9)


def test_a_displacement_beyond_reach_is_not_met():
    shape = tactr.solve(examples.load("two_tube_90"), displacement={"outer": 0.2})
    assert not shape.converged
    assert shape.status in (Status.NOT_MET, Status.COLLAPSED, Status.KINKED)
    assert "displacement" in shape.message
    assert "'outer'" in shape.message
    assert math.isfinite(shape.displacement_error)
    with pytest.raises(tactr.NotConverged):
        _ = shape.tip_position


def test_a_guess_is_worth_its_while():
    prepared = Prepared(antagonists(), stations=2)
    first = prepared.solve(displacement=np.array([1e-3, 2e-3, -1.9e-3]))
    near = prepared.solve(displacement=np.array([1.01e-3, 2.01e-3, -1.91e-3]), guess=first)
    assert near.converged
    assert near.iterations < first.iterations


def test_control_changes_hands():
    robot = antagonists()
    prepared = Prepared(robot, stations=2)
    pulled = tactr.solve(robot, displacement={"inner": 2e-3})
    assert pulled.robot.tendon("inner").displacement == 2e-3
    assert pulled.robot.tendon("inner").tension == 0.0
    again = tactr.solve(pulled.robot, tension={"inner": float(pulled.tension[1])})
    assert again.robot.tendon("inner").displacement is None
    assert again.tip_position == pytest.approx(pulled.tip_position, abs=1e-6)
    assert tactr.solve(pulled.robot).tension == pytest.approx(pulled.tension)
    by_array = Prepared(pulled.robot, stations=2).solve(tension=pulled.tension)
    assert by_array.tip_position == pytest.approx(pulled.tip_position, abs=1e-6)
    assert by_array.robot.tendon("inner").displacement is None
    mapped = prepared.solve(displacement={"inner": 2e-3})
    assert mapped.robot == pulled.robot
    assert tactr.solve(pulled.robot, displacement={"inner": None}).tension[1] == 0.0


@pytest.mark.parametrize(
    ("actuation", "field"),
    [
        ({"displacement": {"inner": math.inf}}, "tendons[1].displacement"),
        ({"displacement": {"inner": "2 mm"}}, "tendons[1].displacement"),
        ({"displacement": {"innr": 1e-3}}, "displacement"),
        ({"displacement": [1e-3]}, "displacement"),
        ({"displacement": {"inner": 1e-3}, "tension": {"inner": 1.0}}, "tendons[1].displacement"),
    ],
)
def test_wrong_displacements(actuation, field):
    robot = examples.load("two_tube_90")
    for solve in (lambda: tactr.solve(robot, **actuation), lambda: Prepared(robot).solve(**actuation)):
        with pytest.raises(RobotError) as caught:
            solve()
        assert caught.value.field == field


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"displacement": 1e-3, "tension": 1.0}, "displacement"),
        ({"displacement": math.inf}, "displacement"),
        ({"compliance": -1e-3}, "compliance"),
        ({"pretension": -1.0}, "pretension"),
        ({"rest_length": 0.0}, "rest_length"),
    ],
)
def test_wrong_tendons(fields, field):
    with pytest.raises(RobotError) as caught:
        Tendon("t", "tube", Straight(1e-3, 0.0), **fields)
    assert caught.value.field == field


def test_a_search_in_vain_is_given_up():
    """Seed 621 of benchmarks/displacements.py in short: pulls that fight each other."""
    robot = antagonists()
    shape = tactr.solve(robot, displacement=[0.0, 0.14, 0.14])
    assert not shape.converged
    assert "given up after" in shape.message
