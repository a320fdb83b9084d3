"""Tendons as coloured lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.statics import TendonShape
from tactr.viewer.tension_colours import tension_colours

SAME_PLACE = 1e-5  # m


@dataclass(frozen=True, repr=False, eq=False)
class Thread:
    """A tendon: segments (n, 2, 3) m along its path and their colours (n, 2, 3) by tension."""

    segments: np.ndarray
    colours: np.ndarray


def threads(tendons: Sequence[TendonShape], most: float) -> list[Thread]:
    """The threads of tendons read at the same arc lengths; most: the tension of the darkest, N.

    Where several run in one place, only the tightest is drawn: lines in one place would hide each other at
    random.
    """
    hidden = _hidden(tendons)
    return [_thread(tendon, away, most) for tendon, away in zip(tendons, hidden, strict=True)]


def _hidden(tendons: Sequence[TendonShape]) -> list[np.ndarray]:
    """Of every tendon, where (k,) a tighter one runs in the same place; of equals, the first is seen."""
    count, longest = len(tendons), max((len(tendon.s) for tendon in tendons), default=0)
    path, tension = np.full((3, count, longest), np.nan), np.zeros((count, longest))
    for k, tendon in enumerate(tendons):
        path[:, k, : len(tendon.s)], tension[k, : len(tendon.s)] = tendon.path.T, tendon.tension
    x, y, z = np.abs(path[:, :, None] - path[:, None]) < SAME_PLACE
    more = tension - tension[:, None]
    earlier = np.tri(count, k=-1, dtype=bool)[:, :, None]
    hidden = (x & y & z & ((more > 0.0) | ((more == 0.0) & earlier))).any(axis=1)
    return [hidden[k, : len(tendon.s)] for k, tendon in enumerate(tendons)]


def _thread(tendon: TendonShape, hidden: np.ndarray, most: float) -> Thread:
    colours, path = tension_colours(tendon.tension, most), tendon.path
    seen = ~(hidden[:-1] & hidden[1:])
    return Thread(
        np.stack([path[:-1], path[1:]], axis=1).reshape(-1, 2, 3)[seen],
        np.stack([colours[:-1], colours[1:]], axis=1).reshape(-1, 2, 3)[seen],
    )
