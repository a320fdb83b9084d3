"""Disks that hold tendons outside of the tubes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.robot import Robot, Tendon
from tactr.statics import Shape
from tactr.viewer.frames import quaternions
from tactr.viewer.widths import widest

MOST, RIM, THICKNESS = 16, 1.12, 0.02
"""Disks along the longest tube; their radius over the offset of the tendon; their thickness over it."""


Places = list[tuple[int, float, float]]


@dataclass(frozen=True, repr=False, eq=False)
class Disks:
    """Unit disks to be turned by wxyz (n, 4), scaled by sizes (n, 3) m and moved to position (n, 3) m."""

    position: np.ndarray
    wxyz: np.ndarray
    sizes: np.ndarray


def round_step(length: float) -> float:
    """The shortest of 1, 2 or 5 times a power of ten that is not in a length more than ``MOST`` times, m."""
    least = length / MOST
    power = 10.0 ** np.floor(np.log10(least))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least))


def spacing(robot: Robot) -> float:
    """Distance between disks, m: a round length. Robots differ, and robot files do not say."""
    return round_step(max(tube.length for tube in robot.tubes))


def disk_places(robot: Robot) -> Places:
    """Host tube, arc length s (m) and offset of the outermost tendon (m) of every disk."""
    names, step = [tube.name for tube in robot.tubes], spacing(robot)
    # counted from the tip of the host: its last disk is at its end, and all move with it
    grids = [np.arange(tube.tip, 0.25 * step, -step) for tube in robot.tubes]
    offsets: dict[tuple[int, float], float] = {}
    for tendon in robot.tendons:
        own = names.index(tendon.tube)
        tube = robot.tubes[own]
        reach = tube.tip if tendon.end is None else tube.translation + tendon.end
        for host in {own} if tendon.host == "own" else range(len(names)):
            places = [s for s in grids[host] if s <= reach and host_at(robot, tendon, own, s) == host]
            if not places:
                continue
            sigma = np.array(places) - tube.translation
            for s, offset in zip(places, np.hypot(*tendon.routing.evaluate(sigma)[0].T), strict=True):
                if offset > widest(robot.tubes[host]):
                    offsets[host, s] = max(offsets.get((host, s), 0.0), float(offset))
    return [(host, float(s), offset) for (host, s), offset in sorted(offsets.items())]


def most_disks(robot: Robot) -> int:
    """No more disks than this, wherever the tubes are."""
    return sum(int(tube.length / spacing(robot)) + 1 for tube in robot.tubes) if robot.tendons else 0


def host_at(robot: Robot, tendon: Tendon, own: int, s: float) -> int:
    """Index of the tube that guides a tendon at s (m)."""
    if tendon.host == "own":
        return own
    return next((k for k, tube in enumerate(robot.tubes) if tube.tip >= s - 1e-12), own)


def disks(fine: Shape, places: Places) -> Disks:
    """The disks of a shape sampled at their places or more."""
    count = len(places)
    position, frames = np.zeros((count, 3)), np.zeros((count, 3, 3))
    for k, (host, s, _) in enumerate(places):
        tube = fine.tubes[host]
        at = min(int(np.searchsorted(tube.s, s)), len(tube.s) - 1)
        position[k], frames[k] = tube.position[at], tube.frames[at]
    offset = np.array([offset for *_, offset in places], dtype=float)
    sizes = np.stack([RIM * offset, RIM * offset, THICKNESS * offset], axis=-1)
    return Disks(position, quaternions(frames), sizes)


def unit_disk(sides: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a disk of radius and thickness 1 about the origin, across z."""
    from tactr.viewer.surface import swept_faces, swept_vertices

    position = np.array([[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]])
    frames = np.broadcast_to(np.eye(3), (2, 3, 3))
    vertices = swept_vertices(position, frames, np.ones(2), np.zeros(2), sides)
    return vertices, swept_faces(2, sides)
