"""The fast solver against the reference, which starts at its base strains, on random robots."""

from __future__ import annotations

import numpy as np
import pytest

import tactr
from tactr import reference
from tactr.robot import Robot

from .reference_robots import random_straight_robot, random_varied_robot


def largest_distance(robot: Robot) -> float:
    """Return the largest distance between the two centrelines (m)."""
    fast = tactr.solve(robot, tolerance=1e-9, stations=11)
    assert fast.converged, fast.message
    guess = (np.array([tube.u[0] for tube in fast.tubes]), np.array([tube.v[0] for tube in fast.tubes]))
    slow = reference.solve(robot, guess=guess, stations=fast.s)
    return float(np.linalg.norm(slow.centreline - fast.centreline, axis=1).max())


@pytest.mark.parametrize("first", range(0, 100, 10))
def test_straight_routed_robots(first: int) -> None:
    distances = {seed: largest_distance(random_straight_robot(seed)) for seed in range(first, first + 10)}
    assert {seed: far for seed, far in distances.items() if far > 1e-8} == {}


@pytest.mark.parametrize("first", range(0, 20, 10))
def test_robots_with_everything(first: int) -> None:
    distances = {seed: largest_distance(random_varied_robot(seed)) for seed in range(first, first + 10)}
    assert {seed: far for seed, far in distances.items() if far > 1e-8} == {}
