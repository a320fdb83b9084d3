"""Polynomial pieces for a Python function, by adaptive Chebyshev interpolation.

On each interval the function is interpolated at Chebyshev points of the second kind, ends included, so that
neighbouring pieces meet; the interpolant is rewritten in powers of the distance from the piece's start and
then compared, in that form, with the function at other points. An interval that fails is halved. The
rewriting multiplies rounding by the size of the shifted Chebyshev coefficients (5.8^k for degree k), which is
harmless for pieces short enough to pass, because their coefficients fall faster. (Trefethen, Approximation
Theory and Approximation Practice, 2013, chapters 2 to 8.)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tactr.errors import RobotError
from tactr.robot.piece import MOST_COEFFICIENTS, RoutingPiece, horner

MOST_PIECES = 256
TOLERANCE = 1e-9
AIM = 1e-11
"""First aim (m); a smooth function reaches it, and then its slope is accurate as well."""

Sampler = Callable[[float], Sequence[float] | np.ndarray]


class Interpolant(NamedTuple):
    """Polynomials in sigma - start on [start, end] (m): ascending ``powers`` of every component."""

    start: float
    end: float
    powers: tuple[tuple[float, ...], ...]

    def values(self, sigma: np.ndarray) -> np.ndarray:
        """The components (n, width) at ``sigma`` (n,)."""
        return np.stack([horner(powers, sigma - self.start)[0] for powers in self.powers], axis=-1)


class Rough(Exception):
    """The function cannot be followed near ``sigma`` within the tolerance; ``error`` is what remains."""

    def __init__(self, sigma: float, error: float) -> None:
        super().__init__(sigma, error)
        self.sigma = sigma
        self.error = error


class _Basis(NamedTuple):
    """What interpolation with a number of coefficients needs; places are shares of the piece."""

    nodes: np.ndarray
    to_chebyshev: np.ndarray
    to_monomial: np.ndarray
    probes: np.ndarray


@cache
def basis(count: int) -> _Basis:
    """Nodes, matrices from values to Chebyshev coefficients to powers, and the places to compare at."""
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(count) / (count - 1))
    middles = (nodes[1:] + nodes[:-1]) / 2
    probes = np.sort(np.concatenate((middles, np.arange(1, 30) * 0.6180339887498949 % 1.0)))
    return _Basis(nodes, _chebyshev_matrix(count), _monomial_matrix(count), probes)


def _monomial_matrix(count: int) -> np.ndarray:
    """Column k: coefficients of the Chebyshev polynomial T_k(2 x - 1) in powers of x."""
    rows = np.zeros((count, count))
    rows[0, 0] = 1.0
    rows[0, 1], rows[1, 1] = -1.0, 2.0
    for k in range(2, count):
        rows[:, k] = -2 * rows[:, k - 1] - rows[:, k - 2]
        rows[1:, k] += 4 * rows[:-1, k - 1]
    return rows


def _chebyshev_matrix(count: int) -> np.ndarray:
    """Takes values at the nodes to Chebyshev coefficients."""
    last = count - 1
    k = np.arange(count)
    matrix = np.cos(np.pi * np.outer(k, last - k) / last) * 2 / last
    matrix[:, [0, last]] /= 2
    matrix[[0, last], :] /= 2
    return matrix


def fit(sample: Sampler, knots: Sequence[float]) -> tuple[tuple[RoutingPiece, ...], float]:
    """Pieces over consecutive ``knots`` (m) and the largest error (m) seen, at most 1e-9.

    ``sample`` returns a finite (x, y) in m or raises. RobotError if the function is too rough.
    """
    try:
        try:
            found, error = interpolate(sample, knots, AIM)
        except Rough:
            found, error = interpolate(sample, knots, TOLERANCE)
    except Rough as rough:
        raise RobotError(
            "function",
            f"it is too rough: near sigma = {rough.sigma:.6g} m the fit is still off by {rough.error:.3g} m",
            f"a path smooth enough to fit within {TOLERANCE:g} m, no jumps, kinks listed in breaks=(...)",
            value=rough.sigma,
        ) from None
    return tuple(RoutingPiece(start, end, False, *powers) for start, end, powers in found), error


def interpolate(
    sample: Sampler,
    knots: Sequence[float],
    tolerance: float,
    *,
    count: int = MOST_COEFFICIENTS,
    negligible: float = 1e-13,
) -> tuple[list[Interpolant], float]:
    """Interpolants over consecutive ``knots`` (m), of at most ``count`` coefficients, and the largest error.

    Errors are Euclidean norms over the components. negligible: of the last Chebyshev coefficients together,
    which are then left out. Raises Rough if the tolerance is not met.
    """
    waiting = list(pairwise(knots))[::-1]
    shortest = (knots[-1] - knots[0]) * 1e-6
    pieces: list[Interpolant] = []
    worst = 0.0
    while waiting:
        start, end = waiting.pop()
        piece = _interpolant(sample, start, end, count, negligible)
        sigma, error = _largest_error(sample, piece, count)
        if error <= tolerance:
            pieces.append(piece)
            worst = max(worst, error)
        elif len(pieces) + len(waiting) + 2 > MOST_PIECES or end - start < shortest:
            raise Rough(sigma, error)
        else:
            middle = (start + end) / 2
            waiting += [(middle, end), (start, middle)]
    return pieces, worst


def _interpolant(sample: Sampler, start: float, end: float, count: int, negligible: float) -> Interpolant:
    width = end - start
    places = start + width * basis(count).nodes
    places[-1] = end
    chebyshev = basis(count).to_chebyshev @ np.array([sample(float(place)) for place in places])
    return Interpolant(start, end, tuple(_powers(column, width, negligible) for column in chebyshev.T))


def _powers(chebyshev: np.ndarray, width: float, negligible: float) -> tuple[float, ...]:
    """Chebyshev coefficients on a piece of ``width`` to powers of the distance, without a negligible tail."""
    tail = np.cumsum(np.abs(chebyshev)[::-1])[::-1]
    count = max(1, int(np.count_nonzero(tail > negligible)))
    coefficients = basis(len(chebyshev)).to_monomial[:count, :count] @ chebyshev[:count]
    return tuple(float(c) for c in coefficients / width ** np.arange(count))


def _largest_error(sample: Sampler, piece: Interpolant, count: int) -> tuple[float, float]:
    places = piece.start + (piece.end - piece.start) * basis(count).probes
    exact = np.array([sample(float(place)) for place in places])
    error = np.linalg.norm(piece.values(places) - exact, axis=-1)
    worst = int(np.argmax(error))
    return float(places[worst]), float(error[worst]) if math.isfinite(error[worst]) else math.inf
