"""Polynomials through Chebyshev points, piece by piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev, polynomial

ORDER = 12
"""Points, and coefficients, of one piece: as many as the kernel takes."""

POINTS = -np.cos(np.pi * (np.arange(ORDER) + 0.5) / ORDER)
"""Chebyshev's points of the first kind, ascending: none at an end, where strains may jump."""

FIT = np.linalg.inv(chebyshev.chebvander(POINTS, ORDER - 1))
"""From values at the points to Chebyshev coefficients."""

_UNIT = np.eye(ORDER)
SLOPE = np.array([np.append(chebyshev.chebder(row), 0.0) for row in _UNIT]).T
"""From coefficients to those of the derivative on [-1, 1]."""

INTEGRAL = np.array([chebyshev.chebint(row, lbnd=-1.0) for row in _UNIT]).T
"""From coefficients to those, one more, of the integral from -1."""

DERIVATIVE = chebyshev.chebvander(POINTS, ORDER - 1) @ SLOPE @ FIT
"""From values at the points to the derivative on [-1, 1] there."""

WEIGHTS = (INTEGRAL @ FIT).sum(axis=0)
"""Of values at the points in the integral over [-1, 1]."""

# T_k(2 u - 1) in powers of u
POWERS = np.zeros((ORDER, ORDER))
for _k in range(ORDER):
    _whole = np.zeros(1)
    for _power, _c in enumerate(chebyshev.cheb2poly(_UNIT[_k])):
        _whole = polynomial.polyadd(_whole, _c * polynomial.polypow([-1.0, 2.0], _power))
    POWERS[: len(_whole), _k] = _whole


_DEGREES = np.arange(ORDER)


def terms(x: np.ndarray) -> np.ndarray:
    """Chebyshev's polynomials at x (...) in [-1, 1], (..., ORDER)."""
    return np.cos(np.multiply.outer(np.arccos(np.minimum(np.maximum(x, -1.0), 1.0)), _DEGREES))


def points(start: float, end: float) -> np.ndarray:
    """The points of the piece [start, end], (ORDER,)."""
    return 0.5 * (start + end) + 0.5 * (end - start) * POINTS


def all_points(edges: np.ndarray) -> np.ndarray:
    """The points of all pieces between edges (k + 1,), ascending, (k ORDER,)."""
    start, end = edges[:-1, None], edges[1:, None]
    return (0.5 * (start + end) + 0.5 * (end - start) * POINTS).ravel()


def integrals(values: np.ndarray, start: float, end: float) -> np.ndarray:
    """Coefficients of the integral from start of what has these values (ORDER,) at the points; its degree is
    cut."""
    whole = 0.5 * (end - start) * (INTEGRAL @ (FIT @ values))
    return FIT @ chebyshev.chebval(POINTS, whole)


def powers(coefficients: np.ndarray, start: float, end: float) -> np.ndarray:
    """Coefficients of the same polynomial in powers of sigma - start."""
    return (POWERS @ coefficients) / (end - start) ** np.arange(ORDER)


@dataclass(frozen=True, eq=False)
class Curve:
    """A function of sigma, smooth between its edges, where it may jump.

    edges: (k + 1,) m, ascending; coefficients: (k, ORDER), Chebyshev's on every piece.
    """

    edges: np.ndarray
    coefficients: np.ndarray

    def piece(self, sigma: float) -> int:
        """Index of the piece that holds sigma; at an edge, of the distal one."""
        found = int(np.searchsorted(self.edges, sigma, side="right")) - 1
        return min(max(found, 0), len(self.coefficients) - 1)

    def on(self, k: int, sigma: np.ndarray | float) -> np.ndarray:
        """Values of piece k at sigma."""
        start, end = self.edges[k], self.edges[k + 1]
        return terms((2.0 * np.asarray(sigma) - (start + end)) / (end - start)) @ self.coefficients[k]

    def __call__(self, sigma: np.ndarray | float) -> np.ndarray:
        """Values at sigma, (n,); at an edge, of the distal piece."""
        sigma = np.atleast_1d(np.asarray(sigma, dtype=float))
        index = np.clip(np.searchsorted(self.edges, sigma, side="right") - 1, 0, len(self.coefficients) - 1)
        start, end = self.edges[index], self.edges[index + 1]
        x = (2.0 * sigma - (start + end)) / (end - start)
        return (terms(x) * self.coefficients[index]).sum(axis=1)

    @staticmethod
    def through(edges: np.ndarray, values: np.ndarray) -> Curve:
        """From values at the points of every piece, (k, ORDER)."""
        return Curve(edges, values @ FIT.T)


def merged(*edges: np.ndarray, gap: float = 1e-9) -> np.ndarray:
    """All edges, ascending; those nearer to each other than the gap are one."""
    every = np.sort(np.concatenate(edges))
    keep = np.append(True, np.diff(every) > gap)
    keep[-1] = True  # the end stays the end
    found = every[keep]
    if len(found) > 2 and found[-1] - found[-2] <= gap:
        found = np.delete(found, -2)
    return found
