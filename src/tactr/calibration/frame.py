"""Where the marker is on the robot, and the robot in the sensor's axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.robot import _check as check

Vector3 = tuple[float, float, float]


@dataclass(frozen=True)
class Frame:
    """marker: m, from the tip, in the material frame of the innermost tube there. position: m, of the robot's
    origin in the sensor's axes; rotation: rad, rotation vector from the robot's axes to the sensor's. A point
    p of the robot is measured at R(rotation) p + position. Raises RobotError."""

    marker: Vector3 = (0.0, 0.0, 0.0)
    position: Vector3 = (0.0, 0.0, 0.0)
    rotation: Vector3 = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        with check.owned("Frame"):
            for name, unit in (("marker", "m"), ("position", "m"), ("rotation", "rad")):
                check.store(self, **{name: check.vector(name, getattr(self, name), unit)})

    @property
    def matrix(self) -> np.ndarray:
        """R, (3, 3)."""
        return rotation_matrix(np.array(self.rotation))


def rotation_matrix(vector: np.ndarray) -> np.ndarray:
    """exp [v], (3, 3): Rodrigues's formula."""
    angle, K = float(np.linalg.norm(vector)), cross_matrix(vector)
    return np.eye(3) + np.sinc(angle / np.pi) * K + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * K @ K


def rotation_rates(vector: np.ndarray) -> np.ndarray:
    """Columns: the spatial angular rates of exp [v] with v, (3, 3): the left Jacobian of the rotations."""
    angle, K = float(np.linalg.norm(vector)), cross_matrix(vector)
    cube = 1.0 / 6.0 - angle**2 / 120.0 if angle < 1e-3 else (angle - np.sin(angle)) / angle**3
    return np.eye(3) + 0.5 * np.sinc(0.5 * angle / np.pi) ** 2 * K + cube * K @ K


def cross_matrix(v: np.ndarray) -> np.ndarray:
    """[v], (3, 3), with [v] w = v x w."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
