"""Solving as the controls move: every state from the last solution, and in words what came of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tactr.errors import TactrError
from tactr.robot import Robot
from tactr.statics import Prepared, Shape, solve
from tactr.viewer.state import State

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
    """Solves states one after the other, each from the last solution; keeps the last good shape."""

    def __init__(self) -> None:
        self._prepared: Prepared | None = None
        self._good: Shape | None = None
        self._rest: tuple[Robot, Shape] | None = None

    def start(self, shape: Shape | None = None) -> None:
        """Forget the robot so far; shape: a solution of the next one, to go on from."""
        self._rest = self._prepared = None
        self._good = shape if shape is not None and shape.converged else None

    def solve(self, state: State) -> Outcome:
        """The shape of a state: on the branch of the last one; where that ends or loses its stability, the
        stable one that a cold solve finds. Never raises for what a user can do."""
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
        structure = state.structure
        if self._prepared is None or self._prepared.robot != structure:
            self._prepared = Prepared(structure)
        shape = self._prepared.solve(**state.actuation, guess=self._good)
        snapped = self._good is not None and not _holds(shape)
        if snapped:
            shape = self._prepared.solve(**state.actuation)
        if not shape.converged:
            return self._kept(state, "no equilibrium", shape.message)
        if not shape.stable:
            return self._kept(state, "unstable", str(shape.stability))
        self._good = shape
        if snapped:
            reason = "The shape before ended or lost its stability; this is the stable shape found next."
            return Outcome(state, shape, True, "warning", "snapped", reason)
        if shape.stability.near_limit:
            return Outcome(state, shape, True, "warning", "near a snap", str(shape.stability))
        return Outcome(state, shape, True, "good", "stable")

    def _kept(self, state: State, headline: str, reason: str) -> Outcome:
        return Outcome(state, self._good, False, "bad", headline, reason)


def _holds(shape: Shape) -> bool:
    return shape.converged and shape.stable
