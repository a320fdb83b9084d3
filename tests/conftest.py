"""What all tests share: the reference data beside the repository, and random robots."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

from tactr.robot import Robot

settings.register_profile("tactr", derandomize=True, deadline=None, max_examples=25, database=None)
settings.load_profile("tactr")

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of reference data beside the repository; the test is skipped where it is not there."""
    folder = ROOT.parent / "shared"
    if not (folder / "cases.json").exists():
        pytest.skip(f"no reference data: there is no folder {folder.name!r} beside the repository")
    return folder


@pytest.fixture(scope="session")
def random_robot() -> Callable[[int], Robot]:
    """The random plausible robots of the benchmarks, by seed."""
    path = ROOT / "benchmarks" / "random_robots.py"
    spec = importlib.util.spec_from_file_location("random_robots", path)
    if spec is None or spec.loader is None or not path.exists():
        pytest.skip("no benchmarks folder: the random robots are defined there")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up there
    spec.loader.exec_module(module)
    return module.random_robot
