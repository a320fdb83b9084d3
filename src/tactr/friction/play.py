"""Backlash of actuators: the play operator (Krasnosel'skii and Pokrovskii, Systems with Hysteresis, 1989)."""

from __future__ import annotations

import numpy as np


def passed_on(before: np.ndarray, given: np.ndarray, width: np.ndarray) -> np.ndarray:
    """What actuators with a play of the whole width pass on: it stays until the given value is more than half
    the width away, and then follows it at that distance."""
    return np.clip(before, given - 0.5 * width, given + 0.5 * width)
