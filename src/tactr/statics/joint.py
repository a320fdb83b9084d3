"""Newton's method on free end and tensions together, for tendons pulled by displacements.

At held tensions a branch may end at a fold that it passes smoothly at held displacements: there the shape is no
function of the tensions. With the base missed by r(x, T) at a free end x, and gaps F(x, T) of the motors (see
``displacement``), each step takes r = 0 and the complementarity of T and F to first order; x eliminated, a
linear complementarity problem in T remains.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tactr import _core
from tactr.statics._complementary import complementary_tension
from tactr.statics.held import Held
from tactr.statics.pulls import Pulls

MOST_STEPS, MOST_ROUNDS = 15, 4
SHORTEST = 0.02  # of a step
LONGEST = 0.5  # rad at the free end, in one step
AIM_SHARE = 0.1  # of what may be missing


class _Point(NamedTuple):
    """One march: missed (n,) rad; matrix: d(missed, lengths)/d(free end, tensions); gap (p,) m."""

    solution: _core.Solution
    missed: np.ndarray
    matrix: np.ndarray
    gap: np.ndarray


class JointNewton:
    """Finds an equilibrium under displacements from a neighbour's free end and tensions."""

    def __init__(self, held: Held, pulls: Pulls) -> None:
        self._held = held
        self._pulls = pulls
        self._length = float(np.abs(pulls.reference).max(initial=1e-3))

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

    def _newton(
        self, guess: _core.Solution, tension: np.ndarray, shift: np.ndarray | float
    ) -> _Point | None:
        point = self._march(guess, np.zeros(0), tension, shift)
        for _ in range(MOST_STEPS):
            if point is None or self._is_met(point):
                return point
            point = self._step(point, shift)
        return None

    def _step(self, point: _Point, shift: np.ndarray | float) -> _Point | None:
        turn, pull = self._way(point)
        if turn is None:
            return None
        size, longest = self._size(point), float(np.abs(turn).max(initial=0.0))
        fraction = min(1.0, LONGEST / longest) if longest > 0.0 else 1.0
        while fraction > SHORTEST:
            tension = point.solution.tension.copy()
            index = self._pulls.index
            tension[index] = np.maximum(tension[index] + fraction * pull, 0.0)
            after = self._march(point.solution, fraction * turn, tension, shift)
            if after is not None and self._size(after) <= (1.0 - 0.1 * fraction) * size:
                return after
            fraction *= 0.4
        return None

    def _way(self, point: _Point) -> tuple[np.ndarray | None, np.ndarray]:
        """Newton's step: of the free end (n,), rad, and of the pulled tendons' tensions (p,), N."""
        n, index = len(point.missed), self._pulls.index
        tension, columns = point.solution.tension[index], n + index
        rates, by_tension = point.matrix[:n, :n], point.matrix[:n, columns]
        lengths, stretch = point.matrix[columns, :n], point.matrix[np.ix_(columns, columns)]
        try:
            back = np.linalg.solve(rates, np.column_stack([point.missed, by_tension]))
        except np.linalg.LinAlgError:
            return None, tension
        flexibility = np.diag(self._pulls.compliance) - stretch + lengths @ back[:, 1:]
        gap = point.gap + lengths @ back[:, 0]
        if not (np.isfinite(flexibility).all() and np.isfinite(gap).all()):
            return None, tension
        pull = complementary_tension(flexibility, gap, tension) - tension
        return -back[:, 0] - back[:, 1:] @ pull, pull

    def _march(
        self, guess: _core.Solution, turn: np.ndarray, tension: np.ndarray, shift: np.ndarray | float
    ) -> _Point | None:
        found = self._held.joint_march(guess, turn, tension)
        if found is None:
            return None
        solution, missed, matrix = found
        return _Point(solution, missed, matrix, self._pulls.gap(solution) + shift)

    def _missed_gap(self, point: _Point) -> float:
        taut = point.solution.tension[self._pulls.index] > 0.0
        return float(np.where(taut, np.abs(point.gap), np.maximum(-point.gap, 0.0)).max(initial=0.0))

    def _size(self, point: _Point) -> float:
        turn = float(np.abs(point.missed).max(initial=0.0))
        return max(turn, self._missed_gap(point) / self._length)

    def _is_met(self, point: _Point) -> bool:
        turn = float(np.abs(point.missed).max(initial=0.0))
        met = AIM_SHARE * self._pulls.tolerance
        return turn <= 10.0 * self._held.residual_tolerance and self._missed_gap(point) <= met
