"""Shared cases for the tests of `tactr.reference`."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tactr.robot import Robot

from .reference_robots import CASE_NAMES, CASES, case_robot


@pytest.fixture(scope="session")
def cases() -> dict[str, tuple[Robot, dict[str, Any]]]:
    """Robot and expected numbers by name of case.

    Skips where the shared folder is not beside the repository.
    """
    if not CASES.exists():
        pytest.skip(f"no {CASES}: the shared reference cases are not beside this repository")
    entries = json.loads(CASES.read_text(encoding="utf-8"))["cases"]
    return {name: (case_robot(entries[name]), entries[name]) for name in CASE_NAMES}
