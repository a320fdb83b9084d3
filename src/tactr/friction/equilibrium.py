"""Shape, tensions along the tendons and wrap angles that go together, from given profiles before.

A round: profiles from the wraps by the friction step, the shape at these profiles, the wraps in that shape.
The map from wraps to wraps contracts by about the friction angle; Anderson's mixing (1965) of the last rounds
makes it converge in a few. Tensions of tendons pulled by displacements take a Newton step on the gaps in the
same rounds: how lengths follow them counts only where the tendon slides. Where tubes rub on each other, every
shape of a round is found together with their friction torques, by the kernel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr import _core
from tactr.friction.chebyshev import FIT, ORDER, Curve, all_points, points, powers
from tactr.friction.project import Profile, project
from tactr.friction.tube_state import TubeFrictionState
from tactr.friction.tube_step import TubeFrictionStep
from tactr.friction.wrap import Channel, Measure, Wrap, blended
from tactr.robot import Robot, TensionProfile
from tactr.statics._complementary import complementary_tension
from tactr.statics.assemble import _profile_rows, tables, tension_row
from tactr.statics.parameters import WHOLE_NUMBERS
from tactr.statics.pulls import Pulled, Pulls
from tactr.statics.solve import Prepared

MOST_ROUNDS = 30
DEPTH = 3  # rounds that are mixed
AIM_SHARE = 0.1  # of what may be missing in a displacement
NEGLIGIBLE = 1e-13  # of a profile: coefficients left away


@dataclass(frozen=True, eq=False)
class Settled:
    """One equilibrium with friction.

    core: the robot with its profiles and the torques between tubes; profiles by channel, None where slack;
    wraps by channel; missed: rad, by how much wraps and profiles disagree; rounds: shapes solved; pulled: of
    the tendons pulled by displacements, if there are any; tubes: where they rub, None without; held: in how
    many directions of falling energy they hold the robot.
    """

    core: _core.PreparedRobot
    solution: _core.Solution
    profiles: tuple[Profile | None, ...]
    wraps: tuple[Wrap, ...]
    missed: float
    rounds: int
    pulled: Pulled | None = None
    tubes: TubeFrictionState | None = None
    held: int = 0


class Equilibrium:
    """Finds equilibria of one robot with friction; it keeps nothing from one to the next."""

    def __init__(self, prepared: Prepared) -> None:
        robot = prepared.robot
        self._prepared = prepared
        every = [Channel.of(robot, j) for j in range(len(robot.tendons))]
        self.channels = [c for c in every if c.rubs]
        self._fixed_rows = [
            _profile_rows(tendon) if isinstance(tendon.tension, TensionProfile) else []
            for tendon in robot.tendons
        ]
        self._still = _without_rates(robot)
        self.tube_step = TubeFrictionStep(robot, prepared.tolerance, prepared.residual_tolerance)

    @property
    def angle_tolerance(self) -> float:
        """By how much wraps and profiles may disagree, rad."""
        return self._prepared.residual_tolerance

    def settle(
        self,
        old: Sequence[Curve | None],
        arrays: tuple[np.ndarray, np.ndarray, np.ndarray],
        pulls: Pulls | None,
        near: Settled | None,
        solution: _core.Solution,
        *,
        stay: bool,
        tubes: TubeFrictionState | None = None,
    ) -> Settled | None:
        """From profiles before, log tension by channel, and where tubes rubbed, at tension,
        rotation, translation (arrays) and displacements, near what was found before, or from a shape without
        friction. None: not found."""
        rounds = _Rounds(self, old, arrays, pulls, stay, tubes)
        return rounds.run(near, solution)

    def core_with(
        self, rows: Sequence[Sequence[Sequence[float]]], *, rates: bool = False
    ) -> _core.PreparedRobot:
        """The robot, or what changes nothing, with rows of tension pieces for every tendon."""
        flat = [row for tendon in rows for row in tendon]
        table = np.array(flat, dtype=float).reshape(len(flat), 2 + ORDER)
        core = self._still if rates else self._prepared._core
        return core.with_profiles([len(tendon) for tendon in rows], table)


class _Rounds:
    def __init__(
        self,
        owner: Equilibrium,
        old: Sequence[Curve | None],
        arrays: tuple[np.ndarray, np.ndarray, np.ndarray],
        pulls: Pulls | None,
        stay: bool,
        tubes: TubeFrictionState | None,
    ) -> None:
        self._tubes_before, self._tubes, self._held = tubes, None, 0
        self._owner, self._old, self._pulls, self._stay = owner, old, pulls, stay
        self._tension, self._rotation, self._translation = arrays[0].copy(), arrays[1], arrays[2]
        prepared = owner._prepared
        self._measure = Measure(owner.channels, prepared._core, self._translation)
        self._looks = [all_points(joints)[::2] for joints in self._measure.joints]
        self._scale = max(float(self._tension.max(initial=0.0)), 1e-3)

    def run(self, near: Settled | None, solution: _core.Solution) -> Settled | None:
        owner, prepared = self._owner, self._owner._prepared
        if self._pulls is not None:
            self._tension[self._pulls.index] = solution.tension[self._pulls.index]
            self._scale = max(float(self._tension.max(initial=0.0)), 1e-3)
        if near is None:
            fronts = [np.zeros(0)] * len(owner.channels)
            wraps = self._measure.wraps(prepared._core, solution, self._measure.panels(fronts))
        else:
            wraps, solution = list(near.wraps), near.solution
        history: list[tuple[np.ndarray, np.ndarray, list[Wrap], np.ndarray]] = []
        first = True
        for rounds in range(1, MOST_ROUNDS + 1):
            profiles = self._profiles(wraps)
            shape = self._shape(owner.core_with(self._rows(profiles)), solution)
            if shape is None:
                return None
            core, solution = shape
            fronts = [np.zeros(0) if p is None else p.log.edges for p in profiles]
            after = self._measure.wraps(core, solution, self._measure.panels(fronts))
            own, new = self._vector(wraps), self._vector(after)
            missed = float(np.abs(new - own).max(initial=0.0))
            pulled, step = self._pull(core, solution, profiles, rounds, first)
            first = False
            if missed <= owner.angle_tolerance and (pulled is None or step is None):
                return Settled(
                    core,
                    solution,
                    tuple(profiles),
                    tuple(wraps),
                    missed,
                    rounds,
                    pulled,
                    self._tubes,
                    self._held,
                )
            tension = self._tension if step is None else step
            x = np.concatenate([own, self._tension / self._scale])
            g = np.concatenate([new, tension / self._scale])
            history = [*history[1 - DEPTH :], (x, g, after, tension)]
            weights = _mixing([h[1] - h[0] for h in history])
            self._tension = np.where(
                tension == 0.0,
                0.0,
                np.maximum(sum(w * h[3] for w, h in zip(weights, history, strict=True)), 0.0),
            )
            wraps = [blended(weights, [h[2][k] for h in history]) for k in range(len(owner.channels))]
        return None

    def _shape(
        self, core: _core.PreparedRobot, guess: _core.Solution
    ) -> tuple[_core.PreparedRobot, _core.Solution] | None:
        """The robot with the tubes' friction torques, and its solution; None: not found."""
        prepared, arrays = self._owner._prepared, (self._tension, self._rotation, self._translation)
        step = self._owner.tube_step
        if step.rubs:
            rubbed = step(core, arrays, self._tubes_before, guess=guess, stay=self._stay)
            self._tubes, self._held = rubbed.state, rubbed.held
            return (rubbed.core, rubbed.solution) if rubbed.settled else None
        tolerance = prepared.tolerance if self._pulls is None else prepared.held_tolerance
        found = _core.solve(core, *arrays, tolerance, prepared.residual_tolerance, guess, stay=self._stay)
        return (core, found) if found.status == 0 else None

    def _profiles(self, wraps: Sequence[Wrap]) -> list[Profile | None]:
        return [
            project(old, float(np.log(self._tension[c.index])), wrap, joints)
            if self._tension[c.index] > 0.0
            else None
            for c, old, wrap, joints in zip(
                self._owner.channels, self._old, wraps, self._measure.joints, strict=True
            )
        ]

    def _rows(self, profiles: Sequence[Profile | None]) -> list[list[list[float]]]:
        rows = [list(fixed) for fixed in self._owner._fixed_rows]
        for c, profile in zip(self._owner.channels, profiles, strict=True):
            if profile is not None:
                rows[c.index] = _kernel_rows(profile, float(np.log(self._tension[c.index])))
        return rows

    def _vector(self, wraps: Sequence[Wrap]) -> np.ndarray:
        parts = [wrap.up_to(looks) for wrap, looks in zip(wraps, self._looks, strict=True)]
        return np.concatenate([*parts, np.zeros(0)])

    def _pull(
        self,
        core: _core.PreparedRobot,
        solution: _core.Solution,
        profiles: Sequence[Profile | None],
        rounds: int,
        first: bool,
    ) -> tuple[Pulled | None, np.ndarray | None]:
        """What of the displacements is met, and the tensions (tendons,) to go on with; None: near enough."""
        pulls = self._pulls
        if pulls is None:
            return None, None
        missed = pulls.missed(solution)
        pulled = Pulled(pulls, solution, missed, rounds, rounds)
        if float(missed.max(initial=0.0)) <= AIM_SHARE * pulls.tolerance:
            return pulled, None
        tension = self._tension[pulls.index]
        flexibility = self._flexibility(core, solution, profiles, first)
        after = complementary_tension(flexibility, pulls.gap(solution), tension)
        step = self._tension.copy()
        step[pulls.index] = after
        return pulled, step

    def _flexibility(
        self,
        core: _core.PreparedRobot,
        solution: _core.Solution,
        profiles: Sequence[Profile | None],
        first: bool,
    ) -> np.ndarray:
        """d gap / d tension at the base, (n, n), m/N; first: as if the tendons slid all along."""
        pulls = self._pulls
        assert pulls is not None
        rows = self._rows(profiles)
        by_tendon = {c.index: p for c, p in zip(self._owner.channels, profiles, strict=True)}
        count, rates, place = len(rows), [], {}
        for j in pulls.index:
            profile = by_tendon.get(int(j))
            if profile is None:
                continue
            moving = [[[row[0], row[1], *[0.0] * ORDER] for row in tendon] for tendon in rows]
            for k, driven in enumerate(profile.driven):
                if driven or first:
                    moving[j][k][2:] = [c / self._tension[j] for c in rows[j][k][2:]]
            place[int(j)] = len(rates)
            rates.append(self._owner.core_with(moving, rates=True))
        found = _core.sensitivities(core, solution, np.zeros(0), True, True, -1.0, rates)
        actuators = count + 2 * len(self._rotation)
        columns = [actuators + place[int(j)] if int(j) in place else int(j) for j in pulls.index]
        return np.diag(pulls.compliance) - found[6 + pulls.index][:, columns]


