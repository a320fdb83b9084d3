"""A solve depends on nothing but what it is given: not on what the process has done before."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
TWICE = """
from wide_robots import wide_robot
from tactr.statics import Prepared

for _ in range(2):
    print(Prepared(wide_robot(5492), stations=2).solve().tip_position.tobytes().hex())
"""


def test_the_first_solve_of_a_process_is_as_the_second() -> None:
    """This robot is grown from its tip, and settled by a search: every solver is used on it."""
    done = subprocess.run(
        [sys.executable, "-c", TWICE], cwd=BENCHMARKS, capture_output=True, text=True, check=True, timeout=60
    )
    first, second = done.stdout.split()
    assert first == second
