"""The linear complementarity problem of one Newton step: tensions at least 0, a motor that a slack tendon
leaves behind."""

from __future__ import annotations

import numpy as np

SINGULAR = 1e-11  # of the largest flexibility: below, the lengths do not tell the tensions apart


def complementary_tension(flexibility: np.ndarray, gap: np.ndarray, tension: np.ndarray) -> np.ndarray:
    """x >= 0 (n,) with w = gap + flexibility (x - tension) >= 0 and x w = 0.

    flexibility (n, n) m/N, positive semidefinite where the robot is stable; gap (n,) m; tension (n,) N. Where
    it is singular, x is the solution near ``tension`` (a proximal step). Primal-dual active sets first, which
    need no definiteness; where they cycle, the convex quadratic programme of the flexibility made definite.
    """
    definite = flexibility + _proximal(flexibility)
    bound = gap - definite @ tension
    pulled = (tension > 0.0) | (gap < 0.0)
    for _ in range(2 * len(gap) + 4):
        x = _solved(definite, bound, pulled)
        if x is None:
            break
        after = np.where(pulled, x > 0.0, bound + definite @ x < 0.0)
        if np.array_equal(after, pulled):
            return x
        pulled = after
    return _quadratic_programme(_made_definite(flexibility), gap, tension)


def _proximal(flexibility: np.ndarray) -> np.ndarray:
    return SINGULAR * float(np.abs(flexibility).max(initial=0.0)) * np.eye(len(flexibility))


def _solved(matrix: np.ndarray, bound: np.ndarray, pulled: np.ndarray) -> np.ndarray | None:
    """Tensions of the pulled tendons that close their gaps, the others' 0; None: singular."""
    x = np.zeros_like(bound)
    if pulled.any():
        try:
            x[pulled] = np.linalg.solve(matrix[np.ix_(pulled, pulled)], -bound[pulled])
        except np.linalg.LinAlgError:
            return None
    return x if np.isfinite(x).all() else None


def _made_definite(flexibility: np.ndarray) -> np.ndarray:
    """Symmetric, the eigenvalues' signs dropped: a step along it goes down, on a stable branch or not."""
    values, vectors = np.linalg.eigh(0.5 * (flexibility + flexibility.T))
    values = np.maximum(np.abs(values), max(SINGULAR * np.abs(values).max(initial=0.0), 1e-300))
    return (vectors * values) @ vectors.T


def _quadratic_programme(matrix: np.ndarray, gap: np.ndarray, tension: np.ndarray) -> np.ndarray:
    """Least x matrix x / 2 + (gap - matrix tension) x over x >= 0: the active set method of Lawson and Hanson
    (Solving Least Squares Problems, 1974, ch. 23)."""
    bound = gap - matrix @ tension
    scale = np.sqrt(np.diag(matrix))
    x, pulled = np.zeros_like(gap), np.zeros(len(gap), dtype=bool)
    for _ in range(3 * len(gap) + 10):
        pull = np.where(pulled, 0.0, -(bound + matrix @ x) / scale)
        k = int(np.argmax(pull))
        if pull[k] <= 1e-13 * float(np.abs(bound / scale).max()):
            break
        pulled[k] = True
        while True:
            z = _solved(matrix, bound, pulled)
            if z is None:
                return x
            low = pulled & (z <= 0.0)
            if not low.any():
                x = z
                break
            share = float(np.min(x[low] / np.maximum(x[low] - z[low], 1e-300)))
            x = x + share * (z - x)
            pulled &= x > 1e-14 * float(np.abs(x).max())
            x[~pulled] = 0.0
    return x
