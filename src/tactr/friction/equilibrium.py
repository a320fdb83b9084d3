"""Shape, tensions along the tendons and wrap angles that go together, from given profiles before.

The kernel makes the rounds: profiles from the wraps by the friction step, the shape at these profiles, the
wraps in that shape. Tensions of tendons pulled by displacements take a Newton step on the gaps in the same
rounds: how lengths follow them counts only where the tendon slides. Where tubes rub on each other, every
shape of a round is found together with their friction torques.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import NamedTuple

import numpy as np

from tactr import _core
from tactr.friction.actuators import Actuators
from tactr.friction.channel import channels
from tactr.friction.profiles import FoundProfiles, Profiles
from tactr.friction.tube_state import TubeFrictionState
from tactr.friction.tube_step import Rubbed, TubeFrictionStep
from tactr.robot import Robot
from tactr.statics._complementary import complementary_tension
from tactr.statics.assemble import tables
from tactr.statics.parameters import WHOLE_NUMBERS
from tactr.statics.pulls import Pulled, Pulls, is_stable
from tactr.statics.solve import Prepared
from tactr.statics.stability import is_stable_at_tensions

MOST_ROUNDS = 45
MOST_CHANGE = 0.3  # of a tension, from one round to the next
MOST_GROWTH = 5.0  # of what they changed in the round before
LOW = 0.1  # of the largest tension: those below may change as if they were so large
SLOW = 0.25  # of the gap before: lengths answer tensions in another way by now
PATIENT = 8  # rounds; then that is looked at in every one
AIM_SHARE = 0.1  # of what may be missing in a displacement


class Limits(NamedTuple):
    """Of a step that may be made shorter. missed: of log tension, of what smaller steps would have seen;
    turn: of the free end, rad."""

    missed: float
    turn: float


@dataclass(frozen=True, eq=False)
class Settled:
    """One equilibrium with friction.

    found: the kernel's, which holds the robot with its profiles and the torques between tubes; pulled: of the
    tendons pulled by displacements, if there are any; tubes: where they rub, None without; spent: heat, J, of
    the step that led here, and creep, m, by channel, where the kernel made it; translation (tubes,): m, where
    springs give way, None without.
    """

    found: _core.FrictionSettled
    pulled: Pulled | None = None
    tubes: Rubbed | None = None
    spent: tuple[list[float], list[float]] | None = None
    translation: np.ndarray | None = None

    @property
    def core(self) -> _core.PreparedRobot:
        """The robot with its profiles."""
        return self.found.robot

    @property
    def solution(self) -> _core.Solution:
        """Its shape."""
        return self.found.solution

    @property
    def held(self) -> int:
        """In how many directions of falling energy tubes hold the robot."""
        return 0 if self.tubes is None else self.tubes.held


class Ahead(NamedTuple):
    """Points that were reached in a row: equilibrium, steps, heat, J, and creep, m, by channel, and seconds
    of each; what was found last, the latest first; how far a step may be expected to get."""

    points: list[tuple[_core.FrictionSettled, int, list[float], list[float], float]]
    found: list[_core.FrictionSettled]
    stride: float


class Equilibrium:
    """Finds equilibria of one robot with friction; it keeps nothing from one to the next."""

    def __init__(self, prepared: Prepared) -> None:
        robot = prepared.robot
        self._prepared = prepared
        self.channels = channels(robot)
        self._index = tuple(c.index for c in self.channels)
        self.rows = _core.FrictionChannels([c.row for c in self.channels])
        self.tube_step = TubeFrictionStep(robot, prepared.tolerance, prepared.residual_tolerance)
        self._tubes_rub = self.tube_step.rubs
        self._tolerances = prepared.tolerance, prepared.residual_tolerance

    @cached_property
    def _still(self) -> _core.PreparedRobot:
        return _without_rates(self._prepared.robot)

    def settle(
        self,
        old: Profiles,
        passed: Actuators,
        pulls: Pulls | None,
        near: Settled | None,
        solution: _core.Solution,
        *,
        past: Sequence[_core.FrictionSettled] = (),
        stay: bool,
        limits: Limits | None = None,
        tubes: TubeFrictionState | None = None,
    ) -> tuple[Settled | None, float]:
        """From profiles before, and where tubes rubbed, at what the plays pass on, near what was found
        before, or from a shape without friction. past: what was found before that, the latest first. limits:
        None where a step must be taken as it is. The second of what is returned is what was missed, 0 where
        it was not looked at. None: not found, or not in one step."""
        if near is not None and pulls is None and not self._tubes_rub:
            return self._step(old, passed, near, past, limits)
        if pulls is None and not self.channels:
            return self._turn(passed, near, solution, tubes, stay, limits)
        if pulls is None and not self._tubes_rub:
            arrays = passed.tension, passed.rotation, passed.translation
            found = self._rounds(old, passed, near, solution, past).run(
                *arrays, *self._tolerances, solution, stay
            )
            return None if found is None else Settled(found), 0.0
        rubbed, settled = None if near is None else near.tubes, None
        for careful in (False, True) if pulls is not None and limits is None else (False,):
            rounds = self._rounds(old, passed, near, solution, past)
            settled = _Rounds(self, rounds, passed, pulls, stay, tubes, rubbed, careful).run(solution)
            if settled is not None:
                break
        if settled is None or near is None or limits is None:
            return settled, 0.0
        missed = _core.friction_history_missed(self.rows, near.found, settled.found, limits.missed)
        if missed > limits.missed:
            return None, missed
        return (settled, missed) if self._goes_on(near, settled, limits.turn) else (None, 0.0)

    def _rounds(
        self,
        old: Profiles,
        passed: Actuators,
        near: Settled | None,
        solution: _core.Solution,
        past: Sequence[_core.FrictionSettled],
    ) -> _core.FrictionRounds:
        """From near, or from a shape without friction."""
        prepared, rows = self._prepared, old.rows(self._index)
        rounds = _core.FrictionRounds(
            prepared._core, self.rows, rows, passed.flat, passed.translation, prepared.residual_tolerance
        )
        if near is None:
            rounds.start_plain(solution)
        else:
            rounds.start_near(near.found, list(past))
        return rounds

    def _step(
        self,
        old: Profiles,
        passed: Actuators,
        near: Settled,
        past: Sequence[_core.FrictionSettled],
        limits: Limits | None,
    ) -> tuple[Settled | None, float]:
        """Where tensions are given and no tubes rub: all of it in the kernel."""
        found, missed, *spent = _core.tendon_friction_step(
            self._prepared._core,
            self.rows,
            old.rows(self._index),
            near.found,
            list(past),
            passed.flat,
            passed.tension,
            passed.rotation,
            passed.translation,
            *self._tolerances,
            limits,
        )
        return None if found is None else Settled(found, spent=(spent[0], spent[1])), missed

    def _turn(
        self,
        passed: Actuators,
        near: Settled | None,
        solution: _core.Solution,
        tubes: TubeFrictionState | None,
        stay: bool,
        limits: Limits | None,
    ) -> tuple[Settled | None, float]:
        """Where tensions are given and no tendon rubs: tubes alone remember."""
        arrays = passed.tension, passed.rotation, passed.translation
        model = None if near is None or near.tubes is None else near.tubes.model
        rubbed = self.tube_step(self._prepared._core, arrays, tubes, guess=solution, model=model, stay=stay)
        if not rubbed.settled:
            return None, 0.0
        found = _core.FrictionSettled(rubbed.core, rubbed.solution, passed.flat)
        settled = Settled(found, None, rubbed, ([], []))
        if near is None or limits is None or self._goes_on(near, settled, limits.turn):
            return settled, 0.0
        return None, 0.0

    def ahead(
        self,
        old: Profiles,
        found: list[_core.FrictionSettled],
        stride: float,
        points: np.ndarray,
        cuts: tuple[float, float, float, float, float],
    ) -> Ahead:
        """As far along points (k, numbers) as steps lead, where tensions are given and no tubes rub. found:
        where it starts and what was before that, the latest first. cuts: as the kernel takes them."""
        rows = old.rows(self._index)
        return Ahead(
            *_core.tendon_friction_way(
                self._prepared._core, self.rows, rows, found, stride, points, *self._tolerances, cuts
            )
        )

    def _goes_on(self, a: Settled, b: Settled, most: float) -> bool:
        """Whether the way from a to b is short enough for one step, and b as stable as a."""
        turn = _core.free_end_distance(self._prepared._core, a.solution, b.solution)
        return turn <= most and (_stable(b) or not _stable(a))

    def spent(self, near: Settled, settled: Settled) -> tuple[list[float], list[float]]:
        """Heat of the step from one to the next, and creep after it, by channel."""
        return settled.spent or _core.friction_spent(self.rows, near.found, settled.found)

    def profiles(self, found: _core.FrictionSettled) -> FoundProfiles:
        """What an equilibrium leaves behind."""
        return FoundProfiles(found, self._index, len(self._prepared.robot.tendons))


class _Rounds:
    """With tendons pulled by displacements, or tubes that rub. careful: tensions change little more than in
    the round before, which takes more rounds, and fails less."""

    def __init__(
        self,
        owner: Equilibrium,
        rounds: _core.FrictionRounds,
        passed: Actuators,
        pulls: Pulls | None,
        stay: bool,
        tubes: TubeFrictionState | None,
        rubbed: Rubbed | None,
        careful: bool,
    ) -> None:
        self._owner, self._rounds, self._pulls, self._stay = owner, rounds, pulls, stay
        self._careful = careful
        self._tubes_before, self._rubbed = tubes, rubbed
        self._tension = passed.tension.copy()
        self._rotation, self._translation = passed.rotation, passed.translation
        self._flexible: np.ndarray | None = None  # how gaps answered tensions when they were last looked at
        self._gap = inf
        self._moved = 0.0  # by how much tensions did in the round before, N

    def run(self, solution: _core.Solution) -> Settled | None:
        rounds, pulls = self._rounds, self._pulls
        if pulls is not None:
            self._tension[pulls.index] = solution.tension[pulls.index]
        scale = max(float(self._tension.max(initial=0.0)), 1e-3)
        for count in range(1, MOST_ROUNDS + 1):
            shape = self._shape(rounds.profile(self._tension), solution)
            if shape is None or not rounds.measure(*shape):
                return None
            core, solution = shape
            pulled, step = self._pull(core, solution, count)
            if rounds.missed <= self._owner._prepared.residual_tolerance and step is None:
                found = rounds.settled(core, solution)
                return Settled(found, pulled, self._rubbed)
            tension = self._tension if step is None else self._nearer(step)
            before = self._tension
            self._tension = self._nearer(rounds.mix(self._tension / scale, tension / scale) * scale)
            self._moved = float(np.abs(self._tension - before).max(initial=0.0))
        return None

    def _nearer(self, tension: np.ndarray) -> np.ndarray:
        """As far on the way to tensions as none changes by too much. After a reversal only what lies before a
        front gives way: lengths hardly answer tensions, and Newton's step may lead anywhere."""
        most = MOST_CHANGE * np.maximum(self._tension, LOW * self._tension.max(initial=0.0))
        if self._careful and self._moved > 0.0:
            most = np.minimum(most, MOST_GROWTH * self._moved)
        change = tension - self._tension
        too_far = np.abs(change) > most
        if self._pulls is None or not too_far.any() or not most.any():
            return tension
        return self._tension + change * float((most[too_far] / np.abs(change[too_far])).min())

    def _shape(
        self, core: _core.PreparedRobot, guess: _core.Solution
    ) -> tuple[_core.PreparedRobot, _core.Solution] | None:
        """The robot with the tubes' friction torques, and its solution; None: not found."""
        prepared, arrays = self._owner._prepared, (self._tension, self._rotation, self._translation)
        if self._owner._tubes_rub:
            model = None if self._rubbed is None else self._rubbed.model
            step = self._owner.tube_step
            rubbed = step(core, arrays, self._tubes_before, guess=guess, model=model, stay=self._stay)
            self._rubbed = rubbed
            return (rubbed.core, rubbed.solution) if rubbed.settled else None
        tolerance = prepared.tolerance if self._pulls is None else prepared.held_tolerance
        found = _core.solve(core, *arrays, tolerance, prepared.residual_tolerance, guess, stay=self._stay)
        return (core, found) if found.status == 0 else None

    def _pull(
        self, core: _core.PreparedRobot, solution: _core.Solution, count: int
    ) -> tuple[Pulled | None, np.ndarray | None]:
        """What of the displacements is met, and the tensions (tendons,) to go on with; None: near enough."""
        pulls = self._pulls
        if pulls is None:
            return None, None
        missed = pulls.missed(solution)
        pulled = Pulled(pulls, solution, missed, count, count)
        if float(missed.max(initial=0.0)) <= AIM_SHARE * pulls.tolerance:
            return pulled, None
        tension, largest = self._tension[pulls.index], float(missed.max())
        if self._flexible is None or count > PATIENT or largest > SLOW * self._gap:
            self._flexible = self._flexibility(core, solution, pulls, count == 1)
        self._gap = largest
        step = self._tension.copy()
        step[pulls.index] = complementary_tension(self._flexible, pulls.gap(solution), tension)
        return pulled, step

    def _flexibility(
        self, core: _core.PreparedRobot, solution: _core.Solution, pulls: Pulls, first: bool
    ) -> np.ndarray:
        """d gap / d tension at the base, (n, n), m/N; first: as if the tendons slid all along."""
        owner, rates, place = self._owner, [], {}
        for k, c in enumerate(owner.channels):
            if c.index in pulls.index and not self._rounds.slack(k):
                place[c.index] = len(rates)
                rates.append(self._rounds.rates(owner._still, k, float(self._tension[c.index]), first))
        found = _core.sensitivities(core, solution, np.zeros(0), True, True, -1.0, rates)
        actuators = len(self._tension) + 2 * len(self._rotation)
        columns = [actuators + place[int(j)] if int(j) in place else int(j) for j in pulls.index]
        return np.diag(pulls.compliance) - found[6 + pulls.index][:, columns]


def _stable(settled: Settled) -> bool:
    if settled.pulled is not None:
        return is_stable(settled.core, settled.pulled.pulls, settled.solution)
    if settled.tubes is not None:
        return settled.tubes.falls <= settled.held
    return is_stable_at_tensions(settled.core, settled.solution)


def _without_rates(robot: Robot) -> _core.PreparedRobot:
    """The layout of the robot's tables with zeros for all numbers, as rates."""
    zeros = {}
    for name, table in tables(robot).items():
        zeros[name] = np.zeros_like(table)
        columns = WHOLE_NUMBERS.get(name, [])
        zeros[name][:, columns] = table[:, columns]
    return _core.PreparedRobot(**zeros)
