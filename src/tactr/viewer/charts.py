"""Curves along s, one for each tube."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tactr.statics import Shape, TubeShape

Curve = Callable[[TubeShape], np.ndarray]
QUANTITIES: dict[str, Curve] = {
    "curvature (1/m)": lambda tube: np.hypot(tube.u[:, 0], tube.u[:, 1]),
    "twist (1/m)": lambda tube: tube.u[:, 2],
    "stretch (%)": lambda tube: 100.0 * (tube.v[:, 2] - 1.0),
    "axial force (N)": lambda tube: tube.n[:, 2],
    "shear force (N)": lambda tube: np.hypot(tube.n[:, 0], tube.n[:, 1]),
    "bending moment (N mm)": lambda tube: 1e3 * np.hypot(tube.m[:, 0], tube.m[:, 1]),
    "torque (N mm)": lambda tube: 1e3 * tube.m[:, 2],
}
"""Each in the tube's own material frame, which turns lateral components: these are drawn by their size."""


def curves(shape: Shape, quantity: str) -> tuple[np.ndarray, ...]:
    """s in mm (k,), and the quantity of every tube there (k,), NaN where a tube is not."""
    s = shape.s
    found = []
    for tube in shape.tubes:
        values = np.full(len(s), np.nan)
        values[np.searchsorted(s, tube.s)] = QUANTITIES[quantity](tube)
        found.append(values)
    return (1e3 * s, *found)
