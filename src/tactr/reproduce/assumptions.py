"""What a robot file marks as assumed, as directions in which its numbers can be changed."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from tactr.errors import RobotError
from tactr.robot import Robot, Stiffness, Straight, Tendon, Tube
from tactr.statics.parameters import value_of, with_values

DIAMETER, SHARE = 0.05, 0.1
LENGTH, ANGLE = 1e-3, math.radians(5)
SAME = "as above"

Steps = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Assumption:
    """Numbers of a robot that its source does not print, and a change of all of them together.

    fields: as in the robot file. steps: paths and how much is added to each, SI. value, change: in words.
    """

    what: str
    fields: tuple[str, ...]
    reason: str
    value: str
    change: str
    steps: Steps

    def applied(self, robot: Robot, factor: float) -> Robot | None:
        """The robot with `factor` times the change; None where that is no robot."""
        try:
            return with_values(robot, {p: value_of(robot, p) + factor * step for p, step in self.steps})
        except RobotError:
            return None


def assumed_fields(robot: Robot) -> dict[str, str]:
    """Field and reason of everything that the robot's file marks as assumed."""
    split = (remark.partition(": ") for remark in robot.assumed)
    return {name: reason for name, _, reason in split}


def assumptions(robot: Robot, replaced: Mapping[str, str] | None = None) -> tuple[Assumption, ...]:
    """The assumptions on numbers, in the file's order. One whose reason begins "as above" is changed together
    with the one before it. replaced: other reasons, by field."""
    found: list[Assumption] = []
    for name, given in assumed_fields(robot).items():
        reason = (replaced or {}).get(name, given)
        one = _assumption(robot, name, reason)
        if one is None:
            continue
        if reason.startswith(SAME) and found:
            found[-1] = _joined(found[-1], one)
        else:
            found.append(one)
    return tuple(found)


def _joined(first: Assumption, second: Assumption) -> Assumption:
    more = second.reason.removeprefix(SAME).lstrip(";, ")
    value = first.value if first.value == second.value else f"{first.value}; {second.value}"
    return replace(
        first,
        what=f"{first.what}; {second.what}",
        fields=first.fields + second.fields,
        reason=f"{first.reason}; {more}" if more else first.reason,
        value=value,
        steps=first.steps + second.steps,
    )


def _assumption(robot: Robot, name: str, reason: str) -> Assumption | None:
    match = re.fullmatch(r"(tubes|tendons)\[(\d+)\]\.(.+)", name)
    if match is None:
        return None
    group, index, quantity = match[1], int(match[2]), match[3]
    if group == "tubes":
        tube = robot.tubes[index]
        built = _of_tube(robot, tube, quantity)
        what = f"{tube.name} tube: {_words(quantity)}"
    else:
        tendon = robot.tendons[index]
        built = _of_tendon(robot, tendon, quantity)
        what = f"tendon {tendon.name}: {_words(quantity)}".replace("tendon tendon", "tendon")
    return None if built is None else Assumption(what, (name,), reason, *built)


def _words(quantity: str) -> str:
    names = {"routing": "offset", "routing.angle": "angle", "stiffness.GJ": "torsional stiffness"}
    return names.get(quantity, quantity.replace("_", " "))


Built = tuple[str, str, Steps]


def _of_tube(robot: Robot, tube: Tube, quantity: str) -> Built | None:
    path = f"tubes.{tube.name}"
    if quantity.endswith("diameter"):
        if isinstance(tube.section, Stiffness):
            return None  # only drawn
        return _scaled(robot, [f"{path}.section.{quantity}"], DIAMETER, 1e3, "mm")
    if quantity == "length":
        full = f"{path}.length"
        return f"{1e3 * value_of(robot, full):.4g} mm", "± 1 mm", ((full, LENGTH),)
    if quantity.startswith("stiffness"):
        part = quantity.partition(".")[2]
        names = [part] if part else ["EI_x", "EI_y", "GJ", "EA", "GA"]
        return _scaled(robot, [f"{path}.section.{name}" for name in names], SHARE, 1e6, "N mm²", shown=3)
    if quantity == "precurvature":
        paths = [f"{path}.precurvature.0.1.{axis}" for axis in "xyz"]
        return _scaled(robot, paths, SHARE, 1.0, "1/m")
    return None


def _of_tendon(robot: Robot, tendon: Tendon, quantity: str) -> Built | None:
    path, routing = f"tendons.{tendon.name}", tendon.routing
    if quantity == "tension":
        return _scaled(robot, [f"{path}.tension"], SHARE, 1.0, "N")
    if not quantity.startswith("routing"):
        return None
    if not isinstance(routing, Straight):
        return None
    x, y = routing.x, routing.y
    if quantity == "routing.angle":
        steps = ((f"{path}.routing.x", -y * ANGLE), (f"{path}.routing.y", x * ANGLE))
        return f"{math.degrees(math.atan2(y, x)) % 360:.4g}°", "± 5°", steps
    steps = ((f"{path}.routing.x", SHARE * x), (f"{path}.routing.y", SHARE * y))
    return f"{1e3 * math.hypot(x, y):.4g} mm", f"± {100 * SHARE:g} %", steps


def _scaled(robot: Robot, paths: list[str], share: float, unit: float, name: str, *, shown: int = 3) -> Built:
    """All numbers at the paths by the same share of each; the first `shown` of them are printed."""
    values = [value_of(robot, path) for path in paths]
    texts = [f"{unit * value:.5g}" for value in values[:shown] if value] or ["0"]
    steps = tuple((path, share * value) for path, value in zip(paths, values, strict=True) if value)
    return f"{', '.join(texts)} {name}", f"± {100 * share:g} %", steps
