"""Every state gets its shape, or is said to have none; the newest wins."""

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Annulus, Robot, Tube, examples
from tactr.viewer.busy import LONG, Busy
from tactr.viewer.charts import QUANTITIES, curves
from tactr.viewer.latest import LatestWins
from tactr.viewer.session import Session
from tactr.viewer.state import State
from tactr.viewer.status_html import errors_html, legend_html, status_html

LENGTH, CURVATURE = 0.1, 20.0


def _opposed() -> Robot:
    """Two curved tubes that snap when the inner one is turned past 180 degrees: equal ones, whose product of
    length and curvature is above pi/2 (Dupont et al., IEEE Trans. Robot. 26, 2010)."""
    steel = tactr.Material(E=60e9, nu=0.3)
    return Robot(
        [
            Tube(name, length=LENGTH, section=section, material=steel, precurvature=(CURVATURE, 0, 0))
            for name, section in (("outer", Annulus(2e-3, 1.6e-3)), ("inner", Annulus(1.5e-3, 1.0e-3)))
        ]
    )


def test_states_are_solved_like_from_cold():
    robot = examples.load("three_tube_a")
    session, state = Session(), State(robot)
    for tension in np.linspace(3.0, 5.0, 9):
        state = state.with_value(("tension", "outer"), float(tension))
        outcome = session.solve(state)
    assert (outcome.level, outcome.headline, outcome.fresh) == ("good", "stable", True)
    assert outcome.shape is not None
    expected = tactr.solve(robot, tension={"outer": 5.0}).tip_position
    np.testing.assert_allclose(outcome.shape.tip_position, expected, atol=1e-6)
    state = replace(state, host="own (B)").with_value(("force", "x"), 0.01)
    outcome = session.solve(state)
    assert outcome.shape is not None
    np.testing.assert_allclose(
        outcome.shape.tip_position, tactr.solve(state.actuated).tip_position, atol=2e-6
    )


def test_no_equilibrium_keeps_the_last_good_shape():
    session, state = Session(), State(examples.load("two_tube_90"))
    good = session.solve(state)
    failed = session.solve(state.with_value(("force", "x"), 1e5))
    assert (failed.level, failed.headline, failed.fresh) == ("bad", "no equilibrium", False)
    assert failed.shape is good.shape
    assert "check its unit" in failed.reason
    impossible = session.solve(state.with_value(("tension", "outer"), -1.0))
    assert (impossible.headline, impossible.fresh) == ("not possible", False)
    assert "tendon cannot push" in impossible.reason
    assert session.solve(state).fresh


def test_no_shape_at_all():
    outcome = Session().solve(State(examples.load("two_tube_90")).with_value(("force", "x"), 1e5))
    assert outcome.shape is None
    assert "There is no shape yet" in status_html(outcome)


def test_a_snap_is_foretold_and_told():
    session, state = Session(), State(_opposed())
    seen, tips = [], []
    angles = np.append(np.arange(0.0, 180.0, 10.0), np.arange(180.0, 240.0, 0.5))
    for angle in np.radians(angles):
        outcome = session.solve(state.with_value(("rotation", "inner"), float(angle)))
        assert outcome.shape is not None and outcome.fresh and outcome.shape.stable
        seen.append(outcome.headline)
        tips.append(outcome.shape.tip_position)
    snap = seen.index("snapped")
    assert seen.count("snapped") == 1
    assert angles[snap] > 180.0
    assert seen[snap - 1] == "near a snap"
    steps = np.linalg.norm(np.diff(tips, axis=0), axis=1)
    assert steps[snap - 1] == steps.max() > 0.05  # m
    assert np.delete(steps, snap - 1).max() < 0.005


def test_a_snap_is_told_where_motors_hold_tendons():
    robot = _opposed()
    routing = tactr.Straight(5e-3, 0.0)
    robot = robot.replace(tendons=(tactr.Tendon("held", "outer", routing, displacement=0.0),))
    session, state = Session(), State(robot)
    seen = [
        session.solve(state.with_value(("rotation", "inner"), float(angle))).headline
        for angle in np.radians(np.append(np.arange(0.0, 180.0, 10.0), np.arange(180.0, 300.0, 4.0)))
    ]
    assert seen.count("snapped") == 1


