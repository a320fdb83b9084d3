"""Numbers made of Jacobians and compliances: how well the tip can be moved, and how stiffly it is held."""

from __future__ import annotations

import numpy as np


def strokes(jacobian: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Jacobians (k, 6, q) per full range of each actuator (q,), so that newtons, radians and metres can be
    compared: column times range."""
    return jacobian * reach


def manipulability(jacobian: np.ndarray) -> np.ndarray:
    """Geometric mean of the singular values of the tip's shift, (k,), m per full range.

    That of the half axes of the ellipsoid of small shifts: Yoshikawa's measure (Int. J. Robot. Res. 4, 1985),
    as a length. With fewer than three actuators it is that of the axes there are.
    """
    values = _singular(jacobian[:, :3])
    return np.exp(np.mean(np.log(np.maximum(values, np.finfo(float).tiny)), axis=-1))


def isotropy(jacobian: np.ndarray) -> np.ndarray:
    """Least over largest singular value of the tip's shift, (k,): 1 where all directions are alike, 0 where
    one is lost."""
    values = _singular(jacobian[:, :3])
    return values[:, -1] / values[:, 0]


def condition(jacobian: np.ndarray, length: float) -> np.ndarray:
    """Largest over least singular value of shift and rotation together, (k,).

    A rotation counts as the shift of a point at a characteristic length (m) from the axis (Angeles,
    Fundamentals of Robotic Mechanical Systems, 2014). Infinite where a motion is lost; with fewer than six
    actuators, of the motions there are.
    """
    values = _singular(jacobian * np.array([1.0, 1.0, 1.0, length, length, length])[:, None])
    with np.errstate(divide="ignore"):
        return values[:, 0] / values[:, -1]


def tip_stiffness(compliance: np.ndarray) -> np.ndarray:
    """Force over shift in the softest direction, (k,), N/m: the tip free to turn, all actuators held."""
    return 1.0 / _singular(compliance[:, :3, :3])[:, 0]


def _singular(matrices: np.ndarray) -> np.ndarray:
    """Singular values, descending; NaN where a matrix holds one."""
    good = np.isfinite(matrices).all(axis=(1, 2))
    values = np.full((len(matrices), min(matrices.shape[1:])), np.nan)
    values[good] = np.linalg.svd(matrices[good], compute_uv=False)
    return values
