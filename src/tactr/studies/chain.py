"""Uniform samples of numbers in a row that have bounds and whose neighbours differ within bounds.

The set is {x: low_i <= x_i <= high_i, least_i <= x_i - x_(i+1) <= most_i}. Let V_i(x) be the volume of what
the numbers after x_i can be where it has the value x: V_n = 1 and V_i(x) = integral of V_(i+1) from
x - most_i to x - least_i, inside the bounds of x_(i+1). Drawing x_1 with the density V_1 / V and then each
x_(i+1) with the density V_(i+1) / V_i(x_i), the product of all densities is 1 / V everywhere in the set:
uniform, with nothing rejected. V_i is a piecewise polynomial, so that all is exact; a number of [0, 1) for
each x, from any kind of sequence, becomes a point of the set by inverting one distribution after the other
(Rosenblatt, Ann. Math. Stat. 23, 1952).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tactr.studies.polynomials import PiecewisePolynomial


@dataclass(frozen=True)
class Chain:
    """low, high (n,): bounds of each number; least, most (n - 1,): of its excess over the next one."""

    low: tuple[float, ...]
    high: tuple[float, ...]
    least: tuple[float, ...]
    most: tuple[float, ...]

    @property
    def volume(self) -> float:
        """Of the set; 0 where nothing meets all bounds."""
        return float(self._reached[0](np.array([self.high[0]]))[0]) if self._reached else 0.0

    def points(self, u: np.ndarray) -> np.ndarray:
        """Points (k, n) of the set from numbers u (k, n) in [0, 1): uniform where those are."""
        x = np.empty_like(u)
        for i, reached in enumerate(self._reached):
            low, high = np.full(len(u), self.low[i]), np.full(len(u), self.high[i])
            if i > 0:
                low = np.maximum(low, x[:, i - 1] - self.most[i - 1])
                high = np.minimum(high, x[:, i - 1] - self.least[i - 1])
            start, end = reached(low), reached(high)
            x[:, i] = np.clip(reached.inverse(start + u[:, i] * (end - start)), low, high)
        return x

    @cached_property
    def _reached(self) -> tuple[PiecewisePolynomial, ...]:
        """For every number the integral of V from its lower bound on; empty where the set is."""
        reached: list[PiecewisePolynomial] = []
        for i in range(len(self.low) - 1, -1, -1):
            low, high = self.low[i], self.high[i]
            if not low < high:
                return ()
            if not reached:
                density = PiecewisePolynomial(np.array([low, high]), np.ones((1, 1)))
            else:
                density = _volume_after(reached[0], low, high, self.least[i], self.most[i])
            reached.insert(0, density.integral())
            if not reached[0](np.array([high]))[0] > 0.0:
                return ()
        return tuple(reached)


def _volume_after(
    reached: PiecewisePolynomial, low: float, high: float, least: float, most: float
) -> PiecewisePolynomial:
    ends = [least, most]
    inner = np.concatenate([reached.breaks + end for end in ends if np.isfinite(end)] or [np.empty(0)])
    breaks = np.unique(np.clip(np.concatenate([[low, high], inner]), low, high))
    middles = 0.5 * (breaks[:-1] + breaks[1:])
    return PiecewisePolynomial(breaks, reached.about(middles - least) - reached.about(middles - most))
