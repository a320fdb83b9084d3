"""Material frames along the tubes."""

from __future__ import annotations

import numpy as np

from tactr.statics import Shape


def quaternions(frames: np.ndarray) -> np.ndarray:
    """Rotation matrices (n, 3, 3) as quaternions (n, 4), w first."""
    from scipy.spatial.transform import Rotation

    if not len(frames):
        return np.empty((0, 4))
    return Rotation.from_matrix(frames).as_quat()[:, [3, 0, 1, 2]]


def material_frames(shape: Shape, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) m and quaternions (n, 4) of so many material frames on every tube, even along it."""
    position, frames = [], []
    for tube in shape.tubes:
        at = np.linspace(0, len(tube.s) - 1, count).round().astype(int)
        position.append(tube.position[at])
        frames.append(tube.frames[at])
    return np.concatenate(position), quaternions(np.concatenate(frames))
