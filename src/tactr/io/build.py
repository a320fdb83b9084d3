"""From the data of a robot file to a Robot."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from tactr.errors import RobotError
from tactr.io.build_tube import build_tube, under
from tactr.io.document import DataPath, Document, Problem, ProblemsFound
from tactr.io.fields import Report
from tactr.io.layout import ROBOT
from tactr.robot import (
    DistributedLoad,
    Gravity,
    Helix,
    Load,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Robot,
    Routing,
    Spline,
    Straight,
    Tendon,
    TendonLimits,
    TensionProfile,
)

T = TypeVar("T")


def build(document: Document) -> Robot:
    """The robot that a file describes. Raises ProblemsFound with everything that is wrong with it."""
    problems: list[Problem] = []

    def report(path: DataPath, found: str, expected: str) -> None:
        problems.append(Problem(path, document.line(path), found, expected))

    if document.data is None:
        raise ProblemsFound(Problem((), None, "is empty", "at least a list of tubes"))
    data = ROBOT.read(document.data, (), report)
    spoilt = {problem.path[:2] for problem in problems}

    def parts(kind: str, make: Callable[[Any], T]) -> list[T]:
        places = [(k, entry) for k, entry in enumerate(data.get(kind, ())) if (kind, k) not in spoilt]
        made = [_attempt(partial(make, entry), f"{kind}[{k}]", report) for k, entry in places]
        return [part for part in made if part is not None]

    tubes, tendons, loads = parts("tubes", build_tube), parts("tendons", _tendon), parts("loads", _load)
    assumed = _assumed(data.get("assumed", ()), document, report)
    if not problems:
        texts = {key: data[key] for key in ("name", "description") if key in data}
        robot = _attempt(lambda: Robot(tubes, tendons, loads, assumed=assumed, **texts), "", report)
        if robot is not None:
            return robot
    raise ProblemsFound(*problems)


def _attempt(make: Callable[[], T], prefix: str, report: Report) -> T | None:
    try:
        return make()
    except RobotError as error:
        where = error.under(prefix) if prefix else error
        report(_path(where.field), error.problem, error.expected)
        return None


_PAIRS = {"precurvature": ("from", "u"), "parts": ("from", "routing"), "friction": ("from", "coefficient")}


def _path(field: str) -> DataPath:
    """The place in the file of a field of the Python classes.

    Pairs there are mappings here: "precurvature[0][1]" is "precurvature[0].u".
    """
    path: list[str | int] = []
    for name, index in re.findall(r"([A-Za-z_]+)|\[(\d+)\]", field):
        if name:
            path.append(name)
        elif len(path) > 1 and isinstance(path[-1], int) and path[-2] in _PAIRS:
            path.append(_PAIRS[path[-2]][min(int(index), 1)])
        else:
            path.append(int(index))
    return tuple(path)


def _tendon(data: dict[str, Any]) -> Tendon:
    values = dict(data)
    values["routing"] = under("routing", lambda: _routing(data["routing"]))
    if isinstance(data.get("tension"), dict):
        values["tension"] = under("tension", lambda: TensionProfile(**data["tension"]))
    if "limits" in data:
        values["limits"] = under("limits", lambda: TendonLimits(**data["limits"]))
    if isinstance(data.get("friction"), tuple):
        values["friction"] = [(piece["from"], piece["coefficient"]) for piece in data["friction"]]
    return Tendon(**values)


def _routing(data: dict[str, Any]) -> Routing:
    values = {key: value for key, value in data.items() if key != "kind"}
    if data["kind"] == "straight":
        return Straight.polar(**values) if "radius" in values else Straight(**values)
    if data["kind"] == "helix":
        return Helix.from_pitch(**values) if "pitch" in values else Helix(**values)
    if data["kind"] == "piecewise":
        parts = values["parts"]
        built = [
            under(f"parts[{k}].routing", lambda part=part: _routing(part["routing"]))
            for k, part in enumerate(parts)
        ]
        return Piecewise(tuple((part["from"], routing) for part, routing in zip(parts, built, strict=True)))
    classes = {"polynomial": Polynomial, "polar_polynomial": PolarPolynomial, "spline": Spline}
    return classes[data["kind"]](**values)


def _load(data: dict[str, Any]) -> Load:
    values = {key: value for key, value in data.items() if key != "kind"}
    classes = {"point": PointLoad, "distributed": DistributedLoad, "gravity": Gravity}
    return classes[data["kind"]](**values)


def _assumed(data: Any, document: Document, report: Report) -> tuple[str, ...]:
    """Remarks, or "field: reason" for each entry of a mapping, whose fields have to be there."""
    if not isinstance(data, dict):
        return tuple(data)
    for field in data:
        if not exists(field, document.data):
            report(
                ("assumed", field), "is not a field of this file", "a field such as tubes[0].outer_diameter"
            )
    return tuple(f"{field}: {reason}" for field, reason in data.items())


def exists(field: str, data: Any) -> bool:
    for name, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", field):
        if name and isinstance(data, dict) and name in data:
            data = data[name]
        elif index and isinstance(data, list) and int(index) < len(data):
            data = data[int(index)]
        else:
            return False
    return True
