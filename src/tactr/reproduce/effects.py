"""How far the tip moves when an assumption changes: by the exact derivatives, and solved again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tactr.reproduce.assumptions import Assumption, assumptions
from tactr.reproduce.records import Case, Effect, Move
from tactr.robot import Robot
from tactr.statics import Shape, solve


def effects(cases: Sequence[Case], replaced: Mapping[str, str] | None = None) -> tuple[Effect, ...]:
    """Of every assumption on a number, in all cases; their robots differ in actuation only."""
    found = []
    per_case = [assumptions(case.robot, replaced) for case in cases]
    for k, one in enumerate(per_case[0]):
        moves = tuple(_move(case, per_case[j][k]) for j, case in enumerate(cases))
        values = " / ".join(dict.fromkeys(of_case[k].value for of_case in per_case))
        found.append(Effect(one.what, one.fields, one.reason, values, one.change, moves))
    return tuple(found)


def other_reading(
    what: str, fields: Sequence[str], reason: str, pairs: Sequence[tuple[Case, Shape]]
) -> Effect:
    """An assumption that is a choice, not a number: each case and the shape under the other choice."""
    moves = tuple(Move(case.label, None, None, distance(case.shape, other)) for case, other in pairs)
    return Effect(what, tuple(fields), reason, "-", "other reading", moves)


def distance(a: Shape, b: Shape) -> float:
    """Between two tips, m. Raises NotConverged."""
    return float(np.linalg.norm(a.tip_position - b.tip_position))


def _move(case: Case, assumption: Assumption) -> Move:
    paths = [path for path, _ in assumption.steps]
    steps = np.array([step for _, step in assumption.steps])
    linear = case.shape.sensitivity(paths)[:3] @ steps
    less, more = (_solved(case, assumption.applied(case.robot, sign)) for sign in (-1.0, 1.0))
    return Move(case.label, float(np.linalg.norm(linear)), less, more)


def _solved(case: Case, robot: Robot | None) -> float | None:
    if robot is None:
        return None
    shape = solve(robot, tolerance=case.shape.tolerance)
    return distance(case.shape, shape) if shape.converged else None
