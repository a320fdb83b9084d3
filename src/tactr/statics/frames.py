"""Rotations: quaternions (w, x, y, z) and matrices, many at once."""

from __future__ import annotations

import numpy as np


def rotation_matrices(quaternion: np.ndarray) -> np.ndarray:
    """Unit quaternions (..., 4) as rotation matrices (..., 3, 3)."""
    w, x, y, z = np.moveaxis(quaternion, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def turned_about_z(frames: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """R Rz(angle): frames (k, 3, 3) turned about their own third axis by angles (n, k); (n, k, 3, 3)."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    d1, d2, d3 = np.moveaxis(frames, -1, 0)
    return np.stack([c * d1 + s * d2, c * d2 - s * d1, np.broadcast_to(d3, (*angle.shape, 3))], axis=-1)
