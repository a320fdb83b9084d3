"""Tensions that given displacements of tendons' motors bring about.

The least energy W of a robot at held tensions T has the lengths as its gradient, dW/dT = l(T), and is concave
where the robot is stable. With the motors' displacements d the tensions solve

    T >= 0,  F(T) = reference - l(T) + compliance T - d >= 0,  T F = 0,

a complementarity problem whose flexibility dF/dT is symmetric and positive semidefinite there: T is the
least of a convex function over T >= 0. Newton's method on it, each step a linear complementarity problem
(Josephy, 1979), each trial a solve at held tensions from the last one. Where that leads on no more, as at a
snap at held tensions, Newton's method on free end and tensions together (``joint``).
"""

from __future__ import annotations

import numpy as np

from tactr import _core
from tactr.statics._complementary import complementary_tension
from tactr.statics.held import GivenUp, Held
from tactr.statics.joint import JointNewton
from tactr.statics.pulls import LARGEST, Pulled, Pulls, is_stable

AIM_SHARE = 0.1  # of what may be missing: where Newton stops
MOST_STEPS = 40
SHORTEST = 1e-4  # of a step
STAYING = 0.05  # a step still shorter may leave its branch,
MOST_JUMPS = 4  # though a solve that looks for another one costs a hundred others
FIRST_SHARE, LEAST_SHARE = 0.125, 2e-3  # of the way from no displacement, in one step
CLOSER = (0.5, 0.25)  # of the tensions
WORK_NEAR = 1.5e4  # steps marched from a guess,
WORK = 1.5e4  # in each way from cold: in all of them two or three seconds
CHORD = 0.02  # a step that left less of the gaps goes on with the same flexibility


