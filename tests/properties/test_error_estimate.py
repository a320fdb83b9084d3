"""The estimated discretisation error against the true one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import tactr
from tactr import Robot


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_estimate_bounds_the_true_error_of_most_robots(
    random_robot: Callable[[int], Robot], tolerance: float
) -> None:
    """19 of 20 true errors are below their estimate, and all below 5 times the tolerance."""
    ratios, errors = [], []
    for seed in range(60):
        robot = random_robot(seed)
        shape = tactr.solve(robot, tolerance=tolerance, stations=2)
        fine = tactr.solve(robot, tolerance=1e-11, stations=2, guess=shape)
        assert shape.converged and fine.converged, shape.message + fine.message
        assert shape.discretisation_error <= tolerance
        error = float(np.linalg.norm(fine.tip_position - shape.tip_position))
        errors.append(error)
        ratios.append(error / max(shape.discretisation_error, 1e-10))
    assert np.mean(np.array(ratios) <= 1.0) >= 0.95
    assert max(errors) <= 5 * tolerance
