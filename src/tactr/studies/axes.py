"""What a study varies: numbers of the robot by their path, over a range or a list of values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot import _check as check
from tactr.robot._bores import Misfit
from tactr.statics.parameters import place_of, value_of, with_value
from tactr.studies.unit_samples import METHODS

ACTUATORS = {"tension": "tendons", "displacement": "tendons", "rotation": "tubes", "translation": "tubes"}
MOST_VALUES = 10_000
MOST_SAMPLES = 2**30  # that 30 bits of Sobol's sequence tell apart


@dataclass(frozen=True)
class Range:
    """A number of the robot sampled between low and high, SI units; path as in ``Shape.sensitivity``."""

    path: str
    low: float
    high: float

    def __post_init__(self) -> None:
        with check.owned(f"Range {self.path!r}"):
            check.store(self, path=check.name("path", self.path))
            check.store(self, low=check.real("low", self.low), high=check.real("high", self.high))
            if not self.low < self.high:
                raise RobotError(
                    "high", f"{self.high:g} is not above {self.low:g}", "low below high", value=self.high
                )

    @property
    def ends(self) -> tuple[float, float]:
        """Least and most."""
        return self.low, self.high


@dataclass(frozen=True)
class Values:
    """A number of the robot that takes each of these values, SI units: one direction of a grid."""

    path: str
    values: tuple[float, ...]

    if TYPE_CHECKING:

        def __init__(self, path: str, values: Sequence[float]) -> None: ...

    def __post_init__(self) -> None:
        with check.owned(f"Values {self.path!r}"):
            check.store(self, path=check.name("path", self.path))
            check.store(self, values=tuple(check.numbers("values", self.values, fewest=1, most=MOST_VALUES)))

    @property
    def ends(self) -> tuple[float, float]:
        """Least and most."""
        return min(self.values), max(self.values)


Axis = Range | Values


@dataclass(frozen=True)
class Samples:
    """How ranges are sampled: count samples of all ranges together, by "sobol" (scrambled), "random" or
    "latin_hypercube"; the same seed gives the same samples."""

    count: int
    _: KW_ONLY
    method: str = "sobol"
    seed: int = 0

    def __post_init__(self) -> None:
        whole("count", self.count, 1, MOST_SAMPLES)
        whole("seed", self.seed, 0, 2**48)
        check.choice("method", self.method, METHODS)


def whole(field: str, value: object, least: int, most: int) -> None:
    """Refuse what is no whole number within these."""
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        expected = f"a whole number from {least} to {most}"
        raise RobotError(field, f"found {check.show(value)}", expected, value=value)


def actuator(robot: Robot, path: str) -> tuple[str, int] | None:
    """("rotation", index of the tube) and the like for the path of an actuator; None for any other path."""
    place = place_of(robot, path)
    return place[1:] if place is not None and ACTUATORS.get(place[1]) == place[0] else None


def check_path(robot: Robot, path: str) -> None:
    """Raise RobotError unless the robot has such a number."""
    if actuator(robot, path) is None:
        try:
            value_of(robot, path)
        except RobotError as error:
            raise RobotError("path", error.problem, error.expected, value=path) from None


def check_axis(robot: Robot, axis: Axis) -> None:
    """Raise RobotError, about low, high or values[k], unless the robot can have every value."""
    check_path(robot, axis.path)
    found = actuator(robot, axis.path)
    for field, value in _entries(axis):
        try:
            _moved(robot, axis.path, value)
        except RobotError as error:
            if isinstance(error, Misfit) and found is not None:
                continue  # stepped tubes: where the others are then decides
            raise RobotError(field, error.problem, error.expected, value=value) from None


def _entries(axis: Axis) -> list[tuple[str, float]]:
    if isinstance(axis, Range):
        return [("low", axis.low), ("high", axis.high)]
    return [(f"values[{k}]", value) for k, value in enumerate(axis.values)]


def _moved(robot: Robot, path: str, value: float) -> Robot:
    found = actuator(robot, path)
    if found is None:
        return with_value(robot, path, value)
    field, index = found
    name = getattr(robot, ACTUATORS[field])[index].name
    return robot.with_actuation(**{field: {name: value}})
