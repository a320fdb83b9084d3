"""Lengths of tendons in the rest state, from which displacements count."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr import _core
from tactr.errors import NotConverged
from tactr.robot import Robot, TensionProfile
from tactr.statics.actuation import rotations, translations
from tactr.statics.assemble import assemble
from tactr.statics.pulls import LARGEST, MET_SHARE, Pulled, Pulls


class RestState:
    """The robot without loads, every tendon at its pretension; the state last asked for is remembered."""

    def __init__(
        self, robot: Robot, prepared: _core.PreparedRobot, tolerance: float, residual_tolerance: float
    ):
        self._robot = robot
        self._core = assemble(robot.replace(loads=())) if robot.loads else prepared
        self._tolerances = tolerance, residual_tolerance
        tendons = robot.tendons
        self.pretension = np.array([_pretension(robot, j) for j in range(len(tendons))], dtype=float)
        given = [np.nan if tendon.rest_length is None else tendon.rest_length for tendon in tendons]
        self._given = np.array(given, dtype=float)
        self._at: tuple[np.ndarray, np.ndarray] | None = None
        self.solution: _core.Solution | None = None  # the last

    def lengths(self, rotation: np.ndarray, translation: np.ndarray, *, needed: np.ndarray) -> np.ndarray:
        """Rest lengths (tendons,), m; NaN for tendons that are not needed (bool array) where that saves a
        solve. Raises NotConverged where there is no rest state."""
        if not np.isnan(self._given[needed]).any():
            return self._given
        return np.where(np.isnan(self._given), self.measured(rotation, translation), self._given)

    def measured(self, rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
        """Lengths (tendons,) in the rest state at these places of the tubes, m. Raises NotConverged."""
        solution = self.solution
        same = self._at is not None and all(map(np.array_equal, self._at, (rotation, translation)))
        if solution is None or not same:
            solution = _core.solve(self._core, self.pretension, rotation, translation, *self._tolerances)
            self._at, self.solution = (rotation.copy(), translation.copy()), solution
        if solution.status != 0:
            raise NotConverged(
                "the rest state was not found: the robot without loads, pulled only by pretensions"
            )
        return solution.tendon_length


def pulls_from(
    rest: RestState,
    arrays: Sequence[np.ndarray],
    displacement: np.ndarray,
    compliance: np.ndarray,
    tolerance: float,
) -> Pulls | Pulled:
    """The pulls of an actuation (tension, rotation, translation) and displacements, NaN where there is none;
    compliance of all tendons; tolerance at the tip. A failed Pulled where there is no rest state."""
    given = ~np.isnan(displacement)
    index, soft, asked = np.flatnonzero(given), compliance[given], displacement[given]
    allowed = MET_SHARE * tolerance
    try:
        lengths = rest.lengths(arrays[1], arrays[2], needed=given)[given]
    except NotConverged:
        solution = rest.solution
        assert solution is not None
        pulls = Pulls(index, asked, soft, np.zeros(len(index)), allowed)
        missed = np.full(len(index), LARGEST)
        return Pulled(pulls, solution, missed, 0, solution.iterations, rested=False)
    return Pulls(index, asked, soft, lengths - soft * rest.pretension[given], allowed)


def rest_lengths(robot: Robot, *, tolerance: float = 1e-6) -> dict[str, float]:
    """Length of every tendon in the rest state of a robot, m, by name.

    In the rest state there are no loads, the tubes are at the robot's rotations and translations, and every
    tendon is at its pretension. Written into the tendons as ``rest_length``, these lengths tie the tendons
    there: what the motors then pull stays, whatever the tubes do later. tolerance: as in ``solve``. Raises
    NotConverged.
    """
    from tactr.statics.solve import Prepared

    prepared = Prepared(robot, tolerance=tolerance, stations=2)
    lengths = prepared._rest.measured(rotations(robot), translations(robot))
    return {tendon.name: float(length) for tendon, length in zip(robot.tendons, lengths, strict=True)}


def _pretension(robot: Robot, j: int) -> float:
    """A profile counts by a factor, which is 0 at rest: only a plain tendon is pretensioned."""
    tendon = robot.tendons[j]
    return 0.0 if isinstance(tendon.tension, TensionProfile) else tendon.pretension
