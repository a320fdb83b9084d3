"""Share of random plausible robots whose tendons' displacements the solver meets from a cold start.

    python benchmarks/displacements.py [--count 2000] [--seed 0] [--processes 2]

Takes the robots of random_robots.py with seeds seed, seed + 1, ... that have tendons and an equilibrium at
their tensions. Half the tendons get a compliance of 0.01 to 1 mm/N, the others none; half of them, at least
one, are then pulled by displacements: those of the equilibrium, but for half the tendons without tension 0
to 2 mm less, so that they are slack. Prints the share that converges from cold without a guess, how many
came to the same tensions (others are at another equilibrium of the same displacements), every failure, and
whether every success holds when the displacements are computed anew from its shape and a solve at its
tensions. Exit code 1 when less than 99.9 % converge or a success is none.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import time
from dataclasses import dataclass, replace

import numpy as np
from convergence import machine
from random_robots import random_robot

from tactr.robot import Robot
from tactr.statics import Prepared, Shape, Status

WANTED = 0.999
TOLERANCE = 1e-6  # m
SAME_TIP = 1e-4  # m
ALLOWED = 2.0  # of the tolerance on displacements, in a solve with other steps


@dataclass(frozen=True)
class Outcome:
    """One robot: what became of it."""

    seed: int
    status: str
    message: str
    same: bool
    slack: int
    seconds: float
    solves: int
    worst: float
    false: bool


def pulled_robot(seed: int) -> tuple[Robot, np.ndarray] | None:
    """The robot with half its tendons pulled by displacements, and the tip it was at, m."""
    rng = np.random.default_rng([seed, 1])
    robot = random_robot(seed)
    if not robot.tendons:
        return None
    springs = [10 ** rng.uniform(-5, -3) if rng.random() < 0.5 else 0.0 for _ in robot.tendons]
    tendons = [replace(t, compliance=c) for t, c in zip(robot.tendons, springs, strict=True)]
    robot = robot.replace(tendons=tendons)
    shape = Prepared(robot, tolerance=TOLERANCE, stations=2).solve()
    if shape.status is not Status.CONVERGED:
        return None
    displacement = shape.displacement.copy()
    loose = (shape.tension == 0.0) & (rng.random(len(springs)) < 0.5)
    displacement -= loose * rng.uniform(0.0, 2e-3, len(springs))
    kept = rng.permutation(len(springs)) >= (len(springs) + 1) // 2
    displacement[kept] = np.nan
    return robot.with_actuation(displacement=displacement), shape.tip_position


def outcome_of(seed: int) -> Outcome | None:
    """Solve the robot of one seed from a cold start."""
    pulled = pulled_robot(seed)
    if pulled is None:
        return None
    robot, tip = pulled
    shape = Prepared(robot, tolerance=TOLERANCE, stations=2).solve()
    good = shape.status is Status.CONVERGED
    return Outcome(
        seed=seed,
        status=shape.status.value,
        message=shape.message,
        same=good and float(np.linalg.norm(shape.tip_position - tip)) < SAME_TIP,
        slack=len(shape.slack) if good else 0,
        seconds=shape.solve_time,
        solves=shape._pulled.solves if shape._pulled else 0,
        worst=shape.displacement_error if good else 0.0,
        false=good and not holds(robot, shape),
    )


def holds(robot: Robot, shape: Shape) -> bool:
    """Whether the displacements and slackness asked for are those of a solve at the tensions found."""
    at = robot.with_actuation(tension=shape.tension)
    again = Prepared(at, tolerance=TOLERANCE, stations=2).solve(guess=shape)
    asked = np.array([np.nan if t.displacement is None else t.displacement for t in robot.tendons])
    over = again.displacement - asked
    taut = again.tension > 0.0
    allowed = ALLOWED * 0.1 * TOLERANCE
    fits = np.where(taut, np.abs(over), -over) <= allowed
    return again.converged and bool((again.tension >= 0.0).all() and fits[~np.isnan(asked)].all())


def report(found: list[Outcome], tried: int, wall: float) -> bool:
    """Print what was found; True when it is good enough."""
    good = [o for o in found if o.status == Status.CONVERGED.value]
    print(f"machine: {machine()}, load {os.getloadavg()[0]:.1f}; wall time {wall:.0f} s")
    print(f"{tried} robots, {len(found)} with tendons and an equilibrium at their tensions")
    print(f"converged: {len(good)} of {len(found)} ({100 * len(good) / len(found):.2f} %), cold start")
    print(
        f"  at the tip they came from: {sum(o.same for o in good)}; "
        f"with slack tendons: {sum(o.slack > 0 for o in good)}"
    )
    print(f"worst displacement error of a success: {max(o.worst for o in good):.1e} m")
    times = 1e3 * np.sort([o.seconds for o in good])
    solves = np.median([o.solves for o in good])
    print(
        f"time of a success: median {np.median(times):.2f} ms, 99 % {np.quantile(times, 0.99):.1f} ms, "
        f"slowest {times[-1]:.0f} ms; solves at held tensions: median {solves:.0f}, "
        f"most {max(o.solves for o in good)}"
    )
    false = [o.seed for o in good if o.false]
    print(f"successes that are none: {len(false)} {false or ''}")
    for o in found:
        if o.status != Status.CONVERGED.value:
            print(f"  seed {o.seed}: {o.solves} solves, {o.seconds:.2f} s, {o.status}: {o.message}")
    return len(good) >= WANTED * len(found) and not false


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    begin = time.perf_counter()
    seeds = range(options.seed, options.seed + options.count)
    with multiprocessing.Pool(options.processes) as pool:
        found = [o for o in pool.imap(outcome_of, seeds, chunksize=20) if o is not None]
    return 0 if report(found, options.count, time.perf_counter() - begin) else 1


if __name__ == "__main__":
    raise SystemExit(main())
