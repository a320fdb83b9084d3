"""Routing pieces: the polynomial form in which every routing reaches the solver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.robot import _check as check

MOST_COEFFICIENTS = 16


@dataclass(frozen=True)
class RoutingPiece:
    """A routing on ``start`` <= sigma <= ``end`` (m), as polynomials in d = sigma - start, ascending powers.

    polar False: x = a(d), y = b(d) in m. polar True: radius = a(d) in m, angle = b(d) in rad, x = radius
    cos(angle), y = radius sin(angle). 1 to 16 coefficients each; ``end`` may be infinite. Raises RobotError.
    """

    start: float
    end: float
    polar: bool
    a: tuple[float, ...]
    b: tuple[float, ...]

    def __post_init__(self) -> None:
        with check.owned("RoutingPiece"):
            start = check.real("start", self.start, "m")
            end = math.inf if self.end == math.inf else check.real("end", self.end, "m", above=start)
            a = check.numbers("a", self.a, fewest=1, most=MOST_COEFFICIENTS)
            b = check.numbers("b", self.b, fewest=1, most=MOST_COEFFICIENTS)
            check.store(self, start=start, end=end, polar=bool(self.polar), a=a, b=b)

    def evaluate(self, sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (..., 2) in m and derivative with respect to sigma (..., 2) at ``sigma`` (...), m."""
        d = sigma - self.start
        a, da = horner(self.a, d)
        b, db = horner(self.b, d)
        if not self.polar:
            return np.stack((a, b), axis=-1), np.stack((da, db), axis=-1)
        cos, sin = np.cos(b), np.sin(b)
        xy = np.stack((a * cos, a * sin), axis=-1)
        return xy, np.stack((da * cos - a * sin * db, da * sin + a * cos * db), axis=-1)

    def cut(self, start: float, end: float) -> RoutingPiece:
        """The same curve on [start, end]."""
        if start == self.start:
            return self if end == self.end else RoutingPiece(start, end, self.polar, self.a, self.b)
        shift = start - self.start
        return RoutingPiece(start, end, self.polar, shifted(self.a, shift), shifted(self.b, shift))


def horner(coefficients: Sequence[float], d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Value and derivative of the polynomial with ascending ``coefficients`` at ``d``."""
    value = np.full_like(d, coefficients[-1])
    slope = np.zeros_like(d)
    for coefficient in reversed(coefficients[:-1]):
        slope = slope * d + value
        value = value * d + coefficient
    return value, slope


def shifted(coefficients: Sequence[float], shift: float) -> tuple[float, ...]:
    """Coefficients of p(shift + d) in powers of d, from those of p (repeated synthetic division)."""
    c = list(coefficients)
    for first in range(len(c) - 1):
        for k in range(len(c) - 2, first - 1, -1):
            c[k] += shift * c[k + 1]
    return tuple(c)


def clip(pieces: Sequence[RoutingPiece], start: float, end: float) -> tuple[RoutingPiece, ...]:
    """The part of consecutive ``pieces`` on [start, end]."""
    return tuple(
        piece.cut(max(piece.start, start), min(piece.end, end))
        for piece in pieces
        if max(piece.start, start) < min(piece.end, end)
    )


def evaluate(pieces: Sequence[RoutingPiece], sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate consecutive ``pieces`` at ``sigma`` (any shape); at a joint the piece after it counts."""
    starts = np.array([piece.start for piece in pieces])
    index = np.clip(np.searchsorted(starts, sigma, side="right") - 1, 0, len(pieces) - 1)
    xy = np.empty((*sigma.shape, 2))
    slope = np.empty_like(xy)
    for k in np.unique(index):
        here = index == k
        xy[here], slope[here] = pieces[k].evaluate(sigma[here])
    return xy, slope
