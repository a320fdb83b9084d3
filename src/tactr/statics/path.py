"""Actuation along a path: rows of tensions or displacements, rotations and translations, linear in
between."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile

KINDS = ("tension", "rotation", "translation", "displacement")
Path = Sequence[Mapping[str, Any]] | Mapping[str, Any]
EXPECTED = (
    "a list of mappings like {'rotation': {'inner': 0.1}}, or one mapping from 'tension', 'displacement', "
    "'rotation' or 'translation' to an array with a row for every point and a column for every tendon or tube"
)


def path_points(robot: Robot, path: Path) -> list[Robot]:
    """The robot at every point of a path, at least one; RobotError names the wrong point."""
    points = _rows(path) if isinstance(path, Mapping) else path
    if isinstance(points, str) or not isinstance(points, Sequence) or len(points) == 0:
        raise RobotError("path", f"{path!r} is not a path", EXPECTED, value=path)
    found = [_at(robot, point, k) for k, point in enumerate(points)]
    for k, moved in enumerate(found):
        _check_same_pulls(found[0], moved, k)
    return found


def _rows(path: Mapping[str, Any]) -> list[dict[str, Any]]:
    _check_kinds(path, "path")
    try:
        arrays = {kind: np.asarray(rows, dtype=float) for kind, rows in path.items()}
    except (TypeError, ValueError):
        raise RobotError("path", "not all entries are numbers", EXPECTED, value=path) from None
    lengths = {len(array) for array in arrays.values() if array.ndim == 2}
    if any(array.ndim != 2 for array in arrays.values()) or len(lengths) != 1:
        shapes = ", ".join(f"{kind} {array.shape}" for kind, array in arrays.items())
        raise RobotError("path", f"arrays of the shapes {shapes or 'none'}", EXPECTED, value=path)
    return [{kind: array[k] for kind, array in arrays.items()} for k in range(lengths.pop())]


def _at(robot: Robot, point: object, k: int) -> Robot:
    if not isinstance(point, Mapping):
        raise RobotError(f"path[{k}]", f"{point!r} is not a mapping", EXPECTED, value=point)
    _check_kinds(point, f"path[{k}]")
    try:
        moved = robot.with_actuation(**point)
    except RobotError as error:
        raise error.under(f"path[{k}]") from None
    for own, other in zip(robot.tendons, moved.tendons, strict=True):
        profiled = isinstance(own.tension, TensionProfile) or isinstance(other.tension, TensionProfile)
        if profiled and own.tension != other.tension:
            raise RobotError(
                f"path[{k}].tension", f"{own.name!r} has a tension profile", "the profile as it is"
            )
    return moved


def _check_same_pulls(first: Robot, moved: Robot, k: int) -> None:
    """Between a tension and a displacement there is nothing linear."""
    for own, other in zip(first.tendons, moved.tendons, strict=True):
        if (own.displacement is None) != (other.displacement is None):
            kinds = ("tension", "displacement")
            before, now = kinds if own.displacement is None else kinds[::-1]
            raise RobotError(
                f"path[{k}].{now}",
                f"{own.name!r} is pulled by a {now}, at path[0] by a {before}",
                f"a {before} at every point, or a {now} at every point",
            )


def _check_kinds(point: Mapping[str, Any], field: str) -> None:
    for kind in point:
        if kind not in KINDS:
            raise RobotError(field, f"there is no actuation {kind!r}", ", ".join(KINDS), value=kind)
