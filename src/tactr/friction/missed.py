"""What one step across a way misses of what many small ones would have seen.

A profile moved onto the cone at the end of a way is that of a slow motion where the cone's sides move one way
only. The cone between the ends is estimated from curvatures of the tendon's path and tensions at the base
that change linearly.
"""

from __future__ import annotations

import math

import numpy as np

from tactr.friction.project import NO_TENSION, Profile
from tactr.friction.wrap import Wrap

LOOKS = 65
PARTS = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0)


def history_missed(
    before: Wrap,
    after: Wrap,
    tension: tuple[float, float],
    profiles: tuple[Profile | None, Profile | None],
) -> float:
    """By how much log tension comes out different where it is moved onto the cone at places on the way, too.

    tension: at the base, N, and profiles, before and after.
    """
    old = profiles[0]
    if profiles[1] is None:
        return 0.0
    end = float(after.rise.edges[-1])
    sigma = np.linspace(0.0, end, LOOKS)
    inside = np.minimum(sigma, end - 1e-12)
    bends = [wrap.bend_at(sigma) for wrap in (before, after)]
    kinks = [wrap.kinks_on(sigma) for wrap in (before, after)]

    def moved(y: list[float], part: float) -> list[float]:
        """Onto the cone at a part of the way, from the base on."""
        bend = np.linalg.norm((1.0 - part) * bends[0] + part * bends[1], axis=1)
        kink = np.linalg.norm((1.0 - part) * kinks[0] + part * kinks[1], axis=1)
        steps = 0.5 * (bend[1:] + bend[:-1]) * np.diff(sigma) + kink[1:]
        last = math.log(max((1.0 - part) * tension[0] + part * tension[1], 1e-300))
        found = []
        for kept, step in zip(y, [float(kink[0]), *steps.tolist()], strict=True):
            last = min(max(kept, last - step), last + step)
            found.append(last)
        return found

    start = [NO_TENSION] * LOOKS if old is None else old.log(inside).tolist()
    slowly = start
    for part in PARTS:
        slowly = moved(slowly, part)
    return max(abs(a - b) for a, b in zip(slowly, moved(start, 1.0), strict=True))
