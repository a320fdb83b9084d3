"""What actuators are given and pass on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import dist

import numpy as np

from tactr.friction.play import passed_on
from tactr.robot import Robot
from tactr.statics.path import PathPoints

FIELDS = ("tension", "rotation", "translation", "displacement")


@dataclass(frozen=True, eq=False)
class Actuators:
    """What actuators are given: tension (tendons,), rotation, translation (tubes,), displacement (tendons,),
    NaN where there is none."""

    tension: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    displacement: np.ndarray

    @staticmethod
    def along(points: PathPoints) -> list[Actuators]:
        """At every point of a path."""
        rows = zip(points.tension, points.rotation, points.translation, points.displacement, strict=True)
        return [Actuators(*row) for row in rows]

    @staticmethod
    def numbers(points: PathPoints) -> np.ndarray:
        """All numbers at every point of a path, as ``flat``."""
        rows = points.tension, points.rotation, points.translation, points.displacement
        return np.nan_to_num(np.hstack(rows))

    def towards(self, other: Actuators, part: float) -> Actuators:
        """Part of the way to another."""
        if part == 1.0:
            return other
        pairs = zip(self._all(), other._all(), strict=True)
        return Actuators(*((1.0 - part) * a + part * b for a, b in pairs))

    def through(self, plays: Plays, before: Actuators) -> Actuators:
        """What the plays pass on; before: what they did."""
        if not plays.any:
            return self
        return Actuators(
            self.tension,
            passed_on(before.rotation, self.rotation, plays.rotation),
            np.minimum(passed_on(before.translation, self.translation, plays.translation), 0.0),
            passed_on(before.displacement, self.displacement, plays.displacement),
        )

    def moved(self, translation: np.ndarray) -> Actuators:
        """With other translations (tubes,)."""
        return Actuators(self.tension, self.rotation, translation, self.displacement)

    def at_zero(self) -> Actuators:
        """Nothing given, by the same kinds of actuation."""
        return Actuators(*(0.0 * values for values in self._all()))

    @cached_property
    def flat(self) -> list[float]:
        """All numbers; 0 where there is none."""
        return [0.0 if x != x else x for values in self._all() for x in values.tolist()]

    def distance(self, other: Actuators) -> float:
        """Of all numbers as they are, whatever their units: to compare ways of one kind."""
        return dist(self.flat, other.flat)

    def to_dict(self) -> dict[str, list[float]]:
        """Plain lists."""
        return {name: getattr(self, name).tolist() for name in FIELDS}

    @staticmethod
    def from_dict(data: dict[str, list[float]]) -> Actuators:
        """What ``to_dict`` wrote."""
        return Actuators(*(np.array(data[name], dtype=float) for name in FIELDS))

    def _all(self) -> tuple[np.ndarray, ...]:
        return self.tension, self.rotation, self.translation, self.displacement


@dataclass(frozen=True, eq=False)
class Plays:
    """Whole widths: displacement (tendons,) m, rotation (tubes,) rad, translation (tubes,) m."""

    displacement: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray

    @cached_property
    def any(self) -> bool:
        """Whether there is any backlash."""
        return any(widths.any() for widths in (self.displacement, self.rotation, self.translation))

    @staticmethod
    def of(robot: Robot) -> Plays:
        return Plays(
            np.array([t.play for t in robot.tendons], dtype=float),
            np.array([t.rotation_play for t in robot.tubes]),
            np.array([t.translation_play for t in robot.tubes]),
        )
