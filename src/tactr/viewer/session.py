"""Solving as the controls move: every state from the last solution, and in words what came of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tactr.errors import TactrError
from tactr.robot import Robot
from tactr.statics import Shape, follow, solve
from tactr.viewer.pushing import continues, pushed, stable_near
from tactr.viewer.state import State

NEAR_A_SNAP = 0.3
"""Margin below which the page warns. It falls ever faster, as the root of the way that is left."""

Level = Literal["good", "warning", "bad"]


@dataclass(frozen=True, repr=False, eq=False)
class Outcome:
    """What came of a state. shape: its shape, or the last good one where it has none (None before there is
    any); fresh: whether it is its own; level, headline, reason: in words."""

    state: State
    shape: Shape | None
    fresh: bool
    level: Level
    headline: str
    reason: str = ""


class Session:
    """Solves states one after the other, each from the last solution; keeps the last good shape.

    As tubes and tendons move and as the tip force grows, the branch is followed through its snaps; switched
    loads or hosts are one step, on the last shape's branch where that goes on."""

    def __init__(self) -> None:
        self._good: Shape | None = None
        self._good_state: State | None = None
        self._rest: tuple[Robot, Shape] | None = None

    def start(self, shape: Shape | None = None) -> None:
        """Forget the robot so far; shape: a solution of the next one, to go on from."""
        self._rest = self._good_state = None
        self._good = shape if shape is not None and shape.converged else None

    def solve(self, state: State) -> Outcome:
        """The shape of a state, on the way from the last one. Never raises for what a user can do."""
        try:
            return self._solved(state)
        except TactrError as error:
            return self._kept(state, "not possible", str(error))

    def rest(self, state: State) -> Shape | None:
        """The shape without tendons and loads, tubes turned and inserted as in the state; None where none is
        found."""
        moved = {name: state.actuation.get(name, {}) for name in ("rotation", "translation")}
        try:
            robot = state.robot.with_actuation(**moved).replace(tendons=(), loads=())
            if self._rest is None or self._rest[0] != robot:
                self._rest = robot, solve(robot)
        except TactrError:
            return None
        shape = self._rest[1]
        return shape if _holds(shape) else None

    def _solved(self, state: State) -> Outcome:
        shape, snapped = self._moved(state)
        if not shape.converged:
            return self._kept(state, "no equilibrium", shape.message)
        if not shape.stable:
            return self._kept(state, "unstable", str(shape.stability))
        self._good, self._good_state = shape, state
        if snapped:
            reason = "On the way here the shape lost its stability and jumped to this one."
            return Outcome(state, shape, True, "warning", "snapped", reason)
        margin = shape.stability.margin
        if margin < NEAR_A_SNAP:
            reason = f"The stability margin is down to {margin:.2g}, at 0 it snaps or buckles."
            return Outcome(state, shape, True, "warning", "near a snap", reason)
        return Outcome(state, shape, True, "good", "stable")

    def _moved(self, state: State) -> tuple[Shape, bool]:
        """The shape of a state, and whether the robot snapped on the way there from the last one."""
        last, before = self._good, self._good_state
        if last is None or before is None:
            return solve(state.actuated, guess=last), False
        if before.structure == state.structure:
            return _followed(last, state.actuated)
        if (before.host, before.loads) == (state.host, state.loads):
            return pushed(last, before.tip_force, state)
        return stable_near(last, state.actuated)

    def _kept(self, state: State, headline: str, reason: str) -> Outcome:
        return Outcome(state, self._good, False, "bad", headline, reason)


def _followed(shape: Shape, target: Robot) -> tuple[Shape, bool]:
    """The shape of a robot on the branch of one whose actuation was another, and whether it snapped."""
    near = solve(target, guess=shape)  # most moves are small: one step
    if continues(shape, near):
        return near, False
    followed = follow(shape.robot, [{}, _actuation(target)], start=shape)
    return followed.shapes[-1], bool(followed.snaps)


def _actuation(robot: Robot) -> dict[str, dict[str, float]]:
    """All tensions that are numbers, displacements, rotations and translations, by name."""
    pulled = {t.name: t.displacement for t in robot.tendons if t.displacement is not None}
    plain = [t for t in robot.tendons if t.name not in pulled]
    return {
        "tension": {t.name: t.tension for t in plain if isinstance(t.tension, float)},
        "displacement": pulled,
        "rotation": {tube.name: tube.rotation for tube in robot.tubes},
        "translation": {tube.name: tube.translation for tube in robot.tubes},
    }


def _holds(shape: Shape) -> bool:
    return shape.converged and shape.stable
