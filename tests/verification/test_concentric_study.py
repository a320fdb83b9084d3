"""A published three-tube robot over its whole workspace; benchmarks/concentric.py says how it is drawn."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

COUNT, POINTS = 1000, 1000


@pytest.fixture(scope="module")
def concentric() -> ModuleType:
    path = Path(__file__).resolve().parents[2] / "benchmarks" / "concentric.py"
    spec = importlib.util.spec_from_file_location("concentric", path)
    if spec is None or spec.loader is None or not path.exists():
        pytest.skip("no benchmarks folder: the robot is defined there")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.study
def test_every_cold_solve_converges_to_a_stable_shape(concentric: ModuleType) -> None:
    shapes = concentric.cold_solves(COUNT)
    assert all(shape.converged for shape in shapes)
    assert not any(concentric.unstable_without_need(shape) for shape in shapes)


@pytest.mark.slow
@pytest.mark.study
@pytest.mark.parametrize("loaded", [False, True])
def test_a_long_path_is_followed_to_its_end(concentric: ModuleType, loaded: bool) -> None:
    followed = concentric.random_path(POINTS, loaded=loaded)
    assert followed.converged and len(followed.shapes) == POINTS
    assert all(shape.stability.stable for shape in followed.shapes)
    for snap in followed.snaps:
        assert snap.after.stability.stable
    assert np.isfinite(followed.tips).all()
