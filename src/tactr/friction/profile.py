"""Tension along one tendon, as its history has left it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ORDER = 12
"""Coefficients of one piece: as many as the kernel takes."""

_DEGREES = np.arange(ORDER)


@dataclass(frozen=True, eq=False)
class Curve:
    """A function of sigma, smooth between its edges, where it may jump.

    edges: (k + 1,) m, ascending; coefficients: (k, ORDER), Chebyshev's on every piece.
    """

    edges: np.ndarray
    coefficients: np.ndarray

    def piece(self, sigma: float) -> int:
        """Index of the piece that holds sigma; at an edge, of the distal one."""
        return int(self._pieces(np.array([sigma]))[0])

    def __call__(self, sigma: np.ndarray) -> np.ndarray:
        """Values at sigma, (n,); at an edge, of the distal piece."""
        k = self._pieces(sigma)
        start, end = self.edges[k], self.edges[k + 1]
        x = np.clip((2.0 * sigma - (start + end)) / (end - start), -1.0, 1.0)
        return (np.cos(np.multiply.outer(np.arccos(x), _DEGREES)) * self.coefficients[k]).sum(axis=1)

    def _pieces(self, sigma: np.ndarray) -> np.ndarray:
        return np.clip(np.searchsorted(self.edges, sigma, side="right") - 1, 0, len(self.coefficients) - 1)


@dataclass(frozen=True, eq=False)
class Profile:
    """Logarithm of the tension along one tendon, N; slides: -1, 0 or 1 for every piece, towards the base,
    stuck, towards the end; driven: whether the piece follows the tension at the base."""

    log: Curve
    slides: tuple[int, ...]
    driven: tuple[bool, ...]

    def tension(self, sigma: np.ndarray) -> np.ndarray:
        """N, at sigma (n,), m."""
        return np.exp(self.log(sigma))

    @staticmethod
    def even(tension: float, end: float) -> Profile:
        """The same tension, N, above 0, all along."""
        coefficients = np.zeros((1, ORDER))
        coefficients[0, 0] = np.log(tension)
        return Profile(Curve(np.array([0.0, end]), coefficients), (0,), (False,))
