"""The command `check`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from tactr.cli.inputs import read_robot
from tactr.errors import TactrError


def run_check(files: Sequence[str]) -> int:
    """Check every file and say what is in it, or what is wrong. Returns 2 where one cannot be used."""
    code = 0
    for file in files:
        try:
            robot = read_robot(file)
        except TactrError as error:
            print(error, file=sys.stderr)
            code = 2
            continue
        print(f"{file}: fine: {_summary(robot)}")
        for remark in robot.assumed:
            print(f"  assumed: {' '.join(remark.split())}")
    return code


def _summary(robot) -> str:
    parts = [f"tubes {', '.join(tube.name for tube in robot.tubes)}"]
    if robot.tendons:
        parts.append(f"tendons {', '.join(tendon.name for tendon in robot.tendons)}")
    if robot.loads:
        parts.append(f"loads {len(robot.loads)}")
    return "; ".join(parts)