def _mixing(residuals: Sequence[np.ndarray]) -> np.ndarray:
    """Weights, of sum 1, with which the residuals are least."""
    count = len(residuals)
    if count == 1:
        return np.ones(1)
    steps = np.array([a - b for a, b in zip(residuals[1:], residuals[:-1], strict=True)]).T
    gamma = np.linalg.lstsq(steps, residuals[-1], rcond=1e-10)[0]
    weights = np.zeros(count)
    weights[-1] = 1.0
    weights[1:] -= gamma
    weights[:-1] += gamma
    return weights if np.abs(weights).max() < 20.0 else np.eye(count)[-1]


def _kernel_rows(profile: Profile, y0: float) -> list[list[float]]:
    """Tension over that at the base, for the kernel."""
    rows, edges = [], profile.log.edges
    for k in range(len(edges) - 1):
        start, end = edges[k], edges[k + 1]
        values = np.exp(profile.log.on(k, points(start, end)) - y0)
        chebyshev = FIT @ values
        small = np.abs(chebyshev) > NEGLIGIBLE * np.abs(chebyshev).max()
        chebyshev = np.where(np.arange(ORDER) <= np.flatnonzero(small)[-1], chebyshev, 0.0)
        count = int(np.flatnonzero(chebyshev)[-1]) + 1
        rows.append(tension_row(start, *powers(chebyshev, start, end)[:count]))
    return rows


def _without_rates(robot: Robot) -> _core.PreparedRobot:
    """The layout of the robot's tables with zeros for all numbers, as rates."""
    zeros = {}
    for name, table in tables(robot).items():
        zeros[name] = np.zeros_like(table)
        columns = WHOLE_NUMBERS.get(name, [])
        zeros[name][:, columns] = table[:, columns]
    return _core.PreparedRobot(**zeros)
