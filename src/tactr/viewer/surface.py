"""Swept surfaces: the wall of a tube along its centreline, as vertices and triangles."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np

SIDES = 20
"""Corners of a circle."""


def swept_vertices(
    position: np.ndarray, frames: np.ndarray, outer: np.ndarray, inner: np.ndarray, sides: int = SIDES
) -> np.ndarray:
    """Vertices (4 k sides, 3) of a closed wall round a centreline, in its unit; `swept_faces` joins them.

    position (k, 3); frames (k, 3, 3), columns d1, d2, d3; outer, inner (k,) radii, inner 0 for a rod. Rings
    of the outside, of the bore, of the near end, then those of the far end: ends have vertices of their own,
    so that their edges are shaded as edges.
    """
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    circle = np.stack([np.cos(angle), np.sin(angle)])  # (2, sides)
    spokes = np.einsum("kab,bj->kja", frames[..., :2], circle)
    outside = position[:, None] + outer[:, None, None] * spokes
    bore = position[:, None] + inner[:, None, None] * spokes
    ends = [outside[:1], bore[:1], outside[-1:], bore[-1:]]
    return np.concatenate([outside, bore, *ends]).reshape(-1, 3)


def vertex_count(stations: int, sides: int = SIDES) -> int:
    """How many vertices a wall with so many stations has."""
    return (2 * stations + 4) * sides


@cache
def swept_faces(stations: int, sides: int = SIDES) -> np.ndarray:
    """Triangles (n, 3) of a wall with so many stations, seen from without counter-clockwise."""
    outside = np.arange(stations * sides).reshape(stations, sides)
    bore = outside + stations * sides
    near_out, near_in, far_out, far_in = 2 * stations * sides + np.arange(4 * sides).reshape(4, sides)
    strips = [*pairwise(outside), *((high, low) for low, high in pairwise(bore))]
    strips += [(near_in, near_out), (far_out, far_in)]
    faces = np.concatenate([_strip(low, high) for low, high in strips]).astype(np.uint32)
    faces.setflags(write=False)
    return faces


def _strip(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Triangles between two rings."""
    low_next, high_next = np.roll(low, -1), np.roll(high, -1)
    return np.concatenate(
        [np.stack([low, low_next, high], axis=1), np.stack([high, low_next, high_next], axis=1)]
    )
