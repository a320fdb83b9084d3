"""Colours by tension: pale at none, dark at the most."""

from __future__ import annotations

import numpy as np

# ColorBrewer's OrRd (Brewer, 2003) without its palest three: colour-blind people read it by its lightness.
SCALE = np.array(
    [[253, 187, 132], [252, 141, 89], [239, 101, 72], [215, 48, 31], [179, 0, 0], [127, 0, 0]],
    dtype=float,
)
SLACK = (150, 150, 150)
"""A tendon without tension."""


def tension_colours(tension: np.ndarray, most: float) -> np.ndarray:
    """Colours (k, 3), 0 to 255, of tensions (k,) in N; most: the tension of the darkest, N."""
    share = np.clip(tension / most if most > 0 else 0.0 * tension, 0.0, 1.0) * (len(SCALE) - 1)
    places = np.arange(len(SCALE))
    colours = np.stack([np.interp(share, places, channel) for channel in SCALE.T], axis=-1)
    colours[tension <= 0] = SLACK
    return colours.round().astype(np.uint8)
