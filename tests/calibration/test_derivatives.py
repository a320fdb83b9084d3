"""The derivatives that a calibration uses are those of its predictions: differences of solves say so."""

from __future__ import annotations

import numpy as np
import pytest

from tactr import Frame, Parameter
from tactr.calibration.model import Model
from tactr.calibration.parameters import expanded

from . import simulated

FRAME = Frame(marker=(1e-3, 2e-3, 8e-3), position=(0.01, -0.02, 0.05), rotation=(0.5, 0.7, -0.9))
FREE = [
    "tubes.rod.E", "tubes.rod.length", "marker.*", "sensor.*", "tendons.t0.routing.*"
]  # fmt: skip
MOTORS = ["tendons.*.zero", Parameter("tendons.*.compliance", common=True), "tendons.t1.pretension"]


@pytest.mark.parametrize("kind", ["tension", "displacement"])
def test_derivatives_of_every_point(kind: str) -> None:
    robot = simulated.tension_robot() if kind == "tension" else simulated.displacement_robot()
    data = simulated.measured(robot, kind, 4, places=(0.07, 0.13, None), frame=FRAME)
    frees = expanded(robot, FREE + (MOTORS if kind == "displacement" else []), list(data.displacement), FRAME)
    model, values = Model(robot, FRAME, data, frees, 1e-10), np.array([free.start for free in frees])
    model.predict(values)
    if kind == "displacement":
        assert (model.tensions() == 0.0).any()  # some are slack
    exact = model.jacobian(values)
    for k, free in enumerate(frees):
        step = np.eye(len(frees))[k] * 1e-4 * free.scale
        difference = (model.predict(values + step) - model.predict(values - step)) / 2e-4
        assert exact[..., k] * free.scale == pytest.approx(difference, rel=1e-5, abs=2e-8), free.name
