"""The fast solver against the reference, which starts at its base strains, on random robots."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import reference
from tactr.errors import RobotError
from tactr.materials import nitinol, nylon
from tactr.robot import Along, Annulus, Helix, RestShape, Robot, Rod, Stiffness, Straight, Tendon, Tube

from .reference_robots import random_straight_robot, random_varied_robot


def largest_distance(robot: Robot) -> float:
    """Return the largest distance between the two centrelines (m)."""
    fast = tactr.solve(robot, tolerance=1e-9, stations=11)
    assert fast.converged, fast.message
    guess = (np.array([tube.u[0] for tube in fast.tubes]), np.array([tube.v[0] for tube in fast.tubes]))
    slow = reference.solve(robot, guess=guess, stations=fast.s)
    return float(np.linalg.norm(slow.centreline - fast.centreline, axis=1).max())


@pytest.mark.parametrize(
    "first", [*range(0, 50, 10), *(pytest.param(k, marks=pytest.mark.slow) for k in range(50, 100, 10))]
)
def test_straight_routed_robots(first: int) -> None:
    distances = {seed: largest_distance(random_straight_robot(seed)) for seed in range(first, first + 10)}
    assert {seed: far for seed, far in distances.items() if far > 1e-8} == {}


@pytest.mark.parametrize("first", range(0, 20, 10))
def test_robots_with_everything(first: int) -> None:
    distances = {seed: largest_distance(random_varied_robot(seed)) for seed in range(first, first + 10)}
    assert {seed: far for seed, far in distances.items() if far > 1e-8} == {}


def test_stepped_stiffness() -> None:
    soft = Stiffness(EA=2e4, GA=8e3, EI_x=4e-3, EI_y=7e-3, GJ=5e-3)
    outer = Tube("outer", length=0.1, section=[(0.0, Annulus(2e-3, 1.4e-3)), (0.055, soft)], material=nitinol)
    inner = Tube(
        "inner",
        length=0.14,
        section=Rod(0.8e-3),
        material=[(0.0, nitinol), (0.08, nylon)],
        precurvature=[(0.0, (3.0, 0.0, 1.0)), (0.05, (0.0, 5.0, 0.0))],
    )
    tendons = [
        Tendon("one", "outer", Straight(2e-3, 0.0), tension=2.0),
        Tendon("two", "inner", Helix(1e-3, 20.0), tension=0.3),
    ]
    assert largest_distance(Robot([outer, inner], tendons)) < 1e-8


@pytest.mark.parametrize(
    "change",
    [
        {"precurvature": RestShape(v=(0.0, 0.0, 1.1))},
        {"precurvature": RestShape((Along.linear([0.0, 0.1], [0.0, 1.0]), 0.0, 0.0))},
        {"section": Stiffness(EA=2e4, GA=8e3, EI_x=4e-3, EI_y=7e-3, GJ=5e-3, neutral_axis=(1e-4, 0.0))},
    ],
)
def test_what_the_reference_cannot_do_is_refused(change: dict[str, Any]) -> None:
    tube = replace(Tube("a", length=0.1, section=Rod(1e-3), material=nitinol), **change)
    with pytest.raises(RobotError, match=r"tubes\[0\]: 'a' varies smoothly"):
        reference.solve(Robot([tube]))
