"""Actuation along a path: rows of tensions or displacements, rotations and translations, linear in
between."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.statics.actuation import displacements, rotations, tensions, translations

KINDS = ("tension", "rotation", "translation", "displacement")
Path = Sequence[Mapping[str, Any]] | Mapping[str, Any]
EXPECTED = (
    "a list of mappings like {'rotation': {'inner': 0.1}}, or one mapping from 'tension', 'displacement', "
    "'rotation' or 'translation' to an array with a row for every point and a column for every tendon or tube"
)


@dataclass(frozen=True, eq=False)
class PathPoints:
    """k points, at least one: the robot at the first; by point tension (k, tendons) N, rotation (k, tubes)
    rad, translation (k, tubes) m, and displacement (k, tendons) m, NaN for tendons pulled by a tension."""

    first: Robot
    tension: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    displacement: np.ndarray

    def __len__(self) -> int:
        return len(self.tension)


def path_points(robot: Robot, path: Path) -> PathPoints:
    """Checked points of a path; RobotError names the wrong one."""
    points = path
    if isinstance(path, Mapping):
        arrays, count = _arrays(path)
        if count > 0 and _is_plain(robot, arrays):
            first = _at(robot, _row(arrays, 0), 0)
            return _points([first], count, **arrays)
        points = [_row(arrays, k) for k in range(count)]
    if isinstance(points, str) or not isinstance(points, Sequence) or len(points) == 0:
        raise RobotError("path", f"{path!r} is not a path", EXPECTED, value=path)
    robots = [_at(robot, point, k) for k, point in enumerate(points)]
    for k, moved in enumerate(robots):
        _check_same_pulls(robots[0], moved, k)
    return _points(robots)


def _points(robots: list[Robot], copies: int = 1, **given: np.ndarray) -> PathPoints:
    """Of robots at all points, or of so many copies of one but for what is given, an array by kind."""
    reads = {"tension": tensions, "rotation": rotations, "translation": translations, "displacement": _pulls}
    read = {
        k: np.repeat([of(r) for r in robots], copies, axis=0) for k, of in reads.items() if k not in given
    }
    return PathPoints(robots[0], **read, **given)


def _pulls(robot: Robot) -> np.ndarray:
    pulls = displacements(robot)
    return np.full(len(robot.tendons), np.nan) if pulls is None else pulls


def _arrays(path: Mapping[str, Any]) -> tuple[dict[str, np.ndarray], int]:
    """By kind, with a row for every point; and how many points there are."""
    _check_kinds(path, "path")
    try:
        arrays = {kind: np.array(rows, dtype=float) for kind, rows in path.items()}
    except (TypeError, ValueError):
        raise RobotError("path", "not all entries are numbers", EXPECTED, value=path) from None
    lengths = {len(array) for array in arrays.values() if array.ndim == 2}
    if any(array.ndim != 2 for array in arrays.values()) or len(lengths) != 1:
        shapes = ", ".join(f"{kind} {array.shape}" for kind, array in arrays.items())
        raise RobotError("path", f"arrays of the shapes {shapes or 'none'}", EXPECTED, value=path)
    return arrays, lengths.pop()


def _row(arrays: dict[str, np.ndarray], k: int) -> dict[str, np.ndarray]:
    return {kind: array[k] for kind, array in arrays.items()}


def _is_plain(robot: Robot, arrays: dict[str, np.ndarray]) -> bool:
    """Whether no point needs a closer look: where nothing moves in or out, every tube fits as it did, and
    tensions that are not negative replace numbers."""
    columns = {"tension": len(robot.tendons), "rotation": len(robot.tubes)}
    if any(
        array.shape[1] != columns.get(kind) or not np.isfinite(array).all() for kind, array in arrays.items()
    ):
        return False
    profiled = any(isinstance(tendon.tension, TensionProfile) for tendon in robot.tendons)
    return "tension" not in arrays or not (profiled or (arrays["tension"] < 0.0).any())


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
