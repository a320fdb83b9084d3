"""Numbers of a robot's description by their path, and how the kernel's tables change with them.

The tables are smooth closed forms of the description (EI of diameters and moduli, polynomials of offsets), so
their rates are taken by Richardson's differences with a step of 1e-3 of the number: to about 1e-11, relative.
Sections, routings and rest shapes that were fitted to functions change with their own numbers only.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.robot import _check as check
from tactr.statics.assemble import tables

RELATIVE_STEP, LEAST_STEP = 1e-3, 1e-6
WHOLE_NUMBERS = {  # columns of the tables that hold counts, indices and switches
    "tubes": [3],
    "pieces": [1],
    "tendons": [0, 1, 3, 4],
    "routing": [2, 3, 4],
    "profiles": [1],
    "point_loads": [0, 1],
    "distributed_loads": [0, 1],
}
AXES = {"x": 0, "y": 1, "z": 2}
Tables = dict[str, np.ndarray]


def value_of(robot: Robot, path: str) -> float:
    """The number at a path, such as "tubes.outer.material.E", in SI units. Raises RobotError."""
    found: Any = robot
    steps = path.split(".")
    for k, step in enumerate(steps):
        found = _child(found, step, path, steps[:k])
    if isinstance(found, bool) or not isinstance(found, int | float):
        further = _options(found)
        expected = "a further step, one of " + ", ".join(further) if further else "the path of a number"
        raise RobotError(path, f"{check.show(found)} is not a number", expected, value=path)
    return float(found)


def with_value(robot: Robot, path: str, value: float) -> Robot:
    """The robot with another number at a path. Raises RobotError."""
    return with_values(robot, {path: value})


def with_values(robot: Robot, values: Mapping[str, float]) -> Robot:
    """The robot with other numbers at several paths, all changed at once: only together need they make a
    robot. Raises RobotError, whose owner names the paths."""
    tree = _Tree({}, [])
    for path, value in values.items():
        value_of(robot, path)
        tree.plant(path, value)
    return _replaced(robot, tree)


def place_of(robot: Robot, path: str) -> tuple[str, str, int] | None:
    """("tendons", "tension", index of the tendon) and the like for a field of a tendon or a tube; None for
    any other path."""
    group, _, rest = path.partition(".")
    name, _, field = rest.rpartition(".")
    names = [part.name for part in getattr(robot, group)] if group in ("tubes", "tendons") else []
    return (group, field, names.index(name)) if name in names else None


def actuator_column(robot: Robot, path: str) -> int | None:
    """The Jacobian's column of a tension, rotation or translation; None for any other path."""
    tendons, tubes = len(robot.tendons), len(robot.tubes)
    match place_of(robot, path):
        case "tendons", "tension", j:
            if not isinstance(robot.tendons[j].tension, TensionProfile):  # counts per unit of a factor on it
                value_of(robot, path)
            return j
        case "tubes", "rotation", i:
            return tendons + i
        case "tubes", "translation", i:
            return tendons + tubes + i
    return None


def rates_of(robot: Robot, *paths: str) -> _core.PreparedRobot:
    """d(tables)/d(number at the path), with the layout of its tables; of several paths, together."""
    values, base = [value_of(robot, path) for path in paths], tables(robot)
    step = max(RELATIVE_STEP * max(map(abs, values)), LEAST_STEP)

    def at(shift: float) -> Tables:
        return tables(with_values(robot, {p: value + shift for p, value in zip(paths, values, strict=True)}))

    rates = _differences(at, base, step)
    for name, columns in WHOLE_NUMBERS.items():
        rates[name][:, columns] = base[name][:, columns]
    return _core.PreparedRobot(**{name: np.ascontiguousarray(table) for name, table in rates.items()})


def _differences(at: Callable[[float], Tables], base: Tables, step: float) -> Tables:
    """Central differences of order 4; one-sided ones of the same order where the robot ends on one side."""
    errors = []
    for weights in (
        {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12},
        {0: -25 / 12, 1: 4.0, 2: -3.0, 3: 4 / 3, 4: -1 / 4},
        {0: 25 / 12, -1: -4.0, -2: 3.0, -3: -4 / 3, -4: 1 / 4},
    ):
        try:
            moved = {k: at(k * step) if k else base for k in weights}
        except RobotError as error:
            errors.append(error)
            continue
        return {name: _weighted(moved, weights, name, base[name], step) for name in base}
    raise errors[0]


def _weighted(
    moved: dict[int, Tables], weights: dict[int, float], name: str, base: np.ndarray, step: float
) -> np.ndarray:
    if any(other[name].shape != base.shape for other in moved.values()):
        raise RobotError(
            name, "it is cut into other pieces when the number changes", "a number that keeps them"
        )
    ends = np.isfinite(base)
    rates = np.zeros_like(base)
    changes = {k: moved[k][name][ends] - base[ends] for k in weights}  # none where a table stays as it is
    rates[ends] = sum(weight * changes[k] for k, weight in weights.items()) / step
    return rates


def _child(owner: Any, step: str, path: str, before: list[str]) -> Any:
    options = _options(owner)
    if step not in options:
        place = ".".join(before) or "the robot"
        raise RobotError(
            path,
            f"{place} has no {step!r}",
            "one of " + ", ".join(options) if options else "no further step",
            value=path,
        )
    return options[step][0]


def _options(owner: Any) -> dict[str, tuple[Any, Any]]:
    """What a step of a path can name: (child, its key)."""
    if isinstance(owner, tuple):
        named = all(hasattr(item, "name") for item in owner) and owner
        options = {item.name if named else str(k): (item, k) for k, item in enumerate(owner)}
        if len(owner) == 3 and not named:
            options |= {axis: (owner[k], k) for axis, k in AXES.items()}
        return options
    if dataclasses.is_dataclass(owner):
        return {f.name: (getattr(owner, f.name), f.name) for f in dataclasses.fields(owner) if f.init}
    return {}


class _Tree(NamedTuple):
    """New numbers by the steps to them, and the paths of all of them."""

    steps: dict[str, _Tree | float]
    paths: list[str]

    def plant(self, path: str, value: float) -> None:
        *way, last = path.split(".")
        tree = self
        tree.paths.append(path)
        for step in way:
            below = tree.steps.setdefault(step, _Tree({}, []))
            assert isinstance(below, _Tree)
            tree = below
            tree.paths.append(path)
        tree.steps[last] = value


def _replaced(owner: Any, new: _Tree | float) -> Any:
    if not isinstance(new, _Tree):
        return new
    options = _options(owner)
    changed = {options[step][1]: _replaced(options[step][0], below) for step, below in new.steps.items()}
    if isinstance(owner, tuple):
        return tuple(changed.get(k, item) for k, item in enumerate(owner))
    try:
        return dataclasses.replace(owner, **changed)
    except RobotError as error:
        error.owner = ", ".join(part for part in (error.owner, *map(_parameter, new.paths)) if part)
        raise


def _parameter(path: str) -> str:
    return f"parameter {path!r}"
