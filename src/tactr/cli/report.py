"""The result of a solve for people to read; a table library would take longer to import than the solve."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tactr.robot import Robot, Tendon
    from tactr.statics import Shape

BOLD, FAINT, GREEN, YELLOW = "1", "2", "32", "33"
GAP = "   "


def print_report(shape: Shape, written: Sequence[Path] = ()) -> None:
    """Print tip, tubes, tendons and how well the solve converged; written: the files that were made."""
    from tactr.statics.status import told_of_history

    robot = shape.robot
    print(f"{_styled(robot.name or 'robot', BOLD)}: {_contents(robot)}\n")
    for table in (_tip(shape), _tubes(robot), _tendons(shape)):
        if len(table) > 1:
            print(aligned(table) + "\n")
    print(
        f"{_styled('converged', GREEN)} in {_count(shape.iterations, 'iteration')},"
        f" {shape.solve_time * 1e3:.3g} ms: residual {shape.residual:.1e},"
        f" discretisation error {shape.discretisation_error * 1e6:.2g} um"
    )
    if any(tendon.displacement is not None for tendon in robot.tendons):
        print(_pulled(shape))
    print(_stability(shape))
    left_out = told_of_history(robot, driven=False).removeprefix("; ")
    if left_out:
        print(_styled(left_out, FAINT))
    if robot.assumed:
        remark = f"{_count(len(robot.assumed), 'value')} assumed, not given by the source: see tactr check"
        print(_styled(remark, FAINT))
    for path in written:
        print(f"wrote {path}")


def _stability(shape: Shape) -> str:
    stability = shape.stability
    if stability.stable and not stability.near_limit:
        return str(stability)
    if shape.stable and not stability.stable:
        return _styled(f"stable with the motors held; at these tensions {stability}", YELLOW)
    return _styled(f"warning: {stability}", YELLOW)


def _contents(robot: Robot) -> str:
    members = {"tube": robot.tubes, "tendon": robot.tendons, "load": robot.loads}
    return ", ".join(_count(len(parts), noun) for noun, parts in members.items())


def _tip(shape: Shape) -> list[list[str]]:
    direction = [f"{component:z.4f}" for component in shape.tip_orientation[:, 2]]
    return [
        ["tip", "x", "y", "z"],
        ["position (mm)", *map(_mm, shape.tip_position)],
        ["direction", *direction],
    ]


def _tubes(robot: Robot) -> list[list[str]]:
    rows = [["tube", "length (mm)", "outside guide (mm)", "translation (mm)", "rotation (deg)"]]
    for tube in robot.tubes:
        lengths = [_mm(value) for value in (tube.length, tube.tip, tube.translation)]
        rows.append([tube.name, *lengths, f"{math.degrees(tube.rotation):z.1f}"])
    return rows


def _tendons(shape: Shape) -> list[list[str]]:
    robot = shape.robot
    pulled = any(tendon.displacement is not None for tendon in robot.tendons)
    rows = [["tendon", "ends on", "tension (N)", "length (mm)", *(["displacement (mm)"] if pulled else [])]]
    for tendon, drawn, tension in zip(robot.tendons, shape.tendons, shape.tension, strict=True):
        row = [tendon.name, tendon.tube, _tension(tendon, drawn.slack, tension), _mm(drawn.length)]
        if pulled:
            row.append("-" if tendon.displacement is None else _mm(tendon.displacement))
        rows.append(row)
    return rows


def _tension(tendon: Tendon, slack: bool, found: float) -> str:
    if not isinstance(tendon.tension, (int, float)):
        return "profile"
    if tendon.displacement is None:
        return f"{tendon.tension:g}"
    return "slack" if slack else f"{found:.4f}"


def _pulled(shape: Shape) -> str:
    slack = ", ".join(shape.slack)
    met = f"displacements met to {shape.displacement_error * 1e6:.2g} um"
    return f"{met}; {f'slack: {slack}' if slack else 'no tendon is slack'}"


def _mm(value: float) -> str:
    return f"{value * 1e3:z.3f}"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}" if number else f"no {noun}s"


def aligned(rows: Sequence[Sequence[str]]) -> str:
    """Rows as text, the first column to the left, the others to the right; the first row is the head."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for first, *others in rows:
        cells = [f"{cell:>{width}}" for cell, width in zip(others, widths[1:], strict=True)]
        lines.append(GAP.join([f"{first:<{widths[0]}}", *cells]))
    return "\n".join([_styled(lines[0], FAINT), *lines[1:]])


def _styled(text: str, code: str) -> str:
    plain = os.environ.get("NO_COLOR") or not sys.stdout.isatty()
    return text if plain else f"\033[{code}m{text}\033[0m"
