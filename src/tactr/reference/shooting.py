"""Shooting over the base strains: damped Newton, and continuation from the straight, unloaded robot."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tactr.reference.algebra import Array
from tactr.reference.march import Options, Scales, base_state, march
from tactr.reference.sections import Sections
from tactr.reference.transitions import BlownUp, settle

PROBE = 1e-6
"""Step of the difference quotients, in units of `Scales.strains`."""
COARSE = 1e-6
"""Relative integration tolerance for the difference quotients and for the way of a continuation."""
MAX_NEWTON = 15
MAX_HALVINGS = 6
MAX_TRIES = 30
"""Levels that the continuation tries before it gives up."""


@dataclass(frozen=True)
class Shot:
    """Base strains (4 + 2n) and what they leave over at the tubes' ends, scaled (4 + 2n)."""

    strains: Array
    left_over: Array
    iterations: int = 0

    @property
    def residual(self) -> float:
        """The largest scaled residual."""
        return float(np.abs(self.left_over).max())


class Missed(Exception):
    """Newton did not converge; `best` is the best shot, or None where not even the guess reached the tip."""

    def __init__(self, best: Shot | None) -> None:
        super().__init__()
        self.best = best


def local_guess(robot: Sections) -> Array:
    """Return base strains (4 + 2n) at which no resultant crosses the base (zero where Newton finds none)."""
    n = len(robot.rotations)
    rest = base_state(robot, np.zeros((1, 4 + 2 * n)))
    try:
        with np.errstate(all="ignore"):
            return settle(robot.sections[0], 0.0, rest, np.zeros((1, 4 + 2 * n))).strains[0]
    except (BlownUp, np.linalg.LinAlgError):
        return np.zeros(4 + 2 * n)


def jacobian(robot: Sections, strains: Array, options: Options, scales: Scales) -> Array:
    """Return d(scaled left-over)/d(scaled base strains), (4 + 2n, 4 + 2n), by difference quotients.

    All shifted robots march together, on the same steps: the quotients then differentiate one smooth map,
    whatever its tolerance.
    """
    shifted = strains + PROBE * np.vstack([np.zeros_like(strains), np.diag(scales.strains)])
    found = march(robot, shifted, replace(options, rtol=max(options.rtol, COARSE)), scales)
    return (found[1:] - found[0]).T / PROBE


def shoot(robot: Sections, guess: Array, options: Options, tolerance: float) -> Shot:
    """Return base strains that leave nothing over at the tubes' ends, by damped Newton from a guess (4 + 2n).

    The Jacobian is kept as long as each step gains a factor of ten. Raises Missed.
    """
    scales = Scales.of(robot)
    J: Array | None = None
    best: Shot | None = None
    try:
        best = Shot(guess, march(robot, guess[None], options, scales)[0])
        for iteration in range(1, MAX_NEWTON + 1):
            if best.residual <= tolerance:
                return best
            renewed = J is None
            if J is None:
                J = jacobian(robot, best.strains, options, scales)
            step = scales.strains * np.linalg.solve(J, best.left_over)
            better = damped(robot, best, step, options, scales)
            if better is None and renewed:
                break
            if better is None or better.residual > 0.1 * best.residual:
                J = None
            best = replace(better or best, iterations=iteration)
    except (BlownUp, np.linalg.LinAlgError) as error:
        raise Missed(best) from error
    raise Missed(best)


def damped(robot: Sections, shot: Shot, step: Array, options: Options, scales: Scales) -> Shot | None:
    """Return the first shot along -step, -step/2, -step/4 ... that leaves less over, or None."""
    for halving in range(MAX_HALVINGS):
        strains = shot.strains - 0.5**halving * step
        try:
            tried = Shot(strains, march(robot, strains[None], options, scales)[0])
        except BlownUp:
            continue
        if tried.residual < shot.residual:
            return tried
    return None


def shoot_from_rest(robot: Sections, options: Options, tolerance: float) -> Shot:
    """Return the shot found by raising tensions, rest curvatures and loads together from zero. Raises Missed.

    The guess at each level is `local_guess` plus the extrapolated difference from it; the first try is the
    full load. The way is marched coarsely, the end with the options given.
    """
    coarse = replace(options, rtol=max(options.rtol, COARSE))
    known: list[tuple[float, Array]] = [(0.0, np.zeros(4 + 2 * len(robot.rotations)))]
    stride, iterations = 1.0, 0
    missed: Missed | None = None
    for _ in range(MAX_TRIES):
        if known[-1][0] == 1.0:
            break
        level = min(1.0, known[-1][0] + stride)
        there = robot.scaled(level)
        local = local_guess(there)
        try:
            shot = shoot(there, local + extrapolated(known, level), coarse, 1e-6)
        except Missed as error:
            missed = error
            stride /= 2
            continue
        iterations += shot.iterations
        known.append((level, shot.strains - local))
        stride *= 2
    if known[-1][0] < 1.0 and missed is not None:
        raise missed
    shot = shoot(robot, local_guess(robot) + known[-1][1], options, tolerance)
    return replace(shot, iterations=iterations + shot.iterations)


def extrapolated(known: list[tuple[float, Array]], level: float) -> Array:
    """Return the straight line through the last two known values, at the level."""
    if len(known) < 2:
        return known[-1][1]
    (a, f), (b, g) = known[-2:]
    return g + (g - f) * (level - b) / (b - a)
