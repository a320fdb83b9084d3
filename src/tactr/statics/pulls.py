"""Tendons pulled by displacements: what is asked, what came of it, how tensions answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr import _core

if TYPE_CHECKING:
    from tactr.robot import Robot

MET_SHARE = 0.1  # of the tolerance at the tip may be missing in a displacement
LARGEST = float(np.finfo(float).max)  # m, for a gap that is not known


@dataclass(frozen=True, eq=False)
class Pulls:
    """The tendons that are pulled by their displacement: n of them.

    index (n,) in the robot's order; displacement (n,) m; compliance (n,) m/N; reference (n,) m: length of the
    tendon at zero displacement and, were it not elastic, any tension. tolerance: m, of a gap.
    """

    index: np.ndarray
    displacement: np.ndarray
    compliance: np.ndarray
    reference: np.ndarray
    tolerance: float

    def gap(self, solution: _core.Solution) -> np.ndarray:
        """By how much the motor's displacement falls short of the tendon's, (n,), m; above 0: slack."""
        i = self.index
        return (
            self.reference
            - solution.tendon_length[i]
            + self.compliance * solution.tension[i]
            - self.displacement
        )

    def missed(self, solution: _core.Solution, shift: np.ndarray | float = 0.0) -> np.ndarray:
        """What of the gaps is wrong, (n,), m: any of a taut tendon, a negative one of a slack one. shift:
        added to the gaps."""
        gap = self.gap(solution) + shift
        return np.where(solution.tension[self.index] > 0.0, np.abs(gap), np.maximum(-gap, 0.0))

    def energy(self, prepared: _core.PreparedRobot, solution: _core.Solution) -> float:
        """Potential energy with the motors held, J: these do no work, the springs of the tendons are
        stretched; without what does not change."""
        tension, length = solution.tension[self.index], solution.tendon_length[self.index]
        springs = 0.5 * float(self.compliance @ tension**2)
        return _core.potential_energy(prepared, solution) - float(tension @ length) + springs

    def flexibility(self, prepared: _core.PreparedRobot, solution: _core.Solution) -> np.ndarray | None:
        """d gap / d tension, (n, n), m/N; None at a fold, where lengths jump."""
        try:
            lengths = _core.length_jacobian(prepared, solution)
        except RuntimeError:
            return None
        return np.diag(self.compliance) - lengths[np.ix_(self.index, self.index)]


@dataclass(frozen=True, eq=False)
class Pulled:
    """What a solve under displacements came to. missed (n,) m; solves: at held tensions; marches: in all of
    them. stable: whether the shape is with the motors held, None: not looked at. rested: whether there is a
    rest state to count from; solution is what was found for it where there is none. given_up: not all was
    tried that might have led on, for it would have taken too long."""

    pulls: Pulls
    solution: _core.Solution
    missed: np.ndarray
    solves: int
    marches: int
    stable: bool | None = None
    rested: bool = True
    given_up: bool = False

    @property
    def met(self) -> bool:
        """Whether every displacement is."""
        return self.rested and self.solution.status == 0 and bool((self.missed <= self.pulls.tolerance).all())

    @property
    def tension(self) -> np.ndarray:
        """Tensions of the pulled tendons, (n,), N."""
        return self.solution.tension[self.pulls.index]

    def slack(self, robot: Robot) -> tuple[str, ...]:
        """Names of the pulled tendons without tension."""
        return tuple(robot.tendons[j].name for j in self.pulls.index[self.tension == 0.0])


def is_stable(prepared: _core.PreparedRobot, pulls: Pulls, solution: _core.Solution) -> bool:
    """Whether a shape is stable with the motors held: as many directions of falling energy at held tensions
    as negative flexibilities of the taut tendons, each of which a held motor takes away (inertia of the
    bordered second variation, Haynsworth 1968). Not stable where that cannot be told: tubes all but
    crushed."""
    try:
        if _core.stability(prepared, solution, 0)[0]:
            return True
        falling = len(_core.stability(prepared, solution, 1)[4])  # without samples they are not located
    except RuntimeError:
        return False
    flexibility = pulls.flexibility(prepared, solution)
    if flexibility is None:
        return False
    taut = solution.tension[pulls.index] > 0.0
    part = flexibility[np.ix_(taut, taut)]
    return int((np.linalg.eigvalsh(0.5 * (part + part.T)) < 0.0).sum()) == falling
