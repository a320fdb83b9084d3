"""tactr's kernel: statics of tendon-actuated concentric tubes, from the free end to the base. SI units."""

import numpy as np

MAX_TUBES: int

class PreparedRobot:
    """A robot as flat arrays, ready to be solved many times."""

    def __init__(
        self,
        tubes: np.ndarray,
        pieces: np.ndarray,
        tendons: np.ndarray,
        routing: np.ndarray,
        profiles: np.ndarray,
        point_loads: np.ndarray,
        distributed_loads: np.ndarray,
    ) -> None: ...

class Solution:
    """What a solve found."""

    status: int
    iterations: int
    base_residual: float
    section_residual: float
    discretisation_error: float
    least_stretch: float
    shortest_tendon: float
    base_determinant: float
    used_continuation: bool
    stability: int
    switched: bool
    steps: list[int]
    free_end_psi: np.ndarray
    tension: np.ndarray
    tendon_length: np.ndarray
    tip_position: np.ndarray
    tip_quaternion: np.ndarray

def solve(
    robot: PreparedRobot,
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    tolerance: float,
    residual_tolerance: float,
    guess: Solution | None = None,
    steps: int = 0,
    stay: bool = False,
) -> Solution:
    """Free-end unknowns, residuals and tip of one robot at one actuation."""

def branches(
    robot: PreparedRobot,
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    tolerance: float,
    residual_tolerance: float,
    samples: int = 0,
) -> list[Solution]:
    """All equilibria found at one actuation, stable ones first, then by energy."""

def stability(
    robot: PreparedRobot, solution: Solution, samples: int
) -> tuple[bool, float, np.ndarray, np.ndarray, np.ndarray]:
    """Stable, margin, s, determinant, conjugate points."""

def energy(robot: PreparedRobot, solution: Solution) -> float:
    """Potential energy, J."""

def free_end_distance(robot: PreparedRobot, a: Solution, b: Solution) -> float:
    """Largest turn between two free ends, rad."""

def tip_jacobian(robot: PreparedRobot, solution: Solution) -> np.ndarray:
    """d(tip position, tip rotation)/d(tensions, rotations)."""

def sample(robot: PreparedRobot, solution: Solution, stations: np.ndarray) -> dict[str, np.ndarray]:
    """Shape of a converged solution at ascending s."""
