"""External loads as arrows."""

from __future__ import annotations

import numpy as np

from tactr.robot import DistributedLoad, Gravity, PointLoad, Robot
from tactr.statics import Shape

FORCE_COLOUR, MOMENT_COLOUR, WEIGHT_COLOUR = (204, 0, 119), (120, 60, 190), (90, 90, 90)
PER_LOAD = 8
"""Arrows along a distributed load."""


def load_arrows(shape: Shape, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Arrows (n, 2, 3) m, from tail to head, and their colours (n, 3); a force's head is where it acts.

    length: of the longest, m; the others of their kind in proportion to their size. Gravity is one arrow at
    the middle of the robot.
    """
    found: list[tuple[np.ndarray, np.ndarray, tuple[int, int, int], str]] = []
    for load in shape.robot.loads:
        if isinstance(load, PointLoad):
            at, frame = _place(shape, load.tube, load.at)
            turn = frame if load.axes == "body" else np.eye(3)
            found.append((at, turn @ np.array(load.force), FORCE_COLOUR, "force"))
            found.append((at, turn @ np.array(load.moment), MOMENT_COLOUR, "moment"))
        elif isinstance(load, DistributedLoad):
            found += _distributed(shape, load)
        elif isinstance(load, Gravity):
            middle = shape.centreline[len(shape.centreline) // 2]
            found.append((middle, np.array(load.acceleration), WEIGHT_COLOUR, "weight"))
    found = [entry for entry in found if np.linalg.norm(entry[1]) > 0.0]
    largest: dict[str, float] = {}
    for _, vector, _, kind in found:
        largest[kind] = max(largest.get(kind, 0.0), float(np.linalg.norm(vector)))
    arrows = [(at - length * vector / largest[kind], at) for at, vector, _, kind in found]
    colours = [colour for *_, colour, _ in found]
    return np.array(arrows).reshape(-1, 2, 3), np.array(colours, dtype=np.uint8).reshape(-1, 3)


def load_places(robot: Robot) -> list[float]:
    """Arc lengths s (m) at which ``load_arrows`` reads a shape."""
    points = [load for load in robot.loads if isinstance(load, PointLoad)]
    places = [robot.tube(load.tube).translation + load.at for load in points if load.at is not None]
    for load in robot.loads:
        if isinstance(load, DistributedLoad):
            places += _spread(robot, load).tolist()
    return [place for place in places if place >= 0.0]


def _spread(robot: Robot, load: DistributedLoad) -> np.ndarray:
    """Arc lengths s (m) of the arrows of a distributed load, on the part of it outside the guide."""
    if load.tube is None:
        start, most, offset = load.start, max(tube.tip for tube in robot.tubes), 0.0
    else:
        tube = robot.tube(load.tube)
        start, most, offset = load.start, tube.length, tube.translation
    end = (most if load.end is None else min(load.end, most)) + offset
    return np.linspace(max(start + offset, 0.0), end, PER_LOAD) if end > 0.0 else np.empty(0)


def _place(shape: Shape, name: str, at: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Position and material frame of a tube at its own arc length, its tip where None."""
    tubes = shape.robot.tubes
    index = [tube.name for tube in tubes].index(name)
    own = shape.tubes[index]
    sigma = tubes[index].length if at is None else at
    k = int(np.argmin(np.abs(own.sigma - sigma)))
    return own.position[k], own.frames[k]


def _distributed(shape: Shape, load: DistributedLoad) -> list:
    tubes = shape.robot.tubes
    entries = []
    for place in _spread(shape.robot, load):
        present = next(tube for tube in tubes if tube.tip >= place - 1e-9)
        tube = present if load.tube is None else shape.robot.tube(load.tube)
        at, frame = _place(shape, tube.name, place - tube.translation)
        turn = frame if load.axes == "body" else np.eye(3)
        entries.append((at, turn @ np.array(load.force), FORCE_COLOUR, "force per length"))
        entries.append((at, turn @ np.array(load.moment), MOMENT_COLOUR, "moment per length"))
    return entries
