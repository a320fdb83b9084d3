"""Tendon routing r(s) with the two derivatives that the published equations ask for."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactr.reference.algebra import Array


@dataclass(frozen=True)
class Path:
    """One smooth piece of a tendon's routing: x and y, or radius and angle, as polynomials of s - start."""

    start: float
    polar: bool
    a: tuple[float, ...]
    b: tuple[float, ...]

    @classmethod
    def of_piece(cls, piece: Any) -> Path:
        """Take over a routing piece of the robot description (metres, radians)."""
        return cls(float(piece.start), bool(piece.polar), tuple(piece.a), tuple(piece.b))

    def derivatives(self, s: float) -> tuple[complex, complex, complex]:
        """Return x + i y (m), its first and its second derivative at arc length s (m)."""
        a, da, dda = polynomial(self.a, s - self.start)
        b, db, ddb = polynomial(self.b, s - self.start)
        if not self.polar:
            return complex(a, b), complex(da, db), complex(dda, ddb)
        turn = cmath.exp(1j * b)
        return a * turn, (da + 1j * a * db) * turn, (dda - a * db**2 + 1j * (2 * da * db + a * ddb)) * turn


def polynomial(coefficients: Sequence[float], d: float) -> tuple[float, float, float]:
    """Return a polynomial (ascending powers) at d, with its first and second derivative (Horner)."""
    p = dp = half_ddp = 0.0
    for c in reversed(coefficients):
        half_ddp = half_ddp * d + dp
        dp = dp * d + p
        p = p * d + c
    return p, dp, 2.0 * half_ddp


def routing(paths: Sequence[Path], s: float) -> tuple[Array, Array, Array]:
    """Return r, r' and r'' of all tendons at s: three arrays (m, 3) in the host's frame (m, 1, 1/m)."""
    r, dr, ddr = np.zeros((3, len(paths), 3))
    for j, path in enumerate(paths):
        z, dz, ddz = path.derivatives(s)
        r[j, :2] = z.real, z.imag
        dr[j, :2] = dz.real, dz.imag
        ddr[j, :2] = ddz.real, ddz.imag
    return r, dr, ddr
