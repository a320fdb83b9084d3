"""The colours of tubes, the same in every picture: Okabe and Ito's, which colour-blind people tell apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

TUBE_COLOURS = (
    "#0072B2",  # blue: outermost
    "#D55E00",  # vermillion
    "#009E73",  # bluish green
    "#E69F00",  # orange
    "#56B4E9",  # sky blue
    "#CC79A7",  # reddish purple
    "#B8A800",  # yellow, darkened to show on white
    "#555555",  # grey
)
GUIDE_COLOUR = "#9A9A9A"
MARK_COLOUR = "#222222"


def tube_colour(index: int) -> str:
    """The colour of a tube, outermost 0."""
    return TUBE_COLOURS[index % len(TUBE_COLOURS)]


def mixed(colour: str, other: str, share: float) -> str:
    """`colour` with this share of `other` mixed in, both as "#rrggbb"."""
    pairs = ((int(colour[k : k + 2], 16), int(other[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round((1 - share) * a + share * b):02x}" for a, b in pairs)


SCALE = ("#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725")
"""Viridis (Smith and van der Walt, 2015): even steps of lightness, told apart by colour-blind people."""


def scale_colours(shares: Sequence[float] | np.ndarray) -> np.ndarray:
    """Colours (k, 3) of 0 to 255 for shares of a scale, held between 0 and 1."""
    anchors = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in SCALE])
    places = np.linspace(0.0, 1.0, len(SCALE))
    return np.stack([np.interp(shares, places, band) for band in anchors.T], axis=-1).round().astype(np.uint8)
