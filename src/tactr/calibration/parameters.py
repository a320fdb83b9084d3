"""What is free in a calibration: numbers of the robot, zeros of its motors, the marker and the sensor."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, fields, is_dataclass
from difflib import get_close_matches
from typing import Any

from tactr.calibration.frame import Frame
from tactr.errors import RobotError
from tactr.io.path_kinds import kind_of, last_word
from tactr.io.unit_table import Kind
from tactr.robot import Robot
from tactr.robot import _check as check
from tactr.statics.parameters import value_of

FRAME = (
    "marker.x",
    "marker.y",
    "marker.z",
    "sensor.x",
    "sensor.y",
    "sensor.z",
    "sensor.rx",
    "sensor.ry",
    "sensor.rz",
)
ZERO = "zero"
LEAST_SCALE = {
    "length": 1e-2,
    "angle": 0.3,
    "force": 1.0,
    "compliance": 1e-4,
    "torsional compliance": 1.0,
    "curvature": 1.0,
    "number": 0.1,
}
LEAST_SCALE_OF_PLAY = {"play": 1e-3, "translation_play": 1e-3, "rotation_play": 0.05}
NEVER_NEGATIVE = (
    "compliance", "pretension", "radius", "tension", "nu", "friction", "coefficient", "play", "rotation_play",
    "translation_play", "rotation_compliance", "translation_compliance",
)  # fmt: skip
POSITIVE = (
    "E", "G", "density", "linear_density", "EI_x", "EI_y", "GJ", "EA", "GA", "length", "rest_length", "end",
    "diameter", "outer_diameter",
)  # fmt: skip


@dataclass(frozen=True)
class Parameter:
    """One thing that a calibration may change.

    path: of a number of the robot, as in ``Shape.sensitivity`` ("tubes.outer.material.E", for short
    "tubes.outer.E"); "tendons.NAME.zero" (m, what the motor has pulled where its reading is 0; negative:
    slack); "marker.x" (m, of the tip's marker from the tip, in its material frame; also y, z); "sensor.x" (m,
    where the robot's origin is in the sensor's axes; also y, z) and "sensor.rx" (rad, rotation vector from
    the robot's axes to the sensor's; also ry, rz). * stands for any name or step, [abc] for one of these
    characters: one parameter for each that fits or, with ``common``, one number for all. start: where the
    search begins, None: where the robot is. lower, upper: bounds. prior: mean and standard deviation of what
    is known of it beforehand. scale: how much of it matters; a standard error beyond says that the data do
    not see it; None: its value, or what is usual for its kind. All in SI units. Raises RobotError.
    """

    path: str
    _: KW_ONLY
    common: bool = False
    start: float | None = None
    lower: float = -math.inf
    upper: float = math.inf
    prior: tuple[float, float] | None = None
    scale: float | None = None

    def __post_init__(self) -> None:
        with check.owned(f"Parameter {self.path!r}"):
            check.store(self, path=check.name("path", self.path))
            if not self.lower < self.upper:
                raise RobotError("lower", f"{self.lower:g} is not below the upper bound {self.upper:g}")
            if self.start is not None and not self.lower <= check.real("start", self.start) <= self.upper:
                raise RobotError("start", f"{self.start:g}", f"within {self.lower:g} to {self.upper:g}")
            if self.prior is not None:
                mean, deviation = check.numbers("prior", self.prior, fewest=2, most=2)
                check.real("prior[1]", deviation, above=0)
                check.store(self, prior=(mean, deviation))
            if self.scale is not None:
                check.real("scale", self.scale, above=0)


@dataclass(frozen=True)
class Free:
    """A parameter made ready: name; paths of the numbers it is; start, bounds, prior, scale; kind."""

    name: str
    paths: tuple[str, ...]
    start: float
    lower: float
    upper: float
    prior: tuple[float, float] | None
    scale: float
    kind: Kind


def expanded(
    robot: Robot,
    parameters: Sequence[str | Parameter],
    measured: Sequence[str],
    frame: Frame | None = None,
) -> tuple[Free, ...]:
    """Every free number. measured: tendons whose displacement was measured; frame: where marker and sensor
    start. Raises RobotError."""
    known = known_paths(robot, measured)
    frees: list[Free] = []
    for given in parameters:
        parameter = Parameter(given) if isinstance(given, str) else given
        if not isinstance(parameter, Parameter):
            raise RobotError("parameters", f"{given!r}", "paths or Parameter objects", value=given)
        paths = _matching(robot, parameter.path, known)
        groups = [tuple(paths)] if parameter.common else [(path,) for path in paths]
        frees += [_free(robot, frame or Frame(), parameter, group) for group in groups]
    seen = [path for free in frees for path in free.paths]
    for path in seen:
        if seen.count(path) > 1:
            raise RobotError("parameters", f"{path} is free twice", "each once", value=path)
    return tuple(frees)


def _matching(robot: Robot, path: str, known: list[str]) -> list[str]:
    short = f"{path[:-2]}.material{path[-2:]}" if path.endswith((".E", ".G")) else path
    for each in (path, short):
        found = [candidate for candidate in known if fnmatch.fnmatchcase(candidate, each)]
        if found:
            return found
    if path.endswith(f".{ZERO}"):
        found = "only tendons whose displacement is measured have a zero"
        raise RobotError("parameters", f"{path!r}: {found}", 'columns "displacement.NAME [mm]"', value=path)
    near = get_close_matches(short, known, n=5, cutoff=0.6)
    near = near or [candidate for candidate in known if candidate.startswith(path.partition(".")[0])] or known
    shown = ", ".join(repr(candidate) for candidate in near[:10]) + (", ..." if len(near) > 10 else "")
    raise RobotError("parameters", f"nothing of the robot is called {path!r}", f"such as {shown}", value=path)


def known_paths(robot: Robot, measured: Sequence[str]) -> list[str]:
    """All that can be free. measured: tendons whose displacement was measured."""
    paths: list[str] = []
    for group in ("tubes", "tendons", "loads"):
        members = getattr(robot, group)
        for k, member in enumerate(members):
            _walk(member, f"{group}.{getattr(member, 'name', k)}", paths)
    return [*paths, *(f"tendons.{name}.{ZERO}" for name in measured), *FRAME]


def _walk(owner: Any, path: str, paths: list[str]) -> None:
    if isinstance(owner, bool) or owner is None or isinstance(owner, str):
        return
    if isinstance(owner, int | float):
        if not path.endswith((".displacement", ".at")):
            paths.append(path)
    elif isinstance(owner, tuple):
        plain = len(owner) == 3 and all(isinstance(item, int | float) for item in owner)
        for k, item in enumerate(owner):
            _walk(item, f"{path}.{'xyz'[k] if plain else k}", paths)
    elif is_dataclass(owner):
        for f in fields(owner):
            if f.init:
                _walk(getattr(owner, f.name), f"{path}.{f.name}", paths)


def _free(robot: Robot, frame: Frame, parameter: Parameter, paths: Sequence[str]) -> Free:
    name = parameter.path if len(paths) > 1 else paths[0]
    kind, last = kind_of(robot, paths[0]), last_word(paths[0])
    values = [_value(robot, frame, path) for path in paths]
    start = parameter.start if parameter.start is not None else sum(values) / len(values)
    lower, upper = parameter.lower, parameter.upper
    if last in NEVER_NEGATIVE and paths[0] not in FRAME:
        lower = max(lower, 0.0)
    if last in POSITIVE:
        lower = max(lower, 1e-3 * abs(start))
    if last == "nu":
        upper = min(upper, 0.5)
    if not lower <= start <= upper:
        raise RobotError(
            name, f"it starts at {start:g}", f"a start within {lower:g} to {upper:g}", value=start
        )
    scale = parameter.scale
    if scale is None:
        least = LEAST_SCALE_OF_PLAY.get(last, LEAST_SCALE.get(kind.name, 0.0))
        scale = max(abs(start), least) or 1.0
        if parameter.prior is not None:
            scale = max(scale, parameter.prior[1])
    return Free(name, tuple(paths), start, lower, upper, parameter.prior, scale, kind)


def _value(robot: Robot, frame: Frame, path: str) -> float:
    if path in FRAME:
        return getattr(frame, vector_of(path))["xyz".index(path[-1])]
    return 0.0 if path.endswith(f".{ZERO}") else value_of(robot, path)


def vector_of(path: str) -> str:
    """The field of a Frame that a path of it is in."""
    return (
        "marker" if path.startswith("marker") else "rotation" if path.startswith("sensor.r") else "position"
    )
