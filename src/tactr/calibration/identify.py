"""What the data say of the free numbers: standard errors, correlation, and what they do not see.

In numbers divided by their scales, the information that a fit has is A^T A of the stacked rows A: derivatives
of the predictions over their noise, and one row for every prior. Its singular vectors are the combinations
that the data tell apart, each with the standard error 1 / singular value.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.calibration.parameters import Free

RANK = 1e-8  # of the largest singular value: below, the derivatives are rounding
SEEN = 1.0  # scales: a larger standard error of a combination, and the data do not see it
LEAST_WEIGHT = 1e-6  # of a number in a combination that changes nothing: below, it is rounding
SHARE = 0.05  # of a combination, for a number to be named in it


@dataclass(frozen=True)
class Unseen:
    """A combination of free numbers that the data do not see: weights by name (in their scales, length 1),
    and its standard error in scales, infinite where the predictions do not change at all."""

    weights: dict[str, float]
    error: float

    def __str__(self) -> str:
        parts = " ".join(f"{'+' if w > 0 else '-'} {abs(w):.2f} {name}" for name, w in self.weights.items())
        size = (
            "changes no prediction" if np.isinf(self.error) else f"is known to {self.error:.3g} scales only"
        )
        return f"{parts.removeprefix('+ ')} {size}"


@dataclass(frozen=True)
class Knowledge:
    """errors: standard errors (free,), SI units, NaN for numbers that are not identifiable or at a bound;
    covariance: (free, free), NaN there; unseen: combinations; identifiable: (free,) bool."""

    errors: np.ndarray
    covariance: np.ndarray
    unseen: tuple[Unseen, ...]
    identifiable: np.ndarray

    @property
    def correlation(self) -> np.ndarray:
        """(free, free), NaN where there is no standard error."""
        return self.covariance / np.outer(self.errors, self.errors)


def knowledge(frees: Sequence[Free], jacobian: np.ndarray, noise: float, at_bound: np.ndarray) -> Knowledge:
    """jacobian: (numbers, free), m per SI unit, weighted; noise: m; at_bound: (free,) bool, held there."""
    n = len(frees)
    scales = np.array([free.scale for free in frees])
    moving = np.flatnonzero(~at_bound)
    rows = [jacobian * scales / noise]
    for k, free in enumerate(frees):
        if free.prior is not None:
            rows.append(np.eye(n)[[k]] * free.scale / free.prior[1])
    _, singular, vectors = np.linalg.svd(np.concatenate(rows)[:, moving], full_matrices=False)
    singular = np.pad(singular, (0, len(moving) - len(singular)))
    if len(vectors) < len(moving):
        vectors = np.linalg.svd(np.concatenate(rows)[:, moving], full_matrices=True)[2]
    with np.errstate(divide="ignore"):
        errors = np.where(singular > RANK * singular.max(initial=0.0), 1.0 / singular, np.inf)
    unseen = errors > SEEN
    known = np.isfinite(errors)
    never = (np.abs(vectors[~known]) > LEAST_WEIGHT).any(axis=0)
    spread = vectors[known] * errors[known, None]
    inner = spread.T @ spread
    good = np.zeros(n, dtype=bool)
    good[moving] = ~never & (np.sqrt(np.diag(inner)) <= SEEN)
    covariance = np.full((n, n), np.nan)
    covariance[np.ix_(moving, moving)] = inner * np.outer(scales[moving], scales[moving])
    covariance[~good] = np.nan
    covariance[:, ~good] = np.nan
    names = [frees[int(k)].name for k in moving]
    vague = [int(k) for k in np.flatnonzero(unseen)][::-1]
    return Knowledge(
        np.sqrt(np.diag(covariance)),
        covariance,
        tuple(_unseen(vectors[k], float(errors[k]), names) for k in vague),
        good,
    )


def _unseen(vector: np.ndarray, error: float, names: Sequence[str]) -> Unseen:
    order = [int(k) for k in np.argsort(-np.abs(vector), kind="stable") if abs(vector[k]) > SHARE]
    sign = np.sign(vector[order[0]])
    return Unseen({names[k]: float(sign * vector[k]) for k in order}, error)
