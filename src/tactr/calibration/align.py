"""A first guess of where the sensor is: predicted points laid onto measured ones (Kabsch 1976)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.calibration.frame import rotation_matrix
from tactr.calibration.parameters import Free

PLACE = ("sensor.x", "sensor.y", "sensor.z")
TURN = ("sensor.rx", "sensor.ry", "sensor.rz")
FEWEST = 4  # points to turn by
FLAT = 1e-3  # of the largest spread: points less spread than this in a second direction fix no turn


def aligned(
    frees: Sequence[Free], start: np.ndarray, predicted: np.ndarray, measured: np.ndarray
) -> np.ndarray:
    """The start with the sensor where it fits the points (n, k, 3) m best, as far as it is free."""
    p, q = predicted.reshape(-1, 3), measured.reshape(-1, 3)
    both = np.isfinite(p).all(axis=1) & np.isfinite(q).all(axis=1)
    p, q = p[both], q[both]
    index = {free.name: k for k, free in enumerate(frees) if free.prior is None}
    moved = start.copy()
    if not len(p) or not all(name in index for name in PLACE):
        return _shifted(index, moved, (q - p).mean(axis=0)) if len(p) else moved
    place = np.array([start[index[name]] for name in PLACE])
    turn = np.eye(3)
    if all(name in index for name in TURN) and len(p) >= FEWEST:
        turn = best_turn(p, q)
        from scipy.spatial.transform import Rotation

        before = rotation_matrix(np.array([start[index[name]] for name in TURN]))
        moved[[index[name] for name in TURN]] = Rotation.from_matrix(turn @ before).as_rotvec()
    moved[[index[name] for name in PLACE]] = q.mean(axis=0) - turn @ (p.mean(axis=0) - place)
    return np.clip(moved, [free.lower for free in frees], [free.upper for free in frees])


def best_turn(p: np.ndarray, q: np.ndarray, *, mirror: bool = False) -> np.ndarray:
    """Rotation (3, 3), or rotation and mirror, that lays points p (n, 3) best onto q about their means; none
    where they are all on one line."""
    u, spread, v = np.linalg.svd((p - p.mean(axis=0)).T @ (q - q.mean(axis=0)))
    if spread[1] < FLAT * spread[0] and not mirror:
        return np.eye(3)
    hand = (-1.0 if mirror else 1.0) * np.sign(np.linalg.det(u @ v))
    return (u @ np.diag([1.0, 1.0, hand]) @ v).T


def _shifted(index: dict[str, int], start: np.ndarray, shift: np.ndarray) -> np.ndarray:
    for axis, name in enumerate(PLACE):
        if name in index:
            start[index[name]] += shift[axis]
    return start
