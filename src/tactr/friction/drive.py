"""Follows a sequence of actuations with friction of tendons and tubes and backlash of the actuators."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import ceil, inf, sqrt
from time import perf_counter
from typing import Any

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.friction.actuators import Actuators, Plays
from tactr.friction.driven import Driven
from tactr.friction.equilibrium import Equilibrium, Limits, Settled
from tactr.friction.plain import plain_shape
from tactr.friction.profile import Profile
from tactr.friction.profiles import GivenProfiles
from tactr.friction.record import Reached, driven_of
from tactr.friction.state import DriveState
from tactr.robot import Robot, TensionProfile
from tactr.robot.friction import rubs
from tactr.statics.path import Path, PathPoints, path_points
from tactr.statics.pulls import Pulled
from tactr.statics.rest import pulls_from
from tactr.statics.shape import Shape
from tactr.statics.solve import Prepared

MISSED = 1.5e-5  # m, over the length: log tension that one step may miss moves the tip by about as much
TURN = 0.3  # rad, by which one step may turn the free end
SHORTEST_STEP = 1.0 / 32  # of the way between two points
CAREFUL = 0.9  # of the longest step
AT_ONCE = 64  # points between which nobody is told of progress
MOST_YIELDS, YIELD_SHARE = 20, 0.1  # rounds in which springs give way, and of the tolerance, when they stay
STRETCH = 0.2  # of a step, by which those on a way may be longer to come out even


def drive(
    robot: Robot,
    path: Path,
    *,
    state: DriveState | None = None,
    tolerance: float = 1e-6,
    stations: int | Sequence[float] | np.ndarray = 101,
    progress: Callable[[int, int], None] | None = None,
) -> Driven:
    """Shapes along a path of actuation, with friction of tendons and tubes and backlash.

    path: a sequence of mappings with tension (N), displacement (m), rotation (rad) or translation (m), each
    as in ``solve``, or one mapping from these names to arrays, as in ``follow``; in between the actuation is
    linear. state: what the robot remembers, the ``state`` of a result before; None: at rest, every tendon at
    its pretension all along and every play in its middle at zero, loaded in one direction to the first point,
    where tubes meet without friction torques.
    What friction and backlash leave behind comes back in the result's states: nothing is hidden in the
    robot. ``creep`` alone starts at zero again where a drive goes on from a state. tolerance, stations: as in
    ``solve``. Every way between two points is cut into steps in which the free end turns by less than 0.3
    rad. progress: called with points done and their number. A result always comes back: look at
    ``converged``. Model and assumptions: docs/friction.md, docs/tube_friction.md. Raises RobotError.
    """
    points = path_points(robot, path)
    _check(points.first)
    prepared = Prepared(points.first, tolerance=tolerance, stations=stations)
    if state is not None:
        state.fits(robot)
    return _Driver(prepared, points).run(state, progress)


def _check(robot: Robot) -> None:
    for k, tendon in enumerate(robot.tendons):
        if rubs(tendon.friction) and isinstance(tendon.tension, TensionProfile):
            raise RobotError(
                f"tendons[{k}].tension",
                f"{tendon.name!r} has friction, which makes its own profile",
                "a tension at the motor in N",
                value=tendon.tension,
            )


class _Driver:
    def __init__(self, prepared: Prepared, path: PathPoints) -> None:
        self._prepared, self._points, self._numbers = prepared, Actuators.along(path), Actuators.numbers(path)
        self._robot = prepared.robot
        self._plays = Plays.of(self._robot)
        self._pulled = ~np.isnan(path.displacement[0])
        self._any_pulled = bool(self._pulled.any())
        profiled = any(isinstance(t.tension, TensionProfile) for t in self._robot.tendons)
        self._all_by_tension = not (profiled or self._any_pulled)
        self._equilibrium = Equilibrium(prepared)
        self._limits = Limits(missed=MISSED / max(tube.length for tube in self._robot.tubes), turn=TURN)
        self._near: Settled | None = None
        self._past: tuple[_core.FrictionSettled, ...] = ()  # what was found before that, the latest first
        self._stride = inf  # how far a step may be expected to get
        self._springs = np.array([tube.translation_compliance for tube in self._robot.tubes])
        loose = self._plays.any or self._equilibrium.tube_step.rubs or bool(self._springs.any())
        self._at_tensions = self._all_by_tension and not loose

    def run(self, state: DriveState | None, progress: Callable[[int, int], None] | None) -> Driven:
        state = self._rest() if state is None else state
        self._return(state)
        points: list[Reached] = []
        while len(points) < len(self._points):
            k = len(points)
            points += self._reach_some(state, k) or [self._reach(self._points[k], state)]
            state = points[-1].state()
            if progress is not None:
                for done in range(k, len(points)):
                    progress(done + 1, len(self._points))
        return driven_of(points, len(self._robot.tendons), [c.index for c in self._equilibrium.channels])

    def _reach_some(self, state: DriveState, first: int) -> list[Reached]:
        """Of points from the first on those that steps in the kernel lead to."""
        if self._near is None or not self._at_tensions:
            return []
        ahead = self._equilibrium.ahead(
            state.along,
            [self._near.found, *self._past],
            self._stride,
            self._numbers[first : first + AT_ONCE],
            (self._limits.missed, self._limits.turn, SHORTEST_STEP, CAREFUL, STRETCH),
        )
        reached, still = [], np.zeros(len(self._robot.tubes))
        for given, (found, steps, heats, creeps, seconds) in zip(
            self._points[first:], ahead.points, strict=False
        ):
            shape = partial(self._shape, found, given, seconds)
            remembered = partial(self._state, found, given)
            reached.append(Reached(shape, remembered, "", steps, heats, creeps, still, 0))
        if reached:
            self._near = Settled(ahead.found[0])
            self._past, self._stride = tuple(ahead.found[1:]), ahead.stride
        return reached

    def _rest(self) -> DriveState:
        robot = self._robot
        return DriveState(
            tuple(t.name for t in robot.tendons),
            tuple(t.name for t in robot.tubes),
            GivenProfiles(tuple(self._at_rest(j) for j in range(len(robot.tendons)))),
            None,
            self._points[0].at_zero(),
        )

    def _return(self, state: DriveState) -> None:
        """To the shape of a state that is gone on from."""
        if state.given is None:
            return
        if not np.array_equal(np.isnan(state.passed.displacement), np.isnan(self._points[0].displacement)):
            raise RobotError(
                "state",
                "tendons are pulled by tensions in it that the path pulls by displacements, or the reverse",
                "a path that pulls every tendon as before",
                value=state,
            )
        settled, _ = self._settle(state.given, state, cold=True)
        if settled is not None:
            self._taken(settled, state.given, state)

    def _at_rest(self, j: int) -> Profile | None:
        channel = next((c for c in self._equilibrium.channels if c.index == j), None)
        pretension = self._robot.tendons[j].pretension
        if channel is None or pretension == 0.0:
            return None
        return Profile.even(pretension, channel.end)

    def _reach(self, point: Actuators, state: DriveState) -> Reached:
        """A point, step by step."""
        start = perf_counter()
        heats, creeps = ([0.0] * len(self._equilibrium.channels) for _ in range(2))
        tube_heats = np.zeros(len(self._robot.tubes))
        state, count = self._approach(point, state, heats, creeps, tube_heats)
        settled, spent = self._near, (heats, creeps, tube_heats)
        if count == 0 or settled is None:
            plain = plain_shape(self._prepared, point.through(self._plays, state.passed))
            return Reached(lambda: plain, lambda: state, self._why(plain), max(count, 1), *spent, 0)
        seconds = perf_counter() - start
        passed = state.passed if settled.translation is None else state.passed.moved(settled.translation)
        later = partial(self._shape, settled.found, passed, seconds, settled.pulled)
        if settled.pulled is None:
            return Reached(later, lambda: state, "", count, *spent, settled.held)
        shape = later()
        failed = "" if shape.converged else self._why(shape)
        return Reached(lambda: shape, lambda: state, failed, count, *spent, settled.held)

    def _approach(
        self,
        point: Actuators,
        state: DriveState,
        heats: list[float],
        creeps: list[float],
        tube_heats: np.ndarray,
    ) -> tuple[DriveState, int]:
        """The state at a point, and in how many steps it was reached; 0: not. heats, creeps: by channel."""
        before = state.given
        if before is None or self._near is None:
            settled, _ = self._settle(point, state, cold=True)
            if settled is None:
                return state, 0
            return self._taken(settled, point, state), 1
        way = before.distance(point)
        done, count, step = 0.0, 0, self._stride / way if self._stride < way else 1.0
        while done < 1.0:
            parts = ceil((1.0 - done) / max(step, SHORTEST_STEP) - STRETCH)
            to = 1.0 if parts <= 1 else done + (1.0 - done) / parts
            step, ahead = to - done, before.towards(point, to)
            near, halves, snaps = self._near, step > (1.0 + 2.0 * STRETCH) * SHORTEST_STEP, False
            assert near is not None
            settled, missed = self._settle(ahead, state, cold=False, halves=halves)
            if settled is None:
                if halves:
                    step *= min(0.5, max(0.1, self._of_step(missed)))
                    continue
                settled, snaps = self._settle(ahead, state, cold=True)[0], True  # the branch is lost
                if settled is None and to < 1.0:  # from further away it may be found
                    to, ahead = 1.0, point
                    settled, snaps = self._settle(point, state, cold=False)[0], False
                if settled is None:
                    self._near = None
                    return state, 0
            if self._equilibrium.channels:
                for c, (loss, slip) in enumerate(zip(*self._equilibrium.spent(near, settled), strict=True)):
                    heats[c] += loss
                    creeps[c] = max(creeps[c], slip)
            if settled.tubes is not None:
                tube_heats += settled.tubes.heat
            state = self._taken(settled, ahead, state)
            if snaps:
                self._past = ()
            done, count, step = to, count + 1, step * min(4.0, self._of_step(missed))
        if way > 0.0:
            self._stride = step * way
        return state, count

    def _taken(self, settled: Settled, given: Actuators, state: DriveState) -> DriveState:
        passed = given.through(self._plays, state.passed)
        self._past = () if self._near is None else (self._near.found, *self._past[:1])
        self._near = settled
        along = self._equilibrium.profiles(settled.found)
        rubbing = None if settled.tubes is None else settled.tubes.state
        return DriveState(state.tendons, state.tubes, along, given, passed, rubbing)

    def _settle(
        self, given: Actuators, state: DriveState, *, cold: bool, halves: bool = False
    ) -> tuple[Settled | None, float]:
        """As ``Equilibrium.settle``; halves: a step that misses too much of its history need not be found, a
        shorter one follows."""
        passed = given.through(self._plays, state.passed)
        if not self._springs.any():
            return self._settle_at(passed, state, cold, halves)
        near = self._near
        translation = passed.translation if near is None or near.translation is None else near.translation
        for _ in range(MOST_YIELDS):
            settled, missed = self._settle_at(passed.moved(translation), state, cold, halves)
            if settled is None:
                return None, missed
            force = _core.energetics(settled.core, settled.solution)["force"]
            given_way = np.minimum(passed.translation - self._springs * force, 0.0)
            moved = float(np.abs(given_way - translation).max())
            if moved <= YIELD_SHARE * self._prepared.tolerance:
                return replace(settled, translation=translation), missed
            translation = given_way
        return None, 0.0

    def _settle_at(
        self, passed: Actuators, state: DriveState, cold: bool, halves: bool
    ) -> tuple[Settled | None, float]:
        """Where actuators pass on what they do, and springs stay as they are."""
        pulls = None
        if self._any_pulled:
            prepared, arrays = self._prepared, (passed.tension, passed.rotation, passed.translation)
            pulls = pulls_from(
                prepared._rest, arrays, passed.displacement, prepared._compliance, prepared.tolerance
            )
            if isinstance(pulls, Pulled):
                return None, 0.0
        if cold:
            plain = plain_shape(self._prepared, passed)
            if not plain.converged:
                return None, 0.0
            return self._equilibrium.settle(
                state.along, passed, pulls, None, plain._solution, stay=False, tubes=state.rubbing
            )
        near = self._near
        assert near is not None
        return self._equilibrium.settle(
            state.along,
            passed,
            pulls,
            near,
            near.solution,
            past=self._past,
            stay=True,
            limits=self._limits if halves else None,
            tubes=state.rubbing,
        )

    def _of_step(self, missed: float) -> float:
        """How much longer a step may be than one that missed so much of its history; inf: not known."""
        return CAREFUL * sqrt(self._limits.missed / missed) if missed > 0.0 else inf

    def _state(self, found: _core.FrictionSettled, given: Actuators) -> DriveState:
        """Without plays and tubes that rub."""
        names = tuple([t.name for t in self._robot.tendons]), tuple([t.name for t in self._robot.tubes])
        return DriveState(*names, self._equilibrium.profiles(found), given, given)

    def _shape(
        self, found: _core.FrictionSettled, passed: Actuators, seconds: float, pulled: Pulled | None = None
    ) -> Shape:
        prepared = self._prepared
        return Shape(
            found.robot,
            found.solution,
            base=self._robot,
            actuation=self._actuation(passed),
            tolerance=prepared.tolerance,
            residual_tolerance=prepared.residual_tolerance,
            stations=prepared._given_stations,
            solve_time=seconds,
            pulled=pulled,
            rest=lambda: prepared._rest,
            driven=True,
        )

    def _actuation(self, passed: Actuators) -> dict[str, Any]:
        """As ``Robot.with_actuation`` takes it."""
        actuation: dict[str, Any] = {"rotation": passed.rotation, "translation": passed.translation}
        if self._all_by_tension:
            return actuation | {"tension": passed.tension}
        tension, displacement = {}, {}
        for k, tendon in enumerate(self._robot.tendons):
            if self._pulled[k]:
                displacement[tendon.name] = float(passed.displacement[k])
            elif not isinstance(tendon.tension, TensionProfile):
                tension[tendon.name] = float(passed.tension[k])
        return actuation | {"tension": tension, "displacement": displacement}

    @staticmethod
    def _why(shape: Shape) -> str:
        if shape.converged:
            return "shape and friction did not settle together; the shape given is that without friction"
        return shape.message
