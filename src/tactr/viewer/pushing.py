"""From one tip force to another on one branch, as ``tactr.follow`` does it for actuation."""

from __future__ import annotations

import numpy as np

from tactr.robot import Robot
from tactr.statics import Shape, solve
from tactr.viewer.state import AXES, State

LONGEST_TURN = 0.1  # rad at the tubes' tips in one step: a larger one is taken in smaller steps, or is a snap
LEAST_STEP, GROWTH = 1 / 256, 1.6  # of the way


def pushed(shape: Shape, force: tuple[float, float, float], goal: State) -> tuple[Shape, bool]:
    """The shape of a state, the tip force grown from another one (N) in steps, and whether it snapped.

    shape: a stable one with that force. Where its branch ends or loses its stability the shape is solved
    anew; where nothing is found the shape that did not converge comes back.
    """
    done, step, snapped = 0.0, 1.0, False
    while done < 1.0:
        ahead = min(done + step, 1.0)
        target = _between(force, goal, ahead).actuated
        candidate = solve(target, guess=shape)
        if not candidate.converged:
            return candidate, snapped
        near = continues(shape, candidate)
        if not near and step > LEAST_STEP:
            step = max(0.5 * step, LEAST_STEP)
            continue
        if not near:
            candidate, snapped = candidate if candidate.stable else solve(target), True
        if not (candidate.converged and candidate.stable):
            return candidate, snapped
        shape, done, step = candidate, ahead, GROWTH * step
    return shape, snapped


def continues(shape: Shape, candidate: Shape) -> bool:
    """Whether a shape is stable and so near to another one that no snap lies between."""
    return candidate.converged and candidate.stable and _turn(shape, candidate) <= LONGEST_TURN


def stable_near(shape: Shape, target: Robot) -> tuple[Shape, bool]:
    """The shape of another robot on the branch of a stable shape or, where that is not stable there, solved
    anew: a snap."""
    candidate = solve(target, guess=shape)
    lost = candidate.converged and not candidate.stable  # without a shape, a cold solve was tried as well
    return (solve(target), True) if lost else (candidate, False)


def _between(force: tuple[float, float, float], goal: State, part: float) -> State:
    for axis, start, end in zip(AXES, force, goal.tip_force, strict=True):
        goal = goal.with_value(("force", axis), end if part == 1.0 else start + part * (end - start))
    return goal


def _turn(a: Shape, b: Shape) -> float:
    """Largest angle by which the tip of a tube turns, rad."""
    turns = [one.frames[-1].T @ other.frames[-1] for one, other in zip(a.tubes, b.tubes, strict=True)]
    cosines = [0.5 * (np.trace(turn) - 1.0) for turn in turns]
    return float(np.arccos(np.clip(min(cosines), -1.0, 1.0)))
