"""Polynomial pieces for a Python function, by adaptive Chebyshev interpolation.

On each interval the function is interpolated at 16 Chebyshev points of the second kind, ends included, so
that neighbouring pieces meet; the interpolant is rewritten in powers of the distance from the piece's start
and then compared, in that form, with the function at other points. An interval that fails is halved. The
rewriting multiplies rounding by the size of the shifted Chebyshev coefficients (5.8^k for degree k), which is
harmless for pieces short enough to pass, because their coefficients fall faster. (Trefethen, Approximation
Theory and Approximation Practice, 2013, chapters 2 to 8.)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from tactr.errors import RobotError
from tactr.robot.piece import MOST_COEFFICIENTS, RoutingPiece, horner

MOST_PIECES = 256
TOLERANCE = 1e-9
AIM = 1e-11
"""First aim (m); a smooth function reaches it, and then its slope is accurate as well."""

Sampler = Callable[[float], tuple[float, float]]

_COUNT = MOST_COEFFICIENTS
_NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(_COUNT) / (_COUNT - 1))
_NEGLIGIBLE = 1e-13


def _monomial_matrix() -> np.ndarray:
    """Column k: coefficients of the Chebyshev polynomial T_k(2 x - 1) in powers of x."""
    rows = np.zeros((_COUNT, _COUNT))
    rows[0, 0] = 1.0
    rows[0, 1], rows[1, 1] = -1.0, 2.0
    for k in range(2, _COUNT):
        rows[:, k] = -2 * rows[:, k - 1] - rows[:, k - 2]
        rows[1:, k] += 4 * rows[:-1, k - 1]
    return rows


def _chebyshev_matrix() -> np.ndarray:
    """Takes values at the nodes to Chebyshev coefficients."""
    last = _COUNT - 1
    k = np.arange(_COUNT)
    matrix = np.cos(np.pi * np.outer(k, last - k) / last) * 2 / last
    matrix[:, [0, last]] /= 2
    matrix[[0, last], :] /= 2
    return matrix


_TO_MONOMIAL = _monomial_matrix()
_TO_CHEBYSHEV = _chebyshev_matrix()
_MIDDLES = (_NODES[1:] + _NODES[:-1]) / 2
_PROBES = np.sort(np.concatenate((_MIDDLES, np.arange(1, 30) * 0.6180339887498949 % 1.0)))


class _Rough(Exception):
    """The function cannot be followed near ``sigma`` within the tolerance; ``error`` (m) is what remains."""

    def __init__(self, sigma: float, error: float) -> None:
        super().__init__(sigma, error)
        self.sigma = sigma
        self.error = error


def fit(sample: Sampler, knots: Sequence[float]) -> tuple[tuple[RoutingPiece, ...], float]:
    """Pieces over consecutive ``knots`` (m) and the largest error (m) seen, at most 1e-9.

    ``sample`` returns a finite (x, y) in m or raises. RobotError if the function is too rough.
    """
    try:
        return _fit(sample, knots, AIM)
    except _Rough:
        pass
    try:
        return _fit(sample, knots, TOLERANCE)
    except _Rough as rough:
        raise RobotError(
            "function",
            f"it is too rough: near sigma = {rough.sigma:.6g} m the fit is still off by {rough.error:.3g} m",
            f"a path smooth enough to fit within {TOLERANCE:g} m, no jumps, kinks listed in breaks=(...)",
            value=rough.sigma,
        ) from None


def _fit(sample: Sampler, knots: Sequence[float], tolerance: float) -> tuple[tuple[RoutingPiece, ...], float]:
    waiting = list(pairwise(knots))[::-1]
    shortest = (knots[-1] - knots[0]) * 1e-6
    pieces: list[RoutingPiece] = []
    worst = 0.0
    while waiting:
        start, end = waiting.pop()
        piece = _interpolant(sample, start, end)
        sigma, error = _largest_error(sample, piece)
        if error <= tolerance:
            pieces.append(piece)
            worst = max(worst, error)
        elif len(pieces) + len(waiting) + 2 > MOST_PIECES or end - start < shortest:
            raise _Rough(sigma, error)
        else:
            middle = (start + end) / 2
            waiting += [(middle, end), (start, middle)]
    return tuple(pieces), worst


def _interpolant(sample: Sampler, start: float, end: float) -> RoutingPiece:
    width = end - start
    places = start + width * _NODES
    places[-1] = end
    chebyshev = _TO_CHEBYSHEV @ np.array([sample(float(place)) for place in places])
    a, b = (_powers(column, width) for column in chebyshev.T)
    return RoutingPiece(start, end, False, a, b)


def _powers(chebyshev: np.ndarray, width: float) -> tuple[float, ...]:
    """Chebyshev coefficients on a piece of ``width`` to powers of the distance, without a negligible tail."""
    tail = np.cumsum(np.abs(chebyshev)[::-1])[::-1]
    count = max(1, int(np.count_nonzero(tail > _NEGLIGIBLE)))
    coefficients = _TO_MONOMIAL[:count, :count] @ chebyshev[:count]
    return tuple(float(c) for c in coefficients / width ** np.arange(count))


def _largest_error(sample: Sampler, piece: RoutingPiece) -> tuple[float, float]:
    places = piece.start + (piece.end - piece.start) * _PROBES
    exact = np.array([sample(float(place)) for place in places])
    d = places - piece.start
    error = np.hypot(horner(piece.a, d)[0] - exact[:, 0], horner(piece.b, d)[0] - exact[:, 1])
    worst = int(np.argmax(error))
    return float(places[worst]), float(error[worst]) if math.isfinite(error[worst]) else math.inf
