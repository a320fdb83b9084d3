"""Convergence from cold over the wider set of robots, and along paths of a thousand points.

    python benchmarks/wide.py [--count 20000] [--seed 0] [--processes 2] [--log wide.jsonl] [--held]
    python benchmarks/wide.py --paths 6 [--points 1000]

Solves the robots of wide_robots.py with seeds seed, seed + 1, ... from cold and writes a line to the log for
every one as it is done; seeds that the log has are not solved again, so that a run may be interrupted, and
continued with other seeds. Prints the share that converges, the share that is stable, every failure by
status, times, and every success that is none: over a tolerance of its own, or moved by more than the
tolerance (but not onto another branch) by a solve from it with a tolerance of 1e-9 m, or with displacements
that finer steps move by more than it, or that are not those of another solve at its tensions. Robots shown to
have no smooth equilibrium (kinks.py) are left out and named. --held: all robots stay at their tensions, none
is pulled by displacements. --any-force: tip forces up to 1 N, however slender the robot. Each with a log of
its own. Exit code 1 when less than 99.9 % converge or a success is none.

--paths: follows random robots of the set along random paths instead: rotations, insertions and displacements
or tensions change together, straight from corner to corner, 50 points each. Exit code 1 unless all points
converge.
"""

from __future__ import annotations

import argparse
import collections
import dataclasses
import json
import math
import multiprocessing
import os
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from convergence import machine
from kinks import kink_share
from wide_paths import follow_random_path
from wide_robots import displaced, slenderness, wide_robot

from tactr.robot import Robot
from tactr.statics import Prepared, Shape, Status

WANTED = 0.999
TOLERANCE, FINE = 1e-6, 1e-9  # m
FLOOR = 1e-9  # m, of a tip known to FINE
ANOTHER_SHAPE = 1e-3  # m
ALLOWED = 2e-7  # m, in a displacement computed anew: twice what is allowed in one solve


@dataclass(frozen=True)
class Outcome:
    """One robot: what became of it. moved: the tip by finer steps, m; pull_error: displacements by
    these, m; false: why a success is none, or empty. kink: above 0 where there is no smooth equilibrium: the
    share of tensions and loads at which a tendon reaches the centre of curvature (see kinks.py)."""

    seed: int
    tubes: int
    tendons: int
    pulled: int
    force: float
    converged: bool
    status: str
    message: str
    stable: bool
    seconds: float
    marches: int
    slack: int
    moved: float
    pull_error: float
    false: str
    kink: float = 0.0


def outcome_of(seed: int, *, held: bool, any_force: bool) -> Outcome:
    """Solve the robot of one seed from cold."""
    robot = wide_robot(seed, most_slender=math.inf) if any_force else wide_robot(seed)
    robot = robot if held else displaced(robot, seed, TOLERANCE)
    shape = Prepared(robot, tolerance=TOLERANCE, stations=2).solve()
    moved, pull_error, false = checked(robot, shape) if shape.converged else (0.0, 0.0, "")
    kinked = shape.status is Status.KINKED and all(t.displacement is None for t in robot.tendons)
    return Outcome(
        seed=seed,
        tubes=len(robot.tubes),
        tendons=len(robot.tendons),
        pulled=sum(t.displacement is not None for t in robot.tendons),
        force=slenderness(robot),
        converged=shape.converged,
        status=shape.status.value,
        message=shape.message,
        stable=shape.converged and shape.stable,
        seconds=shape.solve_time,
        marches=shape.iterations,
        slack=len(shape.slack) if shape.converged else 0,
        moved=moved,
        pull_error=pull_error,
        false=false,
        kink=(kink_share(robot) or 0.0) if kinked else 0.0,
    )


def checked(robot: Robot, shape: Shape) -> tuple[float, float, str]:
    """How far a fine solve at the shape's tensions moves its tip and its displacements, m, and what is
    wrong."""
    if shape.residual > shape.residual_tolerance or shape.discretisation_error > TOLERANCE:
        return 0.0, 0.0, "over its tolerance"
    if shape.displacement_error > 0.1 * TOLERANCE:
        return 0.0, 0.0, "a displacement over its tolerance"
    at = robot.with_actuation(tension=shape.tension)
    fine = Prepared(at, tolerance=FINE, stations=2).solve(guess=shape)
    if not fine.converged:
        return 0.0, 0.0, f"no finer solve: {fine.status.value}"
    moved = float(np.linalg.norm(fine.tip_position - shape.tip_position))
    pulled = any(tendon.displacement is not None for tendon in robot.tendons)
    pull_error = wrong_pull(robot, fine) if pulled else 0.0
    if moved > ANOTHER_SHAPE:
        return moved, pull_error, "another shape with finer steps"
    if moved > TOLERANCE + FLOOR:
        return moved, pull_error, "moved by finer steps"
    if not pulled:
        return moved, 0.0, ""
    if pull_error > TOLERANCE + ALLOWED:
        return moved, pull_error, "displacements moved by finer steps"
    again = Prepared(at, tolerance=TOLERANCE, stations=2).solve(guess=shape)
    held = again.converged and wrong_pull(robot, again) <= ALLOWED
    return moved, pull_error, "" if held else "displacements do not hold"


def wrong_pull(robot: Robot, at: Shape) -> float:
    """What is wrong in the robot's displacements at a solve at held tensions, m, at most."""
    asked = np.array(
        [np.nan if t.displacement is None else t.displacement for t in robot.tendons], dtype=float
    )
    over = at.displacement - asked
    return float(np.nanmax(np.where(at.tension > 0.0, np.abs(over), np.maximum(-over, 0.0))))


