"""Piecewise polynomials of one variable, each piece about its own middle."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

HALVINGS = 60
"""Of an interval, until nothing between two doubles is left."""


@dataclass(frozen=True, eq=False, repr=False)
class PiecewisePolynomial:
    """breaks (m + 1,) ascending; coefficients (m, degree + 1), ascending powers of the distance from the
    middle of each piece. Below and above its breaks it keeps the value it has there."""

    breaks: np.ndarray
    coefficients: np.ndarray

    @property
    def middles(self) -> np.ndarray:
        return 0.5 * (self.breaks[:-1] + self.breaks[1:])

    def __call__(self, x: np.ndarray) -> np.ndarray:
        x = np.clip(x, self.breaks[0], self.breaks[-1])
        return self._of_pieces(self._piece(x), x)

    def about(self, places: np.ndarray) -> np.ndarray:
        """Coefficients (k, degree + 1) of what holds around each place, in powers of the distance from it."""
        inside = np.clip(places, self.breaks[0], self.breaks[-1])
        piece = self._piece(inside)
        coefficients, shift = self.coefficients[piece], inside - self.middles[piece]
        moved = np.zeros_like(coefficients)
        for j in range(coefficients.shape[1]):
            for k in range(j, coefficients.shape[1]):
                moved[:, j] += comb(k, j) * coefficients[:, k] * shift ** (k - j)
        outside = (places < self.breaks[0]) | (places > self.breaks[-1])
        moved[outside, 1:] = 0.0
        return moved

    def integral(self) -> PiecewisePolynomial:
        """Its integral from the first break on."""
        pieces, powers = self.coefficients.shape
        coefficients = np.zeros((pieces, powers + 1))
        coefficients[:, 1:] = self.coefficients / np.arange(1, powers + 1)
        half = 0.5 * np.diff(self.breaks)
        ends = [_horner(coefficients, sign * half) for sign in (-1.0, 1.0)]
        before = np.concatenate([[0.0], np.cumsum(ends[1] - ends[0])[:-1]])
        coefficients[:, 0] = before - ends[0]
        return PiecewisePolynomial(self.breaks, coefficients)

    def inverse(self, values: np.ndarray) -> np.ndarray:
        """Where it reaches each value, if it never falls: by halving within the piece."""
        at_breaks = np.maximum.accumulate(self(self.breaks))
        piece = np.clip(np.searchsorted(at_breaks, values, side="right") - 1, 0, len(self.breaks) - 2)
        low, high = self.breaks[piece], self.breaks[piece + 1]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            below = self._of_pieces(piece, middle) < values
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return 0.5 * (low + high)

    def _piece(self, x: np.ndarray) -> np.ndarray:
        return np.clip(np.searchsorted(self.breaks, x, side="right") - 1, 0, len(self.breaks) - 2)

    def _of_pieces(self, piece: np.ndarray, x: np.ndarray) -> np.ndarray:
        return _horner(self.coefficients[piece], x - self.middles[piece])


def _horner(coefficients: np.ndarray, x: np.ndarray) -> np.ndarray:
    value = coefficients[..., -1]
    for k in range(coefficients.shape[-1] - 2, -1, -1):
        value = value * x + coefficients[..., k]
    return value