def test_a_snap_by_the_tip_force_is_told():
    """A rod pressed down by twice its buckling force hangs over to the side of the force across, and flips
    to the mirrored shape once that force points the other way."""
    rod = tactr.Tube(
        "rod", length=LENGTH, section=Annulus(1e-3, 0.0), material=tactr.Material(E=60e9, nu=0.3)
    )
    bending = 60e9 * np.pi * 0.5e-3**4 / 4.0
    most = 2.0 * np.pi**2 * bending / (4.0 * LENGTH**2)
    session, state = Session(), State(Robot([rod]))
    session.solve(state.with_value(("force", "x"), most))
    down = state.with_value(("force", "z"), -most)
    outcomes = {
        share: session.solve(down.with_value(("force", "x"), share * most))
        for share in (0.7, 0.4, 0.1, 0.02, -0.1, -0.4, -0.7)
    }
    assert [outcome.headline for outcome in outcomes.values()].count("snapped") == 1
    assert outcomes[0.02].headline == "near a snap"
    assert outcomes[-0.1].headline == "snapped"
    for share in (0.1, 0.4, 0.7):
        before, after = outcomes[share].shape, outcomes[-share].shape
        assert before is not None and after is not None
        np.testing.assert_allclose(after.tip_position, before.tip_position * [-1, 1, 1], atol=1e-5)


def test_rest_has_neither_tendons_nor_loads():
    session = Session()
    state = State(examples.load("two_tube_90")).with_value(("insertion", "inner"), 0.16)
    rest = session.rest(state.with_value(("force", "x"), 0.1))
    assert rest is not None
    np.testing.assert_allclose(rest.tip_position, [0.0, 0.0, 0.16], atol=1e-9)
    assert session.rest(state) is rest


def test_curves_hold_what_the_shape_says():
    shape = tactr.solve(examples.load("three_tube_a"))
    s, outer, _, inner = curves(shape, "torque (N mm)")
    np.testing.assert_allclose(s, 1e3 * shape.s)
    here = s <= 140.0
    np.testing.assert_allclose(outer[here], 1e3 * shape.tubes[0].m[:, 2])
    assert np.isnan(outer[~here]).all()
    np.testing.assert_allclose(inner, 1e3 * shape.tubes[2].m[:, 2])
    assert all(len(curves(shape, quantity)) == 4 for quantity in QUANTITIES)


def test_words_of_files_are_not_taken_for_html():
    robot = replace(_opposed(), name="x", description="<script>alert(1)</script>")
    tube = replace(robot.tubes[0], name="<img src=x onerror=alert(1)>")
    html = legend_html(robot.replace(tubes=(tube, robot.tubes[1])), 1.0)
    assert "<script" not in html and "<img" not in html
    assert "<b>" not in errors_html(["a <b> is wrong"])


def test_the_newest_wins():
    done: list[int] = []
    begun, go = threading.Event(), threading.Event()

    def work(item: int) -> None:
        begun.set()
        go.wait(5.0)
        done.append(item)

    worker: LatestWins[int] = LatestWins(work, lambda error: None)
    worker.submit(0)
    assert begun.wait(5.0)
    for item in range(1, 50):
        worker.submit(item)
    go.set()
    assert worker.wait(5.0)
    assert done == [0, 49]
    worker.close()


def test_what_takes_long_is_said_and_nothing_afterwards():
    said: list[float] = []
    busy = Busy(lambda: said.append(time.perf_counter()))
    with busy:
        pass
    with busy:
        time.sleep(1.5 * LONG)
        assert len(said) == 1
    time.sleep(1.2 * LONG)
    assert len(said) == 1


def test_a_worker_outlives_what_goes_wrong():
    failures: list[Exception] = []
    done: list[int] = []

    def work(item: int) -> None:
        if item == 0:
            raise ValueError("nought")
        done.append(item)

    worker: LatestWins[int] = LatestWins(work, failures.append)
    worker.submit(0)
    assert worker.wait(5.0)
    worker.submit(1)
    assert worker.wait(5.0)
    assert ([str(error) for error in failures], done) == (["nought"], [1])
    begin = time.perf_counter()
    worker.close()
    assert time.perf_counter() - begin < 1.0


@pytest.mark.parametrize("shown", [3, "two_tube_90"])
def test_only_robots_and_shapes_are_shown(shown):
    from tactr.viewer import View

    with pytest.raises(tactr.RobotError, match="neither"):
        View(shown)
