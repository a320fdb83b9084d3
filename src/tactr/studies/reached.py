"""The volume that tips reach, by counting cubes; how far samples and cubes decide it.

Reached is the union of the cubes (voxels) of a grid that hold a tip. A hull would call the hole of a ring
reached. The volume grows with the number of samples until every cube that can be reached is hit, and shrinks
with the edge of the cubes, because those at the rim count whole: by about half an edge times the surface.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

BITS = 21  # of a voxel's index along each axis
PER_VOXEL = 5.0  # tips in a voxel on average, where its edge is chosen
FINEST, COARSEST = 200, 8  # edges along the longest side that are tried
STEPS = (1, 1.5, 2, 3, 4, 5, 6, 8)
LEAST_DIMENSION = 2.25  # the rim of a volume takes off some of its three; a surface has two


@dataclass(frozen=True)
class Reached:
    """voxel: edge, m. volume: m^3, of voxels with a tip; voxels, tips: how many. half: volume by half the
    samples. coarse: volume by voxels of twice the edge. unseen: chance that one more random sample falls in
    a voxel without a tip (Good and Turing's estimate: voxels hit once over tips; Good, Biometrika 40, 1953).
    """

    voxel: float
    volume: float
    voxels: int
    tips: int
    half: float
    coarse: float
    unseen: float

    @property
    def dimension(self) -> float:
        """Of the set of tips, from both edges (box counting): 3 for a volume, 2 for a surface."""
        return 3.0 - float(np.log2(self.coarse / self.volume)) if self.volume else 0.0

    @property
    def is_a_volume(self) -> bool:
        """Whether the tips fill a volume at this edge; else the number means nothing."""
        return self.dimension > LEAST_DIMENSION


def reached(blocks: Iterable[tuple[np.ndarray, np.ndarray]], voxel: float) -> Reached:
    """Volume that tips reach. blocks: tips (k, 3) m, and which of them belong to half the samples, (k,)."""
    keys, hits, halves = (np.empty(0, dtype=np.int64) for _ in range(3))
    tips = 0
    for points, in_half in blocks:
        tips += len(points)
        found, number = np.unique(_keys(points, voxel), return_counts=True)
        keys, place = np.unique(np.concatenate([keys, found]), return_inverse=True)
        hits = np.bincount(place, np.concatenate([hits, number]), len(keys)).astype(np.int64)
        halves = np.union1d(halves, _keys(points[in_half], voxel))
    volume = voxel**3
    coarse = len(np.unique(_halved(keys))) * 8 * volume
    once = int((hits == 1).sum())
    unseen = once / tips if tips else 1.0
    return Reached(voxel, len(keys) * volume, len(keys), tips, len(halves) * volume, coarse, unseen)


def good_voxel(points: np.ndarray) -> float:
    """The smallest round edge, m, at which a voxel holds PER_VOXEL tips (k, 3) on average; at most about an
    eighth of the longest side."""
    longest = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if longest == 0.0:
        return 1e-3
    exponent = np.floor(np.log10(longest / FINEST))
    edges = [float(f"{step}e{int(exponent) + up}") for up in range(3) for step in STEPS]
    edges = [edge for edge in edges if longest / FINEST <= edge <= longest / COARSEST * 1.5]
    for edge in edges:
        if len(points) >= PER_VOXEL * len(np.unique(_keys(points, edge))):
            return edge
    return edges[-1]


def _keys(points: np.ndarray, voxel: float) -> np.ndarray:
    index = np.floor(points / voxel).astype(np.int64) + (1 << (BITS - 1))
    return (index[:, 0] << (2 * BITS)) | (index[:, 1] << BITS) | index[:, 2]


def _halved(keys: np.ndarray) -> np.ndarray:
    """Keys of the voxels of twice the edge that hold these."""
    mask = (1 << BITS) - 1
    x, y, z = keys >> (2 * BITS), (keys >> BITS) & mask, keys & mask
    return ((x >> 1) << (2 * BITS)) | ((y >> 1) << BITS) | (z >> 1)
