"""Two tubes curved alike, which behave like a pendulum, and the roots that go with them."""

from __future__ import annotations

import math
from collections.abc import Callable

from scipy.optimize import root_scalar

from tactr import Robot, Stiffness, Tube

LENGTH, NU = 0.1, 0.3


def find_root(f: Callable[[float], float], low: float, high: float, *, xtol: float = 1e-12) -> float:
    """The root of f between low and high."""
    return float(root_scalar(f, bracket=(low, high), xtol=xtol).root)


def pair(size: float, angle: float = 0.0) -> Robot:
    """Two tubes curved alike, size = sqrt(c) L."""
    k = size / LENGTH / math.sqrt(1 + NU)
    return Robot(
        [
            Tube(
                name,
                length=LENGTH,
                section=Stiffness(
                    EA=1e4 * f, GA=4e3 * f, EI_x=1e-3 * f, EI_y=1e-3 * f, GJ=1e-3 * f / (1 + NU)
                ),
                precurvature=(k, 0.0, 0.0),
                rotation=rotation,
            )
            for name, f, rotation in (("outer", 1.0, 0.0), ("inner", 3.0, angle))
        ]
    )
