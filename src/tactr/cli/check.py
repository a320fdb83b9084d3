"""The command `check`."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from pathlib import Path

from tactr.cli.inputs import read_robot
from tactr.errors import TactrError


def run_check(files: Sequence[str]) -> int:
    """Check every file and say what is in it, or what is wrong. Returns 2 where one cannot be used."""
    code = 0
    for file in files:
        try:
            found = _study(file) if _is_study(file) else _robot(file)
        except TactrError as error:
            print(error, file=sys.stderr)
            code = 2
            continue
        print(f"{file}: fine: {found}")
    return code


def _is_study(file: str) -> bool:
    try:
        text = Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return re.search(r"^(vary\s*[:=]|\[\[?vary\]\]?)", text, re.MULTILINE) is not None


def _study(file: str) -> str:
    from tactr.studies import load_study

    study = load_study(file)
    varied = ", ".join(axis.path for axis in study.vary)
    return f"study of {study.robot.name or 'a robot'}; {study.count} configurations; varied {varied}"


def _robot(file: str) -> str:
    robot = read_robot(file)
    remarks = [f"\n  assumed: {' '.join(remark.split())}" for remark in robot.assumed]
    return _summary(robot) + "".join(remarks)


def _summary(robot) -> str:
    parts = [f"tubes {', '.join(tube.name for tube in robot.tubes)}"]
    if robot.tendons:
        parts.append(f"tendons {', '.join(tendon.name for tendon in robot.tendons)}")
    if robot.loads:
        parts.append(f"loads {len(robot.loads)}")
    return "; ".join(parts)
