"""Where tubes rub: places along the overlap of neighbours, and at the guide's exit.

An overlap is cut into cells alike, and the friction torque of what presses along a cell acts at its middle;
two more places at the ends bear what presses there at one point. For a straight tube under an even contact
force the twist between base and tip at a given torque is then off by at most 1/(4 cells^2) of its largest
value.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.robot import Robot
from tactr.robot.tube_friction import contact_lever, contact_radius

CELLS = 8  # of one overlap
LEAST_OVERLAP = 1e-9  # m
GUIDE = -1


@dataclass(frozen=True, eq=False)
class Overlap:
    """Two neighbours (inner, outer: tubes by number, GUIDE) and the s where they rub, (k,), m; arm: contact
    radius times coefficient, radius and lever: m."""

    inner: int
    outer: int
    s: np.ndarray
    arm: float
    radius: float
    lever: float


def overlaps(robot: Robot, translation: np.ndarray, cells: int) -> list[Overlap]:
    """Where there is friction, outermost first."""
    found = []
    tips = [float(z) + tube.length for z, tube in zip(translation, robot.tubes, strict=True)]
    for i, tube in enumerate(robot.tubes):
        friction = tube.friction
        if friction is None or friction.coefficient == 0.0:
            continue
        radius = contact_radius(friction, tube.outer_diameter)
        lever = contact_lever(friction, tube.outer_diameter)
        for outer, s in _places(i, tips, cells):
            found.append(Overlap(i, outer, s, friction.coefficient * radius, radius, lever))
    return found


def _places(i: int, tips: list[float], cells: int) -> list[tuple[int, np.ndarray]]:
    """The next outer bodies of tube i, and the places along each."""
    if i == 0:
        return [(GUIDE, np.zeros(1))]
    found, start = [], 0.0
    for outer in range(i - 1, -1, -1):
        end = min(tips[outer], tips[i])
        if end - start > LEAST_OVERLAP:
            middles = (np.arange(cells) + 0.5) / cells
            found.append((outer, start + (end - start) * np.concatenate([[0.0], middles, [1.0]])))
        start = max(start, tips[outer])
    return found
