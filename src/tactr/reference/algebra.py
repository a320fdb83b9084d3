"""Small algebra of the published model; every function takes any leading (batch) axes and complex numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]

I_3: Array = np.array([0.0, 0.0, 1.0])
"""The paper's vector I_3 = (0, 0, 1)."""
I_33: Array = np.diag(I_3)
"""The paper's matrix I_(3,3) = diag(I_3)."""

_HAT = np.zeros((3, 9))
_HAT[0, [7, 5]] = 1.0, -1.0
_HAT[1, [2, 6]] = 1.0, -1.0
_HAT[2, [3, 1]] = 1.0, -1.0


def hat(a: Array) -> Array:
    """Return [a], the matrix with [a] b = a x b; (..., 3) -> (..., 3, 3)."""
    return (a @ _HAT).reshape(*a.shape, 3)


def times(matrix: Array, vector: Array) -> Array:
    """Return matrix @ vector for stacks; (..., 3, 3), (..., 3) -> (..., 3)."""
    return (matrix @ vector[..., None])[..., 0]


def cross(a: Array, b: Array) -> Array:
    """Return a x b = [a] b; (..., 3), (..., 3) -> (..., 3)."""
    return times(hat(a), b)


def R_d3(theta: Array) -> Array:
    """Return the rotation R_d3(theta) about d3; (...) rad -> (..., 3, 3)."""
    R = np.zeros((*theta.shape, 3, 3), dtype=theta.dtype)
    c, s = np.cos(theta), np.sin(theta)
    R[..., 0, 0] = R[..., 1, 1] = c
    R[..., 1, 0] = s
    R[..., 0, 1] = -s
    R[..., 2, 2] = 1.0
    return R


def transposed(matrix: Array) -> Array:
    """Return the stack of transposes; (..., 3, 3) -> (..., 3, 3)."""
    return np.swapaxes(matrix, -1, -2)
