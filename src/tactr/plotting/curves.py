"""What of a shape is drawn: curves in mm with their style, the same for every view."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.plotting.palette import mixed, tube_colour

if TYPE_CHECKING:
    from tactr.robot import Robot, Tendon
    from tactr.statics import Shape

THINNEST, STEP = 2.6, 3.2
MOST_TENDONS_NAMED = 4


@dataclass(frozen=True)
class Curve:
    """A line through points (k, 3) in mm, and how it looks."""

    points: np.ndarray
    colour: str
    width: float
    label: str


@dataclass(frozen=True)
class Drawing:
    """All that a picture shows; marks (k, 3) in mm are the transition points, ends (k, 3) where tendons are
    fixed."""

    tubes: tuple[Curve, ...]
    tendons: tuple[Curve, ...]
    marks: np.ndarray
    ends: np.ndarray
    tip: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """Every point drawn, (k, 3) in mm."""
        return np.concatenate([curve.points for curve in (*self.tubes, *self.tendons) if len(curve.points)])


def drawing(shape: Shape) -> Drawing:
    """The curves of a shape. Raises NotConverged."""
    robot = shape.robot
    fine = shape.sample(_stations(shape))
    tubes = tuple(
        Curve(1e3 * tube.position, _tube_colour(k, len(robot.tubes)), width, tube.name)
        for k, (tube, width) in enumerate(zip(fine.tubes, _widths(len(robot.tubes)), strict=True))
    )
    tendons = tuple(
        Curve(1e3 * drawn.path, _tendon_colour(robot, tendon), 1.1, _tendon_label(robot, tendon, k))
        for k, (drawn, tendon) in enumerate(zip(fine.tendons, robot.tendons, strict=True))
    )
    ends = np.array([curve.points[-1] for curve in tendons if len(curve.points)]).reshape(-1, 3)
    return Drawing(
        tubes, tendons, 1e3 * shape.transition_points[0].reshape(-1, 3), ends, 1e3 * shape.tip_position
    )


def _stations(shape: Shape) -> np.ndarray:
    """Even stations and every place where something ends, so that no line stops short of its end."""
    robot = shape.robot
    length = max(tube.tip for tube in robot.tubes)
    ends = [tube.tip for tube in robot.tubes]
    for tendon in robot.tendons:
        tube = robot.tube(tendon.tube)
        ends.append(tube.tip if tendon.end is None else tube.translation + tendon.end)
    inside = [end for end in ends if 0 < end <= length]
    return np.unique(np.concatenate([np.linspace(0.0, length, 201), inside]))


def _widths(count: int) -> list[float]:
    """Line widths in points that nest like the tubes do; their diameters in true scale would be hairlines."""
    return [THINNEST + STEP * (count - 1 - k) for k in range(count)]


def _tube_colour(index: int, count: int) -> str:
    # Paler, not transparent: colours that shine through each other are hard to tell apart.
    return mixed(tube_colour(index), "#ffffff", 0.35 if index < count - 1 else 0.0)


def _tendon_colour(robot: Robot, tendon: Tendon) -> str:
    index = [tube.name for tube in robot.tubes].index(tendon.tube)
    return mixed(tube_colour(index), "#000000", 0.25)


def _tendon_label(robot: Robot, tendon: Tendon, k: int) -> str:
    if len(robot.tendons) > MOST_TENDONS_NAMED:
        return "tendons" if k == 0 else ""
    tension = tendon.tension
    name = tendon.name if "tendon" in tendon.name.lower() else f"tendon {tendon.name}"
    return name + (f", {tension:g} N" if isinstance(tension, (int, float)) else "")
