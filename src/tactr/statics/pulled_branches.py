"""Equilibria under displacements, from all those at some held tensions."""

from __future__ import annotations

import numpy as np

from tactr import _core
from tactr.statics.held import Held
from tactr.statics.joint import JointNewton
from tactr.statics.pulls import Pulled, Pulls, is_stable

SHARES = (1.0, 0.0, 0.5)  # of the tensions known, at which all equilibria are looked for
SAME_TURN = 1e-4  # rad, at the free end
SAME_TIP = 1e-5  # m; tendons without compliance side by side share one tension in many ways


class PulledBranches:
    """A search at a robot's displacements; tension: of all tendons, samples: of each search."""

    def __init__(self, held: Held, pulls: Pulls, tension: np.ndarray, samples: int) -> None:
        self._held = held
        self._pulls = pulls
        self._tension = tension
        self._samples = samples
        self._found: list[Pulled] = []

    def found(self, first: _core.Solution, *, until_stable: bool = False) -> list[Pulled]:
        """Stable ones first, then by energy. first: a shape whose tensions are near, perhaps one of them.
        until_stable: only until one of the searches has found a stable one."""
        newton = JointNewton(self._held, self._pulls)
        self._lead(newton, first)
        for share in SHARES:
            if until_stable and any(pulled.stable for pulled in self._found):
                break
            whole = self._tension.copy()
            whole[self._pulls.index] = share * first.tension[self._pulls.index]
            for branch in self._held.branches(whole, self._samples):
                self._lead(newton, branch)
        return sorted(self._found, key=self._order)

    def _lead(self, newton: JointNewton, branch: _core.Solution) -> None:
        solution = newton.lead(branch)
        if solution is not None and not any(self._same(solution, other.solution) for other in self._found):
            stable = is_stable(self._held.prepared, self._pulls, solution)
            missed = self._pulls.missed(solution)
            counts = self._held.solves, self._held.marches
            self._found.append(Pulled(self._pulls, solution, missed, *counts, stable))

    def _same(self, a: _core.Solution, b: _core.Solution) -> bool:
        near = float(np.linalg.norm(a.tip_position - b.tip_position)) < SAME_TIP
        return near and _core.free_end_distance(self._held.prepared, a, b) < SAME_TURN

    def _order(self, pulled: Pulled) -> tuple[bool, float]:
        return not pulled.stable, self._pulls.energy(self._held.prepared, pulled.solution)
