"""Solves at held tensions, the tubes where they are: the work that is done in them is counted."""

from __future__ import annotations

import numpy as np

from tactr import _core

JOINT_COST = 4  # steps of a march with derivatives by all tensions, in steps of one without

LEAST_STEPS, MOST_STEPS = 1000, 60_000  # in one solve


class GivenUp(Exception):
    """The work allowed is done."""


class Held:
    """A robot whose tubes stay at rotation (tubes,), rad, and translation (tubes,), m."""

    def __init__(
        self,
        prepared: _core.PreparedRobot,
        rotation: np.ndarray,
        translation: np.ndarray,
        tolerance: float,
        residual_tolerance: float,
    ) -> None:
        self.prepared = prepared
        self.residual_tolerance = residual_tolerance
        self.solves = self.marches = self.work = 0
        self._places = rotation, translation
        self._weight = 2 + max(len(rotation), 2)  # of one step
        self._tolerance = tolerance
        self._most_work = self._most_each = np.inf

    def allow(self, work: float, *, each: float = np.inf) -> None:
        """GivenUp is raised once so much more is done: steps marched, each counted as 2 and one more for
        every tube, 4 at least, of which about 2e5 take a second. each: the most of it in one solve."""
        self._most_work, self._most_each = self.work + work, each

    def solve(
        self, tension: np.ndarray, guess: _core.Solution | None, *, stay: bool = False
    ) -> _core.Solution:
        """At tensions of all tendons; from a guess, then, unless it is to stay there, from cold."""
        self._check_work()
        tolerances = self._tolerance, self.residual_tolerance
        stay = stay and guess is not None
        work = min(self._most_work - self.work, self._most_each)
        steps = int(min(max(work / self._weight, LEAST_STEPS), MOST_STEPS))
        found = _core.solve(
            self.prepared,
            tension,
            *self._places,
            *tolerances,
            guess,
            stay=stay,
            most_steps=steps,
            patience=1,  # other tensions may be easier
        )
        self.solves += 1
        self.marches += found.iterations
        self.work += self._weight * found.steps_marched
        return found

    def joint_march(
        self, guess: _core.Solution, turn: np.ndarray, tension: np.ndarray
    ) -> tuple[_core.Solution, np.ndarray, np.ndarray] | None:
        """See the kernel's."""
        self._check_work()
        found = _core.joint_march(self.prepared, guess, turn, tension, *self._places, self._tolerance)
        self.marches += 1 if found is None else found[0].iterations
        self.work += (
            self._weight * JOINT_COST * (sum(guess.steps) if found is None else found[0].steps_marched)
        )
        return found

    def branches(self, tension: np.ndarray, samples: int) -> list[_core.Solution]:
        """All equilibria found at tensions of all tendons; samples as for ``tactr.branches``, 0: None."""
        tolerances = self._tolerance, self.residual_tolerance
        return _core.branches(self.prepared, tension, *self._places, *tolerances, samples)

    def _check_work(self) -> None:
        if self.work > self._most_work:
            raise GivenUp
