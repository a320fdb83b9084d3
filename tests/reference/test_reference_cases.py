"""The shared cases: an independent shooting solution of the same equations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactr import reference
from tactr.robot import Robot

from .reference_robots import CASE_NAMES

Cases = dict[str, tuple[Robot, dict[str, Any]]]


@pytest.mark.parametrize("name", CASE_NAMES)
def test_centreline_of_shared_case(cases: Cases, name: str) -> None:
    robot, expected = cases[name]
    shape = reference.solve(robot, stations=11)
    assert np.abs(shape.centreline - expected["centerline"]).max() < 1e-9
    assert np.abs(shape.tip - expected["tip_position"]).max() < 2e-10
    assert shape.residual < 1e-9


def test_published_transitions_of_three_tubes_mixed(cases: Cases) -> None:
    robot, expected = cases["three_tubes_mixed"]
    tip = reference.solve(robot, transitions="published").tip
    assert np.abs(tip - [-0.02896109, 0.08847800, 0.21327465]).max() < 6e-9
    assert np.linalg.norm(tip - expected["tip_position"]) == pytest.approx(1.5e-4, rel=0.1)


def test_transitions_agree_where_no_tendon_direction_jumps(cases: Cases) -> None:
    robot, expected = cases["two_tubes_orthogonal_own"]
    tip = reference.solve(robot, transitions="published").tip
    assert np.abs(tip - expected["tip_position"]).max() < 1e-7
