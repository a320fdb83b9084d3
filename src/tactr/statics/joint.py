"""Newton's method on free end and tensions together, for tendons pulled by displacements.

At held tensions a branch may end at a fold that it passes smoothly at held displacements: there the shape is
no function of the tensions. With the base missed by r(x, T) at a free end x, and gaps F(x, T) of the motors
(see ``displacement``), each step takes r = 0 and the complementarity of T and F to first order; x eliminated,
a linear complementarity problem in T remains. A step is good where the next one is shorter (natural
monotonicity: Deuflhard, Newton Methods for Nonlinear Problems, 2004, ch. 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tactr import _core
from tactr.statics._complementary import complementary_tension
from tactr.statics.held import Held
from tactr.statics.pulls import Pulls

MOST_STEPS, MOST_ROUNDS = 8, 4
SHORTEST = 0.1  # of a step
MOST_LEGS, SHORTEST_LEG = 40, 0.01  # of the way from other displacements
LONGEST = 0.5  # rad at the free end, in one step
AIM_SHARE = 0.1  # of what may be missing


class _Point(NamedTuple):
    """One march, and Newton's step from there: missed (n,) rad at the base, gap (p,) m; turn (n,) rad of the
    free end, pull (p,) N of the tensions."""

    solution: _core.Solution
    missed: np.ndarray
    gap: np.ndarray
    turn: np.ndarray
    pull: np.ndarray


class JointNewton:
    """Finds an equilibrium under displacements from a neighbour's free end and tensions."""

    def __init__(self, held: Held, pulls: Pulls) -> None:
        self._held = held
        self._pulls = pulls

    def find(
        self, guess: _core.Solution, tension: np.ndarray, shift: np.ndarray | float = 0.0
    ) -> _core.Solution | None:
        """A converged solution that meets the displacements, or None. tension: of all tendons, where those
        pulled by displacements start; shift: added to the gaps, m."""
        near, last = guess, np.inf
        for _ in range(MOST_ROUNDS):  # finer steps may move the shape
            point = self._newton(near, tension, shift)
            if point is None:
                return None
            near = self._held.solve(point.solution.tension, point.solution, stay=True)
            if near.status != 0:
                return None
            missed = self._pulls.missed(near, shift).max(initial=0.0)
            if missed <= AIM_SHARE * self._pulls.tolerance:
                return near
            if missed > 0.5 * last:
                break
            tension, last = near.tension, missed
        return near if missed <= self._pulls.tolerance else None

    def lead(self, branch: _core.Solution) -> _core.Solution | None:
        """From an equilibrium at any tensions to the displacements: these go straight from what the motors
        pull there to what is asked for, the branch is kept."""
        ahead, done, step = -self._pulls.gap(branch), 0.0, 1.0
        for _ in range(MOST_LEGS):
            if done == 1.0:
                return branch
            to = min(1.0, done + step)
            found = self.find(branch, branch.tension, (1.0 - to) * ahead)
            if found is None:
                step *= 0.4
                if step < SHORTEST_LEG:
                    break
            else:
                branch, done, step = found, to, 1.7 * step
        return branch if done == 1.0 else None

    def _newton(self, guess: _core.Solution, tension: np.ndarray, shift: np.ndarray | float) -> _Point | None:
        point = self._march(guess, np.zeros(0), tension, shift)
        if point is None:
            return None
        strength = max(float(np.abs(point.pull).max(initial=0.0)), float(tension.max(initial=0.0)), 1e-300)
        for _ in range(MOST_STEPS):
            if point is None or self._is_met(point):
                return point
            point = self._step(point, shift, strength)
        return None

    def _step(self, point: _Point, shift: np.ndarray | float, strength: float) -> _Point | None:
        size, longest = _size(point, strength), float(np.abs(point.turn).max(initial=0.0))
        fraction = min(1.0, LONGEST / longest) if longest > 0.0 else 1.0
        least, index = SHORTEST * fraction, self._pulls.index
        while fraction > least:
            tension = point.solution.tension.copy()
            tension[index] = np.maximum(tension[index] + fraction * point.pull, 0.0)
            after = self._march(point.solution, fraction * point.turn, tension, shift)
            if after is not None and (
                _size(after, strength) <= (1.0 - 0.25 * fraction) * size or self._is_met(after)
            ):
                return after
            fraction *= 0.4
        return None

    def _march(
        self, guess: _core.Solution, turn: np.ndarray, tension: np.ndarray, shift: np.ndarray | float
    ) -> _Point | None:
        found = self._held.joint_march(guess, turn, tension)
        if found is None:
            return None
        solution, missed, matrix = found
        gap = self._pulls.gap(solution) + shift
        way = self._way(solution, missed, matrix, gap)
        return None if way is None else _Point(solution, missed, gap, *way)

    def _way(
        self, solution: _core.Solution, missed: np.ndarray, matrix: np.ndarray, gap: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Newton's step: of the free end (n,), rad, and of the pulled tendons' tensions (p,), N. matrix:
        d(missed, lengths)/d(free end, tensions)."""
        n, index = len(missed), self._pulls.index
        tension, columns = solution.tension[index], n + index
        rates, by_tension = matrix[:n, :n], matrix[:n, columns]
        lengths, stretch = matrix[columns, :n], matrix[np.ix_(columns, columns)]
        try:
            back = np.linalg.solve(rates, np.column_stack([missed, by_tension]))
        except np.linalg.LinAlgError:
            return None
        flexibility = np.diag(self._pulls.compliance) - stretch + lengths @ back[:, 1:]
        ahead = gap + lengths @ back[:, 0]
        if not (np.isfinite(flexibility).all() and np.isfinite(ahead).all()):
            return None
        pull = complementary_tension(flexibility, ahead, tension) - tension
        return -back[:, 0] - back[:, 1:] @ pull, pull

    def _is_met(self, point: _Point) -> bool:
        taut = point.solution.tension[self._pulls.index] > 0.0
        gap = float(np.where(taut, np.abs(point.gap), np.maximum(-point.gap, 0.0)).max(initial=0.0))
        turn = float(np.abs(point.missed).max(initial=0.0))
        return turn <= 10.0 * self._held.residual_tolerance and gap <= AIM_SHARE * self._pulls.tolerance


def _size(point: _Point, strength: float) -> float:
    """Of Newton's step: rad, or of a tension that counts as one."""
    turn = float(np.abs(point.turn).max(initial=0.0))
    return max(turn, float(np.abs(point.pull).max(initial=0.0)) / strength)
