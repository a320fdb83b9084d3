"""How thick tubes are drawn."""

from __future__ import annotations

import numpy as np

from tactr.robot import Robot, Tube

UNKNOWN_SHARE, UNKNOWN_STEP, UNKNOWN_BORE = 0.004, 0.5, 0.7


def radii(robot: Robot, index: int, sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Outer and inner radius (k,) of a tube at its arc lengths sigma (k,), all in m.

    A tube without an outer diameter is drawn as thick as a share of the robot's length, thicker the further
    out it is; without a bore, as a pipe with a wall of three tenths of that.
    """
    tube = robot.tubes[index]
    ends = np.array([part.end for part in tube.parts[:-1]])
    part = np.searchsorted(ends, sigma, side="left")
    fallback = _unknown_radius(robot, index)
    outer = np.array([_half(p.section.outer_diameter, fallback) for p in tube.parts])
    inner = np.array(
        [
            _half(p.section.inner_diameter, UNKNOWN_BORE * width)
            for p, width in zip(tube.parts, outer, strict=True)
        ]
    )
    return outer[part], inner[part]


def unknown_diameters(robot: Robot) -> tuple[str, ...]:
    """Names of the tubes whose diameter is not known everywhere."""
    return tuple(tube.name for tube in robot.tubes if tube.outer_diameter is None)


def widest(tube: Tube) -> float:
    """Largest outer radius of a tube, m; 0 where it is not known."""
    return 0.5 * (tube.outer_diameter or 0.0)


def holds_tendons(robot: Robot, index: int) -> bool:
    """Whether a tendon runs inside a tube: its end lies within the tube's outside, on it or on one in it."""
    inside = {tube.name: tube for tube in robot.tubes[index:]}
    radius = widest(robot.tubes[index])
    return any(
        float(np.hypot(*tendon.routing.r(tendon.end or inside[tendon.tube].length))) < radius
        for tendon in robot.tendons
        if tendon.tube in inside
    )


def _unknown_radius(robot: Robot, index: int) -> float:
    longest = max(tube.length for tube in robot.tubes)
    further_in = len(robot.tubes) - 1 - index
    return UNKNOWN_SHARE * longest * (1.0 + UNKNOWN_STEP * further_in)


def _half(diameter: float | None, fallback: float) -> float:
    return fallback if diameter is None else 0.5 * diameter
