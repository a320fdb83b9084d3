"""Where the page looks from."""

from __future__ import annotations

import numpy as np

from tactr.robot import Robot

FIELD_OF_VIEW = 0.6
DIRECTION = np.array([0.85, -1.0, 0.42])


def first_look(robot: Robot, points: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Position of the camera and what it looks at, (3,) m, so that points (n, 3) fill the view."""
    reach = max(tube.tip for tube in robot.tubes)
    seen = np.zeros((1, 3)) if points is None else points
    seen = np.concatenate([seen, [[0.0, 0.0, 0.0], [0.0, 0.0, 0.6 * reach]]])
    low, high = seen.min(axis=0), seen.max(axis=0)
    middle, radius = 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))
    distance = 1.25 * radius / np.tan(0.5 * FIELD_OF_VIEW)
    return middle + distance * DIRECTION / np.linalg.norm(DIRECTION), middle
