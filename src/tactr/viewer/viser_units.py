"""Lengths and colours as viser takes them."""

from __future__ import annotations

import numpy as np

PER_METRE = 10.0
"""Units of the scene: a tenth of a metre each, because cameras like sizes near one."""


def rgb(colour: str) -> tuple[int, int, int]:
    """ "#rrggbb" as numbers."""
    r, g, b = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return r, g, b


def linear(colours: np.ndarray) -> np.ndarray:
    """Colours of lines for viser, which takes those at points for linear light (IEC 61966-2-1)."""
    return (255.0 * ((colours / 255.0 + 0.055) / 1.055) ** 2.4).round().astype(np.uint8)
