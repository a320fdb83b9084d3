"""Known numbers come back from noisy measurements, as often within their stated intervals as these say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Frame, Measurements, Parameter

from . import simulated

TRIALS = 200
FRAME = Frame(marker=(0.0, 0.0, 8e-3), position=(0.01, -0.02, 0.05), rotation=(0.05, 0.1, -0.2))
TENSION = {"tubes.rod.material.E": 55e9, "sensor.x": 0.01, "sensor.y": -0.02, "sensor.rz": -0.2}
DISPLACEMENT = {
    "tendons.t0.zero": 3e-4,
    "tendons.t1.zero": -2e-4,
    "tendons.*.compliance": 4e-4,
    "sensor.x": 0.01,
}


def coverage(robot, data, parameters, truth, frame, capsys, trials=TRIALS) -> None:
    """Of the 95 % intervals of every number over the trials, and of the standard errors themselves."""
    rng, names = np.random.default_rng(7), list(truth)
    inside = np.zeros((trials, len(names)), dtype=bool)
    scores = np.zeros((trials, len(names)))
    for trial in range(trials):
        fit = tactr.calibrate(robot, simulated.noisy(data, rng), parameters=parameters, frame=frame)
        for k, name in enumerate(names):
            estimate = fit[name]
            assert estimate.interval is not None and estimate.error is not None and estimate.value is not None
            inside[trial, k] = estimate.interval[0] <= truth[name] <= estimate.interval[1]
            scores[trial, k] = (estimate.value - truth[name]) / estimate.error
    with capsys.disabled():
        shares = ", ".join(
            f"{name} {share:.1%}" for name, share in zip(names, inside.mean(axis=0), strict=True)
        )
        print(f"\n{trials} trials, within the 95 % interval: {inside.mean():.1%} ({shares})")
    slack = 3.5 * np.sqrt(0.95 * 0.05 / trials)  # of a share of 95 %, in binomial standard deviations
    np.testing.assert_allclose(inside.mean(axis=0), 0.95, atol=slack)
    np.testing.assert_allclose(scores.std(axis=0), 1.0, atol=3.5 / np.sqrt(2 * trials) + 0.05)
    assert (np.abs(scores.mean(axis=0)) < 4 / np.sqrt(trials)).all()


@pytest.mark.parametrize("trials", [30, pytest.param(TRIALS, marks=pytest.mark.slow)])
def test_coverage_with_tensions(trials: int, capsys: pytest.CaptureFixture[str]) -> None:
    data = simulated.measured(simulated.tension_robot(), "tension", 8, frame=FRAME)
    start = Frame(marker=FRAME.marker, position=(0.0, 0.0, 0.05), rotation=(0.05, 0.1, 0.0))
    coverage(simulated.tension_robot(65e9), data, list(TENSION), TENSION, start, capsys, trials)


@pytest.mark.slow
def test_coverage_with_displacements_slack_and_pretension(capsys: pytest.CaptureFixture[str]) -> None:
    zeros = {"t0": 3e-4, "t1": -2e-4}
    data = simulated.measured(simulated.displacement_robot(), "displacement", 10, frame=FRAME, zeros=zeros)
    parameters = [*list(DISPLACEMENT)[:2], Parameter("tendons.*.compliance", common=True), "sensor.x"]
    start = Frame(marker=FRAME.marker, position=(0.0, -0.02, 0.05), rotation=FRAME.rotation)
    coverage(simulated.displacement_robot(5e-4), data, parameters, DISPLACEMENT, start, capsys)


def test_without_noise_everything_comes_back() -> None:
    """Displacements only, no tension measured; some tendons are slack."""
    zeros = {"t0": 3e-4, "t1": -2e-4}
    truth = simulated.displacement_robot()
    data = simulated.measured(truth, "displacement", 15, frame=FRAME, zeros=zeros)
    parameters = [
        *list(DISPLACEMENT)[:2],
        Parameter("tendons.*.compliance", common=True),
        "sensor.x",
        "marker.z",
    ]
    start = simulated.displacement_robot(6e-4)
    fit = tactr.calibrate(
        start, data, parameters=parameters, frame=Frame(FRAME.marker, (0, -0.02, 0.05), FRAME.rotation)
    )
    assert (fit.tension == 0.0).any() and (fit.tension > 0.0).any()
    for name, value in {**DISPLACEMENT, "marker.z": 8e-3}.items():
        assert fit[name].value == pytest.approx(value, rel=1e-3, abs=1e-8)
    assert fit.error.max() < 1e-6


def test_the_calibrated_robot_pulls_like_the_true_one(tmp_path) -> None:
    """Zeros of motors become rest lengths, which a file keeps."""
    truth, zeros = simulated.displacement_robot(), {"t0": 3e-4, "t1": -2e-4}
    data = simulated.measured(truth, "displacement", 15, zeros=zeros)
    fit = tactr.calibrate(truth, data, parameters=["tendons.t0.zero", "tendons.t1.zero"])
    tactr.save(fit.robot, tmp_path / "calibrated.yaml")
    again = tactr.load(tmp_path / "calibrated.yaml")
    tip = simulated.solved(again, t0=1e-3, t1=0.0, t2=-1e-3)
    assert tip == pytest.approx(simulated.solved(truth, t0=1.3e-3, t1=-2e-4, t2=-1e-3), abs=2e-6)
    assert fit.errors(data).max() < 2e-6


def test_shapes_are_calibrated_too() -> None:
    places = (0.05, 0.1, 0.15, None)
    data = simulated.measured(simulated.tension_robot(), "tension", 4, places=places, frame=FRAME)
    frame = Frame(marker=FRAME.marker)
    parameters = ["tubes.rod.E", "sensor.*", "marker.z"]
    fit = tactr.calibrate(simulated.tension_robot(70e9), data, parameters=parameters, frame=frame)
    assert fit["tubes.rod.material.E"].value == pytest.approx(55e9, rel=1e-4)
    assert fit.frame.position == pytest.approx(FRAME.position, abs=1e-5)
    assert fit.frame.rotation == pytest.approx(FRAME.rotation, abs=1e-4)


def test_priors_weigh_as_measurements_do() -> None:
    """A number measured beforehand with deviation a and by the data with b: the weighted mean of both."""
    data = simulated.measured(simulated.tension_robot(), "tension", 8)
    alone = tactr.calibrate(simulated.tension_robot(), data, parameters=["tubes.rod.E"], noise=1e-3)
    b = alone["tubes.rod.material.E"].error
    assert b is not None
    prior = Parameter("tubes.rod.E", prior=(55e9 + 0.5 * b, 0.5 * b))
    fit = tactr.calibrate(simulated.tension_robot(), data, parameters=[prior], noise=1e-3)
    estimate = fit["tubes.rod.material.E"]
    assert estimate.value == pytest.approx(55e9 + 0.5 * b * 0.8, rel=2e-4)
    assert estimate.error == pytest.approx(b / np.sqrt(5.0), rel=2e-2)


def test_starts_find_the_far_minimum() -> None:
    """A rod turned by half a turn: from the wrong side the search ends in a local minimum."""
    frame = Frame(rotation=(0.0, 0.0, 2.8))
    data = simulated.measured(simulated.tension_robot(), "tension", 8, frame=frame)
    turn = Parameter("sensor.rz", lower=-2.9, upper=2.9, start=-2.5)
    free = ["tubes.rod.E", turn]
    several = tactr.calibrate(simulated.tension_robot(), data, parameters=free, starts=5)
    assert several["sensor.rz"].value == pytest.approx(2.8, abs=1e-4)
    assert len(several.left) == 5 and several.left[0] < 1e-6


@pytest.mark.parametrize("loss", ["huber", "soft_l1", "cauchy"])
def test_a_robust_loss_leaves_priors_as_they_are(loss) -> None:
    """A prior 5 deviations off pulls as hard as it says, while exact data weigh as under least squares."""
    data = simulated.measured(simulated.tension_robot(), "tension", 8)
    alone = tactr.calibrate(simulated.tension_robot(), data, parameters=["tubes.rod.E"], noise=1e-3)
    error = alone["tubes.rod.material.E"].error
    assert error is not None
    prior = Parameter("tubes.rod.E", prior=(61e9, 1e9))
    noise = 1e-3 * 0.15e9 / error
    fit = tactr.calibrate(simulated.tension_robot(), data, parameters=[prior], noise=noise, loss=loss)
    pulled = 55e9 + 6e9 * 0.15**2 / (1 + 0.15**2)  # the mean of both by their variances
    assert fit["tubes.rod.material.E"].value == pytest.approx(pulled, rel=5e-4)


def test_a_search_that_starts_at_a_bound_leaves_it() -> None:
    """Tendons that the robot file takes for stiff, and zeros of their motors, which pull alike at first."""
    start = tactr.examples.load("two_tube_90")
    truth = start.replace(tendons=tuple(replace(tendon, compliance=2e-4) for tendon in start.tendons))
    pulled = np.random.default_rng(1).uniform(0.0, 4e-3, (8, 2))
    tips = [tactr.solve(truth, displacement={"outer": a, "inner": b}).tip_position for a, b in pulled]
    data = Measurements(np.array(tips), displacement={"outer": pulled[:, 0], "inner": pulled[:, 1]})
    fit = tactr.calibrate(start, data, parameters=["tendons.*.compliance", "tendons.*.zero"])
    for estimate in fit.estimates:
        true = 2e-4 if estimate.name.endswith("compliance") else 0.0
        assert estimate.state == "found" and estimate.value == pytest.approx(true, rel=1e-3, abs=1e-7)
