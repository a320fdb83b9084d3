"""Tensions that given displacements of tendons' motors bring about.

The least energy W of a robot at held tensions T has the lengths as its gradient, dW/dT = l(T), and is concave
where the robot is stable. With the motors' displacements d the tensions solve

    T >= 0,  F(T) = reference - l(T) + compliance T - d >= 0,  T F = 0,

a complementarity problem whose flexibility dF/dT is symmetric and positive semidefinite there: T is the
least of a convex function over T >= 0. Newton's method on it, each step a linear complementarity problem
(Josephy, 1979), each trial a solve at held tensions from the last one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr import _core
from tactr.statics._complementary import SINGULAR, complementary_tension

if TYPE_CHECKING:
    from tactr.robot import Robot

MET_SHARE = 0.1  # of the tolerance at the tip may be missing in a displacement
AIM_SHARE = 0.1  # of what may be missing: where Newton stops
MOST_STEPS = 40
SHORTEST = 1e-4  # of a step
LARGEST = float(np.finfo(float).max)  # m, for a gap that is not known
CHORD = 0.02  # a step that left less of the gaps goes on with the same flexibility

Trial = Callable[[np.ndarray, "_core.Solution | None", bool], "_core.Solution"]


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

    def missed(self, solution: _core.Solution) -> np.ndarray:
        """What of the gaps is wrong, (n,), m: any of a taut tendon, a negative one of a slack one."""
        gap = self.gap(solution)
        return np.where(solution.tension[self.index] > 0.0, np.abs(gap), np.maximum(-gap, 0.0))


@dataclass(frozen=True, eq=False)
class Pulled:
    """What a solve under displacements came to. missed (n,) m; solves: at held tensions; marches: in all of
    them. stable: whether the shape is with the motors held, None: not looked at. rested: whether there is a
    rest state to count from; solution is what was found for it where there is none."""

    pulls: Pulls
    solution: _core.Solution
    missed: np.ndarray
    solves: int
    marches: int
    stable: bool | None = None
    rested: bool = True

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

    def tension_jacobian(self, prepared: _core.PreparedRobot) -> np.ndarray:
        """d tension / d displacement of all m tendons, (m, m), N/m; 0 in rows and columns of slack ones.

        By the implicit function theorem from the gaps of the taut tendons; where these do not tell the
        tensions apart (tendons without compliance side by side), the least change of tension.
        """
        m = len(self.solution.tension)
        taut = self.pulls.index[self.tension > 0.0]
        compliance = self.pulls.compliance[self.tension > 0.0]
        flexibility = np.diag(compliance) - _core.length_jacobian(prepared, self.solution)[np.ix_(taut, taut)]
        whole = np.zeros((m, m))
        whole[np.ix_(taut, taut)] = np.linalg.pinv(flexibility, rcond=SINGULAR, hermitian=False)
        return whole


class DisplacementSolver:
    """Newton on the tensions of the pulled tendons; trial(tension, guess, stay) solves at held tensions."""

    def __init__(
        self, prepared: _core.PreparedRobot, trial: Trial, pulls: Pulls, tension: np.ndarray
    ) -> None:
        self._prepared = prepared
        self._trial = trial
        self._pulls = pulls
        self._tension = tension  # of all tendons; those pulled by displacement are to be found
        self._solves = self._marches = 0

    def from_guess(self, guess: _core.Solution) -> Pulled:
        """From a neighbour and its tensions."""
        start = np.maximum(guess.tension[self._pulls.index], 0.0)
        return self._result(self._newton(self._solve(start, guess)))

    def from_cold(self) -> Pulled:
        """From no tension, then, if need be, in other ways."""
        first = best = self._newton(self._solve(np.zeros(len(self._pulls.index)), None))
        for attempt in (self._again, self._gradually):
            if self._good(best):
                break
            found = attempt(first)
            if self._rank(found) < self._rank(best):
                best = found
        stable = self.is_stable(best) if best.status == 0 else None
        return self._result(best, stable)

    def is_stable(self, solution: _core.Solution) -> bool:
        """Whether a shape is stable with the motors held: as many directions of falling energy at held
        tensions as negative flexibilities of the taut tendons, each of which a held motor takes away (inertia
        of the bordered second variation, Haynsworth 1968)."""
        falling = len(_core.stability(self._prepared, solution, 0)[4])
        if falling == 0:
            return True
        taut = solution.tension[self._pulls.index] > 0.0
        flexibility = self._flexibility(solution)[np.ix_(taut, taut)]
        negative = int((np.linalg.eigvalsh(0.5 * (flexibility + flexibility.T)) < 0.0).sum())
        return negative == falling

    def _good(self, solution: _core.Solution) -> bool:
        return self._rank(solution)[0] == 0 and self.is_stable(solution)

    def _rank(self, solution: _core.Solution) -> tuple[int, float]:
        """Smaller is better."""
        if solution.status != 0:
            return 3, 0.0
        missed = float(self._pulls.missed(solution).max(initial=0.0))
        if missed > self._pulls.tolerance:
            return 2, missed
        return (0, 0.0) if self.is_stable(solution) else (1, 0.0)

    def _again(self, first: _core.Solution) -> _core.Solution:
        """From a cold solve at the tensions found: perhaps another branch."""
        if first.status != 0:
            return first
        return self._newton(self._solve(first.tension[self._pulls.index], None))

    def _gradually(self, first: _core.Solution) -> _core.Solution:
        """Growing displacements, from those that leave every tendon just without tension."""
        solution = self._solve(np.zeros(len(self._pulls.index)), None)
        if solution.status != 0:
            return first
        ahead = np.maximum(-self._pulls.gap(solution), 0.0)
        done, share = 0.0, 0.125
        while done < 1.0 and share > 2e-3:
            to = min(1.0, done + share)
            found = self._newton(solution, shift=(1.0 - to) * ahead)
            if found.status == 0 and self._missed(found, (1.0 - to) * ahead) <= self._pulls.tolerance:
                solution, done, share = found, to, 1.7 * share
            else:
                share *= 0.4
        return self._newton(solution)

    def _missed(self, solution: _core.Solution, shift: np.ndarray | float = 0.0) -> float:
        if solution.status != 0:
            return LARGEST
        gap = self._pulls.gap(solution) + shift
        taut = solution.tension[self._pulls.index] > 0.0
        return float(np.where(taut, np.abs(gap), np.maximum(-gap, 0.0)).max(initial=0.0))

    def _newton(self, solution: _core.Solution, shift: np.ndarray | float = 0.0) -> _core.Solution:
        """Until no gap is missed, or no step leads on. shift: added to the gaps, m."""
        flexibility, aim = None, AIM_SHARE * self._pulls.tolerance
        missed = self._missed(solution, shift)
        for _ in range(MOST_STEPS):
            if solution.status != 0 or missed <= aim:
                break
            if flexibility is None:
                flexibility = self._flexibility(solution)
            after = self._step(solution, flexibility, shift)
            if after is None:
                break
            before, missed, solution = missed, self._missed(after, shift), after
            if missed > CHORD * before:
                flexibility = None
        return solution

    def _step(
        self, solution: _core.Solution, flexibility: np.ndarray, shift: np.ndarray | float
    ) -> _core.Solution | None:
        """One step; shortened while it overshoots the least of the dual energy, whose slope along it is
        gap . step, and while no shape is found. None: no step leads on."""
        tension, gap = solution.tension[self._pulls.index], self._pulls.gap(solution) + shift
        way = complementary_tension(flexibility, gap, tension) - tension
        slope, size = float(gap @ way), self._missed(solution, shift)
        fraction = 1.0
        while fraction > SHORTEST:
            trial = self._solve(np.maximum(tension + fraction * way, 0.0), solution, stay=fraction > 0.05)
            if trial.status != 0:
                fraction *= 0.3
                continue
            if self._missed(trial, shift) <= (1.0 - 0.1 * fraction) * size:
                return trial
            after = float((self._pulls.gap(trial) + shift) @ way)
            if slope < 0.0 and after <= -0.9 * slope:
                return trial
            fraction *= min(max(slope / (slope - after), 0.1), 0.7) if slope < 0.0 < after else 0.3
        return None

    def _solve(
        self, tension: np.ndarray, guess: _core.Solution | None, *, stay: bool = False
    ) -> _core.Solution:
        whole = self._tension.copy()
        whole[self._pulls.index] = tension
        solution = self._trial(whole, guess, stay and guess is not None)
        self._solves += 1
        self._marches += solution.iterations
        return solution

    def _flexibility(self, solution: _core.Solution) -> np.ndarray:
        """d gap / d tension, (n, n), m/N."""
        i = self._pulls.index
        return np.diag(self._pulls.compliance) - _core.length_jacobian(self._prepared, solution)[np.ix_(i, i)]

    def _result(self, solution: _core.Solution, stable: bool | None = None) -> Pulled:
        missed = (
            self._pulls.missed(solution) if solution.status == 0 else np.full(len(self._pulls.index), LARGEST)
        )
        return Pulled(self._pulls, solution, missed, self._solves, self._marches, stable)
