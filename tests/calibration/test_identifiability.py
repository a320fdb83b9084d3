"""What the data do not see is said, not returned as a number."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import Frame, Material, Parameter, Robot, Rod, Tendon, Tube
from tactr.statics.parameters import value_of

from . import simulated

FREE = ("tubes.rod.material.E", "tendons.*.compliance")


def noisy(kind: str, robot: Robot, rows: int = 10) -> tactr.Measurements:
    return simulated.noisy(simulated.measured(robot, kind, rows), np.random.default_rng(3))


def test_a_number_without_influence() -> None:
    """Poisson's ratio of a rod that is not twisted."""
    free = ["tubes.rod.E", "tubes.rod.material.nu"]
    fit = tactr.calibrate(
        simulated.tension_robot(), noisy("tension", simulated.tension_robot()), parameters=free
    )
    nu = fit["tubes.rod.material.nu"]
    assert nu.state == "not identifiable" and nu.value is None and nu.error is None and nu.interval is None
    assert fit["tubes.rod.material.E"].state == "found"
    assert [set(each.weights) for each in fit.unseen] == [{"tubes.rod.material.nu"}]
    assert "not-identifiable" in {remark.kind for remark in fit.remarks}
    assert "not identifiable" in str(fit)
    assert np.isnan(fit.correlation[1]).all()


def test_stiffness_and_compliance_of_a_robot_pulled_by_displacements() -> None:
    """Displacements alone see only their product: tensions scale with E, stretch with both."""
    robot = simulated.displacement_robot(pretension=0.0)
    data = noisy("displacement", robot)
    free = ["tubes.rod.E", Parameter("tendons.*.compliance", common=True)]
    fit = tactr.calibrate(robot, data, parameters=free)
    assert all(estimate.state == "not identifiable" for estimate in fit.estimates)
    (unseen,) = fit.unseen
    E, compliance = (value_of(fit.robot, p) for p in ("tubes.rod.material.E", "tendons.t0.compliance"))
    assert E * compliance == pytest.approx(55e9 * 4e-4, rel=0.05)
    along = np.array([E / 55e9, -compliance / 4e-4])  # of the hyperbola E compliance = const, in scales
    assert np.isinf(unseen.error) and list(unseen.weights) in ([*FREE], [*FREE][::-1])
    found = np.array([unseen.weights[name] for name in FREE])
    assert np.abs(found) == pytest.approx(np.abs(along) / np.linalg.norm(along), rel=1e-3)
    assert found[0] * found[1] < 0.0


def test_a_prior_makes_both_known() -> None:
    robot = simulated.displacement_robot(pretension=0.0)
    free = [Parameter("tubes.rod.E", prior=(55e9, 1e9)), Parameter("tendons.*.compliance", common=True)]
    fit = tactr.calibrate(robot, noisy("displacement", robot), parameters=free)
    assert [estimate.state for estimate in fit.estimates] == ["found", "found"] and not fit.unseen
    assert fit["tubes.rod.material.E"].error == pytest.approx(1e9, rel=0.1)
    assert fit.correlation[0, 1] < -0.5


def test_a_marker_on_the_axis_and_the_sensor_along_it() -> None:
    """Of a robot that only turns about its axis, whose tip keeps its place and direction along it."""
    rod = Tube(
        "rod", length=0.1, section=Rod(1e-3), material=Material(E=60e9, nu=0.3), precurvature=(0, 0, 0)
    )
    rows = 6
    data = tactr.Measurements(
        np.tile([0.0, 0.0, 0.1], (rows, 1)) + np.random.default_rng(1).normal(0, 1e-4, (rows, 3)),
        rotation={"rod": np.linspace(0, 5, rows)},
    )
    fit = tactr.calibrate(Robot([rod]), data, parameters=["marker.z", "sensor.z", "marker.x"])
    assert [e.state for e in fit.estimates] == ["not identifiable", "not identifiable", "found"]
    assert set(fit.unseen[0].weights) == {"marker.z", "sensor.z"} and np.isinf(fit.unseen[0].error)


def test_a_slack_tendon_tells_nothing_of_its_compliance() -> None:
    robot = simulated.displacement_robot()
    actuation = {"t0": np.full(6, 3e-3), "t1": np.full(6, -5e-3), "t2": np.linspace(-5e-3, -4e-3, 6)}
    tips = np.array([simulated.solved(robot, **{k: v[i] for k, v in actuation.items()}) for i in range(6)])
    data = tactr.Measurements(
        tips + np.random.default_rng(0).normal(0, 1e-4, tips.shape), displacement=actuation
    )
    fit = tactr.calibrate(robot, data, parameters=["tendons.t0.compliance", "tendons.t1.compliance"])
    assert fit["tendons.t0.compliance"].state == "found"
    assert fit["tendons.t1.compliance"].state == "not identifiable"


def test_a_number_at_its_bound() -> None:
    data = noisy("tension", simulated.tension_robot())
    fit = tactr.calibrate(
        simulated.tension_robot(65e9), data, parameters=[Parameter("tubes.rod.E", lower=60e9), "sensor.x"]
    )
    assert fit["tubes.rod.material.E"].state == "at its bound"
    assert fit["tubes.rod.material.E"].value == pytest.approx(60e9, rel=1e-6)
    assert "at-bound" in {remark.kind for remark in fit.remarks}


def test_tendons_have_their_own_numbers_or_a_common_one() -> None:
    robot = simulated.displacement_robot()
    data = noisy("displacement", robot)
    own = tactr.calibrate(robot, data, parameters=["tendons.*.compliance"])
    assert [e.name for e in own.estimates] == [f"tendons.t{k}.compliance" for k in range(3)]
    common = tactr.calibrate(robot, data, parameters=[Parameter("tendons.*.compliance", common=True)])
    assert [e.name for e in common.estimates] == ["tendons.*.compliance"]
    values = {tendon.compliance for tendon in common.robot.tendons}
    assert len(values) == 1 and isinstance(common.robot.tendons[0], Tendon)


def test_frames_are_checked() -> None:
    with pytest.raises(tactr.RobotError, match="marker"):
        Frame(marker=(0.0, float("nan"), 0.0))


@pytest.mark.parametrize(
    ("free", "rough"), [(["tubes.outer.E", "tendons.*.compliance"], True), (["tendons.*.compliance"], False)]
)
def test_intervals_over_which_the_model_bends_are_told(free: list[str], rough: bool) -> None:
    """Two tubes pulled by displacements hardly tell a modulus from the compliances: of 60 noisy trials, only
    81 % are within the 95 % intervals."""
    robot = tactr.examples.load("two_tube_90")
    truth = robot.replace(tendons=tuple(replace(tendon, compliance=2e-4) for tendon in robot.tendons))
    rng = np.random.default_rng(1)
    pulled = rng.uniform(0.0, 4e-3, (12, 2))
    tips = [tactr.solve(truth, displacement={"outer": a, "inner": b}).tip_position for a, b in pulled]
    points = np.array(tips) + rng.normal(0.0, 2e-4, (12, 3))
    data = tactr.Measurements(points, displacement={"outer": pulled[:, 0], "inner": pulled[:, 1]})
    fit = tactr.calibrate(truth, data, parameters=free)
    assert ("rough-intervals" in {remark.kind for remark in fit.remarks}) == rough
    assert all(estimate.state == "found" for estimate in fit.estimates)
    assert fit.errors(data) == pytest.approx(fit.error, rel=1e-3)
