"""The tubes of a shape as walls: nested parts, in which another tube runs, apart from bare ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.robot import Robot
from tactr.statics import Shape
from tactr.viewer.surface import swept_vertices
from tactr.viewer.widths import radii

STATIONS = 48
"""Of every part of a tube: always as many, so that only vertices change when the robot moves."""


@dataclass(frozen=True, repr=False, eq=False)
class Wall:
    """A part of a tube: vertices (n, 3) m in world axes, joined by ``swept_faces(STATIONS)``; None where the
    tube has no such part.

    tube: its index; nested: whether another tube runs inside.
    """

    tube: int
    nested: bool
    vertices: np.ndarray | None


def spans(robot: Robot) -> list[tuple[float, float, float]]:
    """Arc lengths s (m) of every tube: where it starts, where its nested part ends and where it ends."""
    tips = [tube.tip for tube in robot.tubes]
    return [(0.0, min(tip, max([0.0, *tips[k + 1 :]])), tip) for k, tip in enumerate(tips)]


def wall_stations(robot: Robot) -> np.ndarray:
    """All arc lengths (k,), ascending, m, that ``walls`` reads."""
    ends = [part for span in spans(robot) for part in (span[:2], span[1:]) if part[0] < part[1]]
    return np.unique(np.concatenate([np.linspace(*part, STATIONS) for part in ends]))


def walls(fine: Shape, scale: float = 1.0) -> list[Wall]:
    """The walls of a shape sampled at ``wall_stations`` or more; scale: of the diameters."""
    made = []
    for k, (start, nested, tip) in enumerate(spans(fine.robot)):
        made.append(_wall(fine, k, start, nested, True, scale))
        made.append(_wall(fine, k, nested, tip, False, scale))
    return made


def _wall(fine: Shape, k: int, start: float, end: float, nested: bool, scale: float) -> Wall:
    if not end > start:
        return Wall(k, nested, None)
    tube = fine.tubes[k]
    s = np.linspace(start, end, STATIONS)
    at = np.searchsorted(tube.s, s).clip(max=len(tube.s) - 1)
    outer, inner = radii(fine.robot, k, tube.sigma[at])
    vertices = swept_vertices(tube.position[at], tube.frames[at], scale * outer, scale * inner)
    return Wall(k, nested, vertices)
