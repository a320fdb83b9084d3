"""tactr's kernel: statics of tendon-actuated concentric tubes, from the free end to the base. SI units."""

from typing import Any

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
    steps_marched: int
    base_residual: float
    section_residual: float
    discretisation_error: float
    least_stretch: float
    shortest_tendon: float
    amplification: float
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
    most_steps: int = ...,
    patience: int = ...,
) -> Solution:
    """Free-end unknowns, residuals and tip of one robot at one actuation."""

def sensitivities(
    robot: PreparedRobot,
    solution: Solution,
    stations: np.ndarray,
    lengths: bool,
    actuators: bool,
    probe: float,
    rates: list[PreparedRobot],
) -> np.ndarray:
    """Exact derivatives. Rows: tip, stations, lengths; columns: actuators, wrench, parameters."""

def length_jacobian(robot: PreparedRobot, solution: Solution) -> np.ndarray:
    """d(tendon lengths)/d(tensions)."""

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

def joint_march(
    robot: PreparedRobot,
    neighbour: Solution,
    step: np.ndarray,
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    tolerance: float,
) -> tuple[Solution, np.ndarray, np.ndarray] | None:
    """One march from a moved free end: a solution to go on from, which may miss the base; by how much;
    d(missed, lengths)/d(free end, tensions). None: a section had no equilibrium."""

def potential_energy(robot: PreparedRobot, solution: Solution) -> float:
    """Potential energy, J."""

def free_end_distance(robot: PreparedRobot, a: Solution, b: Solution) -> float:
    """Largest turn between two free ends, rad."""

class RubbingModel:
    """An equilibrium with friction between tubes, and how it answers."""

def friction_step(
    robot: PreparedRobot,
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    tolerance: float,
    residual_tolerance: float,
    nodes: np.ndarray,
    guess: Solution | None = None,
    model: RubbingModel | None = None,
    stay: bool = False,
) -> dict[str, Any]:
    """One step of friction between tubes: robot with the torques, solution, torque, twist and limit at the
    nodes. model: of the guess, which makes it fast."""

class FrictionChannels:
    """Where tendons rub."""

    def __init__(self, rows: list[tuple[int, int, float, list, list | None, list]]) -> None:
        """rows: tendon, tube, end, pieces of friction, contacts or None, cuts; in order of the tendons."""

class FrictionSettled:
    """One equilibrium with friction of tendons; profiles: None, or edges, Chebyshev coefficients, slides and
    driven of log tension, by channel."""

    robot: PreparedRobot
    solution: Solution
    profiles: list[tuple[np.ndarray, np.ndarray, tuple[int, ...], tuple[bool, ...]] | None]
    missed: float
    rounds: int
    def __init__(self, robot: PreparedRobot, solution: Solution, at: list[float]) -> None:
        """Without tendons that rub."""

class FrictionRounds:
    """Rounds of profiles, shape and wraps."""

    missed: float
    rounds: int

    def __init__(
        self,
        plain: PreparedRobot,
        channels: FrictionChannels,
        old: FrictionSettled | list,
        at: list[float],
        translation: np.ndarray,
        precision: float,
    ) -> None:
        """old: of an equilibrium, or edges and Chebyshev coefficients of log tension before, None without
        tension; by channel. at: what actuators pass on. precision: rad, to which shapes are found."""

    def start_plain(self, solution: Solution) -> None:
        """From the wraps in a shape without friction."""

    def start_near(self, near: FrictionSettled, past: list[FrictionSettled]) -> None:
        """Carried on from what was found before near, the latest first."""

    def profile(self, tension: np.ndarray) -> PreparedRobot:
        """The robot with profiles at these tensions at the base."""

    def measure(self, robot: PreparedRobot, solution: Solution) -> bool:
        """Reads the wraps in the round's shape; whether it could."""

    def mix(self, tension: np.ndarray, next: np.ndarray) -> np.ndarray:
        """Wraps and tensions to go on with."""

    def rates(self, still: PreparedRobot, channel: int, tension: float, all: bool) -> PreparedRobot:
        """Rates as a channel's tension at the base grows by 1 N: of what follows the base, or of all."""

    def slack(self, channel: int) -> bool:
        """Whether a channel's tendon is."""

    def settled(self, robot: PreparedRobot, solution: Solution) -> FrictionSettled:
        """The round as an equilibrium."""

    def run(
        self,
        tension: np.ndarray,
        rotation: np.ndarray,
        translation: np.ndarray,
        tolerance: float,
        residual_tolerance: float,
        guess: Solution,
        stay: bool,
    ) -> FrictionSettled | None:
        """All rounds at given tensions; None: not found."""

def tendon_friction_step(
    plain: PreparedRobot,
    channels: FrictionChannels,
    old: FrictionSettled | list,
    near: FrictionSettled,
    past: list[FrictionSettled],
    at: list[float],
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    tolerance: float,
    residual_tolerance: float,
    limits: tuple[float, float] | None,
) -> tuple[FrictionSettled | None, float, list[float], list[float]]:
    """The next equilibrium; what was missed of its history; heat, J, and creep, m, by channel. limits: of
    history missed and turn, rad; None: not found, or beyond them, or no longer stable."""

def tendon_friction_way(
    plain: PreparedRobot,
    channels: FrictionChannels,
    old: FrictionSettled | list,
    found: list[FrictionSettled],
    stride: float,
    points: np.ndarray,
    tolerance: float,
    residual_tolerance: float,
    cuts: tuple[float, float, float, float, float],
) -> tuple[list[tuple[FrictionSettled, int, list[float], list[float], float]], list[FrictionSettled], float]:
    """Along points (k, numbers), as far as they are reached: equilibrium, steps, heat, J, and creep, m, by
    channel, seconds; what was found last, and the stride to go on with. found: where the way starts, and
    what was found before, the latest first. cuts: limits of history missed and of turn, rad, of a step, the
    shortest of the way between two points, and how careful and stretched steps are."""

def friction_spent(
    channels: FrictionChannels, before: FrictionSettled, after: FrictionSettled
) -> tuple[list[float], list[float]]:
    """By channel: heat of a step, J, and creep after it, m: the largest slip at a place since the tendon
    last slid there, of which after remembers where that was."""

def friction_history_missed(
    channels: FrictionChannels, before: FrictionSettled, after: FrictionSettled, enough: float
) -> float:
    """What one step misses of log tension that small ones would have seen; closer where more than enough."""

def sample(robot: PreparedRobot, solution: Solution, stations: np.ndarray) -> dict[str, np.ndarray]:
    """Shape of a converged solution at ascending s."""

def contacts(
    robot: PreparedRobot, solution: Solution, stations: np.ndarray
) -> dict[str, dict[str, np.ndarray]]:
    """What tubes exert on each other: along s, and at points."""

def energetics(robot: PreparedRobot, solution: Solution) -> dict[str, Any]:
    """Energies, and the torques and forces of the actuators."""

def solve_batch(
    robots: list[PreparedRobot],
    tension: np.ndarray,
    rotation: np.ndarray,
    translation: np.ndarray,
    residual_tolerance: np.ndarray,
    skip: np.ndarray,
    stations: np.ndarray,
    tolerance: float,
    most_steps: int,
    outputs: list[str],
    threads: int,
    lanes: str = ...,
    device: int = ...,
) -> dict[str, np.ndarray]:
    """Many configurations from cold, a row for each."""

def strain_maxima(robot: PreparedRobot, solution: Solution, stations: np.ndarray) -> np.ndarray:
    """Largest |u - u*|, |v - v*| of every tube, (tubes, 6)."""
