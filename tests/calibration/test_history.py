"""Friction, backlash and compliance from loading and unloading, in the order of time."""

from __future__ import annotations

import numpy as np
import pytest

import tactr
from tactr import Material, Measurements, Robot, RobotError, Rod, Straight, Tendon, Tube

NOISE = 1e-4  # m
LOOP = np.array([1.0, 3.0, 5.0, 7.0, 5.5, 4.0, 2.5, 1.0, 4.0, 7.0])


def robot(**fields) -> Robot:
    rod = Tube("rod", length=0.2, section=Rod(2e-3), material=Material(E=55e9, nu=0.3))
    return Robot([rod], [Tendon("pull", "rod", Straight(5e-3, 0.0), **fields)])


def recorded(truth: Robot, kind: str, values: np.ndarray, seed: int) -> Measurements:
    tips = tactr.drive(truth, [{kind: {"pull": value}} for value in values], stations=2).tips
    tips += np.random.default_rng(seed).normal(0.0, NOISE, tips.shape)
    return Measurements(tips, **{kind: {"pull": values}})


def within(fit: tactr.Calibration, truth: dict[str, float]) -> None:
    for name, value in truth.items():
        estimate = fit[name]
        assert estimate.value is not None and estimate.error is not None
        assert abs(estimate.value - value) < 3.0 * estimate.error
        assert estimate.error < 0.2 * value  # the data do tell


def test_friction_from_a_loop_of_tensions() -> None:
    data = recorded(robot(friction=0.2), "tension", LOOP, seed=1)
    fit = tactr.calibrate(
        robot(friction=0.05), data, parameters=["tendons.pull.friction"], noise=NOISE, history=True
    )
    within(fit, {"tendons.pull.friction": 0.2})
    assert np.sqrt(np.mean(fit.residual**2)) < 1.5 * NOISE
    np.testing.assert_allclose(fit.predict(data), fit.residual + data.points, atol=1e-5)


def test_play_and_compliance_from_a_loop_of_displacements() -> None:
    values = 1e-3 * LOOP
    data = recorded(robot(play=0.6e-3, compliance=3e-4), "displacement", values, seed=2)
    start = robot(play=0.2e-3, compliance=2e-4)
    fit = tactr.calibrate(
        start,
        data,
        parameters=["tendons.pull.play", "tendons.pull.compliance"],
        noise=NOISE,
        history=True,
    )
    within(fit, {"tendons.pull.play": 0.6e-3, "tendons.pull.compliance": 3e-4})


def test_rows_of_a_path_cannot_be_held_out() -> None:
    data = Measurements(np.tile([0.0, 0.0, 0.2], (4, 1)), tension={"pull": np.arange(4.0)})
    with pytest.raises(RobotError, match=r"folds: rows that are held out would be missing from the path"):
        tactr.calibrate(robot(), data, parameters=["tendons.pull.friction"], folds=2, history=True)
