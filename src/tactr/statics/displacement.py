"""Tensions that given displacements of tendons' motors bring about.

The least energy W of a robot at held tensions T has the lengths as its gradient, dW/dT = l(T), and is concave
where the robot is stable. With the motors' displacements d the tensions solve

    T >= 0,  F(T) = reference - l(T) + compliance T - d >= 0,  T F = 0,

a complementarity problem whose flexibility dF/dT is symmetric and positive semidefinite there: T is the
least of a convex function over T >= 0. Newton's method on it, each step a linear complementarity problem
(Josephy, 1979), each trial a solve at held tensions from the last one. Where that leads on no more, as at a
snap at held tensions, Newton's method on free end and tensions together (``joint``).

That stays on a branch, and long slender robots, or ones that tensions bend far, leave it at the smallest
steps. Then the trials are solved from cold: each is on a branch that a robot without a history would be on,
and Newton's full steps lead from one such branch to the next; where they do not, from tensions scattered
about those that the first step asks for.
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
SHORTEST, SHORTEST_COLD = 0.02, 0.2  # of a step
CHORD = 0.02  # a step that left less of the gaps goes on with the same flexibility
SCATTER = 4.0  # how many times more or less than the tension that a flexibility asks for
MOST_STARTS = 60
WORK_START, WORK_NEAR, WORK_COLD = 2.4e5, 4e4, 7e5  # see Held.allow: in all ways
WORK_LED, WORK_SCATTERED = 3e4, 7e5  # some seconds
WORK_EACH = 2e5  # in one of many cold solves


def low_discrepancy(k: int, count: int) -> np.ndarray:
    """Point number k of the additive recurrence with the generalised golden ratio (M. Roberts, 2018),
    (count,), in [0, 1)."""
    ratio = 1.5
    for _ in range(40):
        ratio = (1.0 + ratio) ** (1.0 / (count + 1))
    return (0.5 + (k + 1) * ratio ** -np.arange(1.0, count + 1)) % 1.0


class DisplacementSolver:
    """Newton on the tensions of the pulled tendons; held solves at tensions."""

    _best: _core.Solution  # from cold, so far

    def __init__(self, held: Held, pulls: Pulls, tension: np.ndarray) -> None:
        self._held = held
        self._joint = JointNewton(held, pulls)
        self._pulls = pulls
        self._tension = tension  # of all tendons; those pulled by displacement are to be found

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
        start, given_up = self._without_tension(), False
        ways = (
            (self._newton, WORK_NEAR, np.inf),
            (self._afresh, WORK_COLD, WORK_EACH),
            (self._led, WORK_LED, np.inf),
            (self._scattered, WORK_SCATTERED, WORK_EACH),
        )
        for way, work, each in ways if start.status == 0 else ():
            self._held.allow(work, each=each)
            try:
                self._offer(way(start))
            except GivenUp:
                given_up = True
            if self._good():
                break
        met = self._rank(self._best)[0] < 2
        return self._result(self._best, self._is_stable(self._best) if met else None, given_up=given_up)

    def _without_tension(self) -> _core.Solution:
        """In the pulled tendons; where the others' tensions alone are more than the tubes can take, without
        these, too."""
        none = np.zeros(len(self._pulls.index))
        self._held.allow(np.inf, each=WORK_START)
        self._best = self._solve(none, None)
        return self._best if self._best.status == 0 else self._solve(none, None, held=0.0)

    def _offer(self, solution: _core.Solution) -> None:
        """Kept if it is the best so far."""
        if self._is_whole(solution) and self._rank(solution) < self._rank(self._best):
            self._best = solution

    def _is_whole(self, solution: _core.Solution) -> bool:
        """Whether the tendons that have a tension are at it."""
        return np.array_equal(solution.tension, self._whole(solution.tension[self._pulls.index]))

    def _good(self) -> bool:
        return self._rank(self._best)[0] == 0

    def _rank(self, solution: _core.Solution) -> tuple[int, float]:
        """Smaller is better: met and stable, met, missed by so much, no shape."""
        if solution.status != 0:
            return 3, 0.0
        missed = self._missed(solution)
        if missed > self._pulls.tolerance:
            return 2, missed
        return (0, 0.0) if self._is_stable(solution) else (1, 0.0)

    def _is_stable(self, solution: _core.Solution) -> bool:
        return is_stable(self._held.prepared, self._pulls, solution)

    def _missed(self, solution: _core.Solution) -> float:
        if solution.status != 0:
            return LARGEST
        return float(self._pulls.missed(solution).max(initial=0.0))

    def _newton(self, solution: _core.Solution) -> _core.Solution:
        """On one branch: until no gap is missed, or no step leads on."""
        flexibility, aim = None, AIM_SHARE * self._pulls.tolerance
        missed = self._missed(solution)
        for _ in range(MOST_STEPS):
            if solution.status != 0 or missed <= aim:
                return solution
            if flexibility is None:
                flexibility = self._flexibility(solution)
            after = None if flexibility is None else self._step(solution, flexibility)
            if after is None:
                break
            before, missed, solution = missed, self._missed(after), after
            if missed > CHORD * before:
                flexibility = None
        together = self._joint.find(solution, self._whole(solution.tension[self._pulls.index]))
        return solution if together is None else together

    def _afresh(self, solution: _core.Solution) -> _core.Solution:
        """Each solve from cold, on whatever branch that finds, until free end and tensions together lead to a
        stable shape."""
        for _ in range(MOST_STEPS):
            found = self._joint.find(solution, self._whole(solution.tension[self._pulls.index]))
            if found is not None:
                if self._is_stable(found):
                    return found
                self._offer(found)
            flexibility = self._flexibility(solution)
            after = None if flexibility is None else self._step(solution, flexibility, cold=True)
            if after is None:
                break
            solution = after
            self._offer(solution)
        return solution

    def _led(self, start: _core.Solution) -> _core.Solution:
        """On one branch, the displacements growing from those that go with no tension."""
        found = self._joint.lead(start) if self._is_whole(start) else None
        return start if found is None else found

    def _scattered(self, start: _core.Solution) -> _core.Solution:
        """As ``_afresh``, from low-discrepancy tensions about those that each tendon would need alone."""
        flexibility = self._flexibility(start)
        if flexibility is None:
            return start
        own, gap = np.abs(np.diag(flexibility)), np.abs(self._pulls.gap(start))
        alone = np.divide(
            gap, own, out=np.zeros_like(gap), where=own > 0.0
        )  # 0: a rigid one inside the guide
        for k in range(MOST_STARTS):
            tension = alone * SCATTER ** (2.0 * low_discrepancy(k, len(alone)) - 1.0)
            solution = self._solve(tension, None)
            if solution.status == 0:
                self._offer(self._afresh(solution))
            if self._good():
                break
        return self._best

    def _step(
        self, solution: _core.Solution, flexibility: np.ndarray, *, cold: bool = False
    ) -> _core.Solution | None:
        """One step; shortened while it overshoots the least of the dual energy, whose slope along it is
        gap . step, and while no shape is found. None: no step leads on."""
        tension, gap = solution.tension[self._pulls.index], self._pulls.gap(solution)
        way = complementary_tension(flexibility, gap, tension) - tension
        slope, size = float(gap @ way), self._missed(solution)
        fraction = 1.0
        while fraction > (SHORTEST_COLD if cold else SHORTEST):
            ahead = np.maximum(tension + fraction * way, 0.0)
            trial = self._solve(ahead, None if cold else solution, stay=not cold)
            if trial.status != 0:
                fraction *= 0.3
                continue
            if self._missed(trial) <= (1.0 - 0.1 * fraction) * size:
                return trial
            after = float(self._pulls.gap(trial) @ way)
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