class DisplacementSolver:
    """Newton on the tensions of the pulled tendons; held solves at tensions."""

    def __init__(self, held: Held, pulls: Pulls, tension: np.ndarray) -> None:
        self._held = held
        self._joint = JointNewton(held, pulls)
        self._pulls = pulls
        self._tension = tension  # of all tendons; those pulled by displacement are to be found
        self._jumps = MOST_JUMPS
        self._last: _core.Solution | None = None  # that Newton's method came to

    def from_guess(self, guess: _core.Solution, *, stay: bool = False) -> Pulled | None:
        """From a neighbour and its tensions; stay: on its branch. None: not found."""
        start = np.maximum(guess.tension[self._pulls.index], 0.0)
        self._held.allow(WORK_NEAR)
        try:
            found = self._joint.find(guess, self._whole(start))
            if found is None and not stay:
                found = self._newton(self._solve(start, guess))
        except GivenUp:
            return None
        result = None if found is None else self._result(found)
        return result if result is not None and result.met else None

    def from_cold(self) -> Pulled:
        """From no tension, in one way after the other, until one meets the displacements in a stable
        shape."""
        self._held.allow(np.inf)
        best = self._last = self._solve(np.zeros(len(self._pulls.index)), None)
        given_up = False
        for way in (self._newton, self._led, self._gradually, self._again, self._closer):
            self._held.allow(WORK)
            start = best if way == self._newton else self._last
            try:
                found = way(start)
            except GivenUp:
                found, given_up = self._last, True
            if self._rank(found) < self._rank(best):
                best = found
            if self._good(best):
                break
        met = self._rank(best)[0] < 2
        return self._result(best, self._is_stable(best) if met else None, given_up=given_up)

    def _led(self, first: _core.Solution) -> _core.Solution:
        """From no tension, the displacements growing from those that go with it."""
        start = self._solve(np.zeros(len(self._pulls.index)), None)
        found = self._joint.lead(start) if start.status == 0 else None
        return first if found is None else found

    def _is_stable(self, solution: _core.Solution) -> bool:
        return is_stable(self._held.prepared, self._pulls, solution)

    def _good(self, solution: _core.Solution) -> bool:
        return self._rank(solution)[0] == 0 and self._is_stable(solution)

    def _rank(self, solution: _core.Solution) -> tuple[int, float]:
        """Smaller is better."""
        if solution.status != 0:
            return 3, 0.0
        missed = float(self._pulls.missed(solution).max(initial=0.0))
        if missed > self._pulls.tolerance:
            return 2, missed
        return (0, 0.0) if self._is_stable(solution) else (1, 0.0)

    def _again(self, first: _core.Solution) -> _core.Solution:
        """From a cold solve at the tensions found: perhaps another branch."""
        if first.status != 0:
            return first
        return self._newton(self._solve(first.tension[self._pulls.index], None))

    def _closer(self, first: _core.Solution) -> _core.Solution:
        """From cold solves at parts of the tensions at which Newton's method stopped, perhaps at a snap."""
        best = first
        for share in CLOSER if first.status == 0 else ():
            found = self._newton(self._solve(share * first.tension[self._pulls.index], None))
            best = min(best, found, key=self._rank)
            if self._good(best):
                break
        return best

    def _gradually(self, first: _core.Solution) -> _core.Solution:
        """Growing displacements, from those that leave every tendon just without tension, and growing held
        tensions: these alone may bend the tubes beyond what they can take. Where the branch ends or loses its
        stability it is left for what a cold solve finds there."""
        ahead = np.zeros(len(self._pulls.index))
        solution = self._solve(ahead, None, held=0.0)
        if solution.status != 0:
            return first
        ahead = np.maximum(-self._pulls.gap(solution), 0.0)
        done, share, landings = 0.0, FIRST_SHARE, MOST_JUMPS
        while done < 1.0:
            to = min(1.0, done + share)
            found = self._carried(solution, to, ahead, stay=True)
            if found is None and share < LEAST_SHARE and landings > 0:
                landings -= 1
                found, share = self._carried(solution, to, ahead, stay=False), FIRST_SHARE
            if found is not None:
                solution, done, share = found, to, 1.7 * share
            elif share < LEAST_SHARE:
                return first
            else:
                share *= 0.4
        return solution

    def _carried(
        self, solution: _core.Solution, to: float, ahead: np.ndarray, *, stay: bool
    ) -> _core.Solution | None:
        """A stable shape at a part of the displacements and held tensions; None: not found."""
        if stay:
            whole = self._whole(solution.tension[self._pulls.index], to)
            found = self._joint.find(solution, whole, (1.0 - to) * ahead)
            if found is not None and self._is_stable(found):
                return found
        guess = solution if stay else None
        start = self._solve(solution.tension[self._pulls.index], guess, stay=stay, held=to)
        found = self._newton(start, shift=(1.0 - to) * ahead, held=to)
        met = self._missed(found, (1.0 - to) * ahead) <= self._pulls.tolerance
        return found if met and self._is_stable(found) else None

    def _missed(self, solution: _core.Solution, shift: np.ndarray | float = 0.0) -> float:
        if solution.status != 0:
            return LARGEST
        return float(self._pulls.missed(solution, shift).max(initial=0.0))

    def _newton(
        self, solution: _core.Solution, shift: np.ndarray | float = 0.0, held: float = 1.0
    ) -> _core.Solution:
        """Until no gap is missed, or no step leads on. shift: added to the gaps, m; held: of the tensions of
        the tendons that have one."""
        flexibility, aim = None, AIM_SHARE * self._pulls.tolerance
        missed = self._missed(solution, shift)
        for _ in range(MOST_STEPS):
            if solution.status != 0 or missed <= aim:
                return solution
            if flexibility is None:
                flexibility = self._flexibility(solution)
            after = None if flexibility is None else self._step(solution, flexibility, shift, held)
            if after is None:
                break
            before, missed, solution = missed, self._missed(after, shift), after
            self._last = solution
            if missed > CHORD * before:
                flexibility = None
        together = self._joint.find(solution, self._whole(solution.tension[self._pulls.index], held), shift)
        return solution if together is None else together

    def _step(
        self, solution: _core.Solution, flexibility: np.ndarray, shift: np.ndarray | float, held: float
    ) -> _core.Solution | None:
        """One step; shortened while it overshoots the least of the dual energy, whose slope along it is
        gap . step, and while no shape is found. None: no step leads on."""
        tension, gap = solution.tension[self._pulls.index], self._pulls.gap(solution) + shift
        way = complementary_tension(flexibility, gap, tension) - tension
        slope, size = float(gap @ way), self._missed(solution, shift)
        fraction = 1.0
        while fraction > SHORTEST:
            ahead, stay = np.maximum(tension + fraction * way, 0.0), fraction > STAYING or self._jumps == 0
            self._jumps -= not stay
            trial = self._solve(ahead, solution, stay=stay, held=held)
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

    def _whole(self, tension: np.ndarray, held: float = 1.0) -> np.ndarray:
        whole = held * self._tension
        whole[self._pulls.index] = tension
        return whole

    def _solve(
        self, tension: np.ndarray, guess: _core.Solution | None, *, stay: bool = False, held: float = 1.0
    ) -> _core.Solution:
        return self._held.solve(self._whole(tension, held), guess, stay=stay)

    def _flexibility(self, solution: _core.Solution) -> np.ndarray | None:
        """d gap / d tension, (n, n), m/N; None at a fold, where lengths jump."""
        return self._pulls.flexibility(self._held.prepared, solution)

    def _result(
        self, solution: _core.Solution, stable: bool | None = None, *, given_up: bool = False
    ) -> Pulled:
        missed = (
            self._pulls.missed(solution) if solution.status == 0 else np.full(len(self._pulls.index), LARGEST)
        )
        solves, marches = self._held.solves, self._held.marches
        return Pulled(self._pulls, solution, missed, solves, marches, stable, given_up=given_up)
