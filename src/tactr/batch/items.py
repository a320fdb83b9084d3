"""What a batch is asked: rows of actuation and parameters by item, each item a robot of its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot import _check as check
from tactr.statics.parameters import value_of, with_values

Given = Mapping[str, Any] | Sequence[Any] | np.ndarray | None
Columns = dict[str, np.ndarray]  # by name, one number for each item


@dataclass(frozen=True, repr=False, eq=False)
class Items:
    """Items of a batch: the robot they come from, and what each has of its own, (count,) by name."""

    base: Robot
    count: int
    actuation: dict[str, Columns]
    parameters: Columns

    def design(self, i: int) -> Robot:
        """The robot of item i before it is actuated. Raises RobotError."""
        return with_values(self.base, {path: float(values[i]) for path, values in self.parameters.items()})

    def actuated(self, i: int, design: Robot) -> Robot:
        """The same at the item's actuation. Raises RobotError."""
        given = {
            field: {name: float(values[i]) for name, values in columns.items()}
            for field, columns in self.actuation.items()
            if columns
        }
        return design.with_actuation(**given) if given else design


def items_of(robot: Robot, parameters: Mapping[str, Any] | None, **actuation: Given) -> Items:
    """Checks names and shapes, and repeats what is given once. Raises RobotError."""
    tendons, tubes = [t.name for t in robot.tendons], [t.name for t in robot.tubes]
    parts = {"tension": tendons, "displacement": tendons, "rotation": tubes, "translation": tubes}
    given = {field: _columns(field, actuation[field], names) for field, names in parts.items()}
    if parameters is not None and not isinstance(parameters, Mapping):
        raise RobotError(
            "parameters", check.show(parameters), "a mapping from paths to numbers", value=parameters
        )
    paths = {path: _column(f"parameters[{path!r}]", values) for path, values in (parameters or {}).items()}
    for path in paths:
        value_of(robot, path)
    labelled = [
        (f"{field}[{name!r}]", column) for field, columns in given.items() for name, column in columns.items()
    ]
    count = _count(labelled + [(f"parameters[{path!r}]", column) for path, column in paths.items()])
    full = {
        field: {name: np.broadcast_to(column, count) for name, column in columns.items()}
        for field, columns in given.items()
    }
    return Items(robot, count, full, {path: np.broadcast_to(column, count) for path, column in paths.items()})


def _columns(field: str, given: Given, names: list[str]) -> Columns:
    if given is None:
        return {}
    if isinstance(given, Mapping):
        for name in given:
            if name not in names:
                raise RobotError(
                    field, f"there is none called {check.show(name)}", check.near(name, names), value=name
                )
        return {name: _column(f"{field}[{name!r}]", values) for name, values in given.items()}
    expected = f"an array (items, {len(names)}), or a mapping from names to (items,) arrays or numbers"
    table = _numbers(field, given, expected)
    if table.ndim != 2 or table.shape[1] != len(names):
        raise RobotError(field, f"an array of shape {table.shape}", expected, value=given)
    return dict(zip(names, table.T, strict=True))


def _column(field: str, values: Any) -> np.ndarray:
    expected = "a number, or an array of one number for each item"
    column = _numbers(field, values, expected)
    if column.ndim > 1:
        raise RobotError(field, f"an array of shape {column.shape}", expected, value=values)
    return np.atleast_1d(column)


def _numbers(field: str, values: Any, expected: str) -> np.ndarray:
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise RobotError(field, f"{check.show(values)} are not numbers", expected, value=values) from None


def _count(columns: list[tuple[str, np.ndarray]]) -> int:
    lengths = {len(column): name for name, column in columns if len(column) != 1}
    if len(lengths) > 1:
        (one, first), (other, second) = list(lengths.items())[:2]
        raise RobotError(
            second, f"{other} numbers, where {first!r} has {one}", "as many for each, or one for all items"
        )
    return next(iter(lengths), 1)