def solve_all(
    seeds: range, processes: int, log: Path, *, held: bool = False, any_force: bool = False
) -> list[Outcome]:
    """Outcomes of the seeds, those in the log as they stand there, the others added to it as they come."""
    lines = log.read_text().splitlines() if log.exists() else []
    found = {o.seed: o for o in (Outcome(**json.loads(line)) for line in lines)}
    left = [seed for seed in seeds if seed not in found]
    solve = partial(outcome_of, held=held, any_force=any_force)
    with log.open("a") as file, multiprocessing.Pool(processes) as pool:
        for outcome in pool.imap_unordered(solve, left, chunksize=4):
            found[outcome.seed] = outcome
            file.write(json.dumps(dataclasses.asdict(outcome)) + "\n")
            file.flush()
    return [found[seed] for seed in seeds]


def report(every: list[Outcome], wall: float) -> bool:
    """Print what was found; True when it is good enough."""
    found = [o for o in every if not o.kink]
    without = [(o.seed, round(o.kink, 3)) for o in every if o.kink]
    print(f"without a smooth equilibrium, left out: {len(without)} {without or ''}")
    good, bad = [o for o in found if o.converged], [o for o in found if not o.converged]
    print(f"machine: {machine()}, load {os.getloadavg()[0]:.1f}; wall time {wall:.0f} s")
    print(f"converged: {share(found)}, cold start; stable: {sum(o.stable for o in good)}")
    groups = {f"{n} tubes": [o for o in found if o.tubes == n] for n in sorted({o.tubes for o in found})}
    groups["displacements"] = [o for o in found if o.pulled]
    groups["a force at the tip"] = [o for o in found if o.force > 0.0]
    groups["a force above 2.5 EI / L^2"] = [o for o in found if o.force > 2.5]
    groups["a force above 25 EI / L^2"] = [o for o in found if o.force > 25.0]
    for name, group in groups.items():
        print(f"  {name}: {share(group)}")
    unstable = [o.seed for o in good if not o.stable]
    print(f"of these to an unstable equilibrium, no stable one found: {len(unstable)} {unstable or ''}")
    print(f"with slack tendons: {sum(o.slack > 0 for o in good)}")
    for name, group in (("success", good), ("failure", bad)):
        times = 1e3 * np.sort([o.seconds for o in group])
        if len(times):
            middle, late = np.median(times), np.quantile(times, 0.99)
            print(f"time of a {name}: median {middle:.2f} ms, 99 % {late:.0f} ms, slowest {times[-1]:.0f} ms")
    print(f"moved by a solve with a tolerance of {FINE} m: at most {max(o.moved for o in good):.1e} m")
    pulls = [o for o in good if o.pulled]
    if pulls:
        worst = max(pulls, key=lambda o: o.pull_error)
        coarse = sum(o.pull_error > TOLERANCE for o in pulls)
        print(
            f"displacements moved by these: at most {worst.pull_error:.1e} m (seed {worst.seed}), "
            f"over {TOLERANCE} m in {coarse} of {len(pulls)}"
        )
    false = [(o.seed, o.false) for o in good if o.false]
    print(f"successes that are none: {len(false)} {false or ''}")
    print(f"failures: {len(bad)} {dict(collections.Counter(o.status for o in bad)) or ''}")
    for o in sorted(bad, key=lambda o: (o.status, o.seed)):
        pulled = f"{o.pulled} of {o.tendons} tendons displaced" if o.pulled else f"{o.tendons} tendons"
        print(
            f"  seed {o.seed}: {o.status}; {o.tubes} tubes, {pulled}, "
            f"force {o.force:.3g} EI/L^2, {o.marches} marches, {o.seconds:.2f} s"
        )
    return len(good) >= WANTED * len(found) and not false


def share(group: list[Outcome]) -> str:
    """So many of so many."""
    good = sum(o.converged for o in group)
    return f"{good} of {len(group)} ({100 * good / max(len(group), 1):.2f} %)"


def follow_paths(seed: int, count: int, points: int) -> bool:
    """Follow so many robots with tendons, print what came of it; True when all points converge."""
    whole, done = True, 0
    while done < count:
        begin = time.perf_counter()
        followed = follow_random_path(seed, points)
        if followed is not None:
            whole, done = whole and followed.converged, done + 1
            print(f"seed {seed}: {followed!r} in {time.perf_counter() - begin:.0f} s", flush=True)
        seed += 1
    return whole


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--log", type=Path, default=Path("wide.jsonl"))
    parser.add_argument("--held", action="store_true", help="no displacements")
    parser.add_argument("--any-force", action="store_true", help="up to 1 N on every robot")
    parser.add_argument("--paths", type=int, default=0, help="robots to follow, instead")
    parser.add_argument("--points", type=int, default=1000, help="points of each path")
    options = parser.parse_args()
    if options.paths:
        return 0 if follow_paths(options.seed, options.paths, options.points) else 1
    begin = time.perf_counter()
    seeds = range(options.seed, options.seed + options.count)
    how = {"held": options.held, "any_force": options.any_force}
    found = solve_all(seeds, options.processes, options.log, **how)
    return 0 if report(found, time.perf_counter() - begin) else 1


if __name__ == "__main__":
    raise SystemExit(main())
