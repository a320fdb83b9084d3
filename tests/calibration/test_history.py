"""Friction, backlash and compliance from loading and unloading, in the order of time.

What was measured comes from the closed form of a rod that one tendon bends (see tests/friction/test_bending):
its curvature is the tension times r / EI, so that 1/T grows by a = mu r / EI along the rod while the motor
pulls, and falls by it, down to where the old tensions hold, while it gives way. The motor's displacement is
what the tendon has shortened in the rod, int r kappa + T/EA, and compliance x tension at the motor; it is
half the backlash ahead of that on the way there, and behind it on the way back.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import tactr
from tactr import Annulus, Material, Measurements, Robot, RobotError, Straight, Tendon, Tube
from tactr.calibration import Remark

R, LENGTH, NOISE = 1.2e-3, 0.2, 3e-5  # m
UP, DOWN = (4.0, 8.0), (5.0, 2.0)  # N at the motor
FRICTION, PLAY, COMPLIANCE = 0.3, 0.4e-3, 1.5e-4
TRUTH = {"tendons.up.friction": FRICTION, "tendons.up.play": PLAY, "tendons.up.compliance": COMPLIANCE}


def robot(**fields) -> Robot:
    tube = Tube("tube", length=LENGTH, section=Annulus(2e-3, 1.6e-3), material=Material(E=5e9, nu=0.3))
    return Robot([tube], [Tendon("up", "tube", Straight(0, R), **fields)])


def loop(friction: float, play: float, compliance: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tensions at the motor, its displacements, and tips (n, 3), in closed form."""
    stiffness, s = robot().tubes[0].stiffness, np.linspace(0.0, LENGTH, 2001)
    a = friction * R / stiffness.EI_x
    motor, tips = [], []
    for base in (*UP, *DOWN):
        back = len(motor) >= len(UP)
        tension = 1 / (1 / base + a * s)
        if back:
            tension = np.minimum(1 / (1 / base - a * s), 1 / (1 / max(UP) + a * s))
        angle = cumulative_simpson(tension * R / stiffness.EI_x, x=s, initial=0.0)
        along = 1.0 - tension / stiffness.EA
        y, z = (cumulative_simpson(along * part, x=s)[-1] for part in (np.sin(angle), np.cos(angle)))
        shorter = R * angle[-1] + cumulative_simpson(1.0 - along, x=s)[-1] + compliance * base
        motor.append(shorter + (-0.5 if back else 0.5) * play)
        tips.append([0.0, y, z])
    assert all(a - b > play for a, b in pairwise(motor[len(UP) - 1 : len(UP) + 1]))
    return np.array([*UP, *DOWN]), np.array(motor), np.array(tips)


def recorded(kind: str, *truth: float, seed: int = 3) -> Measurements:
    tension, motor, tips = loop(*truth)
    tips += np.random.default_rng(seed).normal(0.0, NOISE, tips.shape)
    if kind == "tension":
        return Measurements(tips, tension={"up": tension})
    return Measurements(tips, displacement={"up": motor})


def test_friction_backlash_and_compliance_from_a_loop_of_displacements() -> None:
    data = recorded("displacement", FRICTION, PLAY, COMPLIANCE)
    start, told = robot(friction=0.2, play=0.2e-3, compliance=1e-4), []
    fit = tactr.calibrate(
        start, data, parameters=list(TRUTH), noise=NOISE, history=True, progress=lambda *now: told.append(now)
    )
    for name, value in TRUTH.items():
        estimate = fit[name]
        assert estimate.value is not None and estimate.error is not None
        assert abs(estimate.value - value) < 3.0 * estimate.error
        assert estimate.error < 0.05 * value  # the data do tell
    assert np.sqrt(np.mean(fit.residual**2)) < 1.5 * NOISE
    assert fit.history and "4 rows, one path from rest" in str(fit) and fit.to_dict()["history"]
    assert told[:4] == [("start", k, 4) for k in range(4)]
    np.testing.assert_allclose(fit.predict(data), fit.residual + data.points, atol=1e-8)


@pytest.mark.slow
def test_standard_errors_are_those_of_many_loops() -> None:
    scores, trials = [], 16
    for seed in range(trials):
        data = recorded("displacement", FRICTION, PLAY, COMPLIANCE, seed=seed)
        start = robot(friction=0.2, play=0.2e-3, compliance=1e-4)
        fit = tactr.calibrate(start, data, parameters=list(TRUTH), noise=NOISE, history=True)
        found = [(fit[name].value, fit[name].error, value) for name, value in TRUTH.items()]
        scores.append([(estimate - value) / error for estimate, error, value in found])  # pyright: ignore
    spread = np.sqrt(np.mean(np.square(scores), axis=0))
    np.testing.assert_allclose(spread, 1.0, atol=3.0 / np.sqrt(2 * trials))


def test_rows_taken_one_by_one_show_no_friction() -> None:
    data = recorded("tension", FRICTION, 0.0, 0.0)
    for path in ("tendons.up.friction", "tendons.up.play", "tendons.up.friction.0.1"):
        rough = robot(friction=[(0.0, 0.1), (0.1, 0.2)] if path.endswith("1") else 0.1)
        with pytest.raises(RobotError, match=rf"{path}: .*one by one.*history=True"):
            tactr.calibrate(rough, data, parameters=[path])
    fit = tactr.calibrate(robot(friction=0.1), data, parameters=[])
    assert "without the friction of 'up'" in next(r.text for r in fit.remarks if r.kind == "no-history")
    assert not tactr.calibrate(robot(), data, parameters=[]).remarks


def test_friction_in_pieces() -> None:
    """One number of the two is free, the other as it was."""
    data = recorded("tension", FRICTION, 0.0, 0.0).rows(slice(2))
    rough = robot(friction=[(0.0, 0.25), (0.1, FRICTION)])
    fit = tactr.calibrate(rough, data, parameters=["tendons.up.friction.0.1"], noise=NOISE, history=True)
    estimate = fit["tendons.up.friction.0.1"]
    assert estimate.interval is not None and estimate.unit == ""
    assert estimate.interval[0] < FRICTION < estimate.interval[1]


def test_what_is_no_path_is_named() -> None:
    data, friction = recorded("tension", FRICTION, 0.0, 0.0), ["tendons.up.friction"]
    with pytest.raises(RobotError, match=r"folds: rows that are held out would be missing from the path"):
        tactr.calibrate(robot(), data, parameters=friction, folds=2, history=True)
    back = Measurements(data.points, tension=data.tension, time=np.array([0.0, 2.0, 1.0, 3.0]))
    with pytest.raises(RobotError, match=r"time: 1 s in row 2 after 2 s before it.*order of time"):
        tactr.calibrate(robot(), back, parameters=friction, history=True)
    with pytest.raises(RobotError, match=r"tendons.up.play: .*displacement, which is not measured"):
        tactr.calibrate(robot(), data, parameters=["tendons.up.play"], history=True)
    with pytest.raises(RobotError, match=r"tubes.tube.rotation_play: .*rotation, which is not measured"):
        tactr.calibrate(robot(), data, parameters=["tubes.tube.rotation_play"], history=True)
    lost = Remark("missing-numbers", "1 of 5 rows lack a number and are left out (lines 3)")
    broken = Measurements(data.points, tension=data.tension, remarks=(lost,))
    fit = tactr.calibrate(robot(), broken, parameters=[], history=True)
    assert [remark.kind for remark in fit.remarks] == ["missing-numbers", "broken-path"]
