"""Share of random plausible robots that the solver converges from a cold start.

    python benchmarks/convergence.py [--count 10000] [--seed 0] [--processes 2]

Solves the robots of random_robots.py with seeds seed, seed + 1, ... and prints the share converged (and how
many of these are unstable), every failure, the worst residual among the successes, and with --audit how often
the error estimate held (against a solve from the same shape with a tolerance of 1e-10 m). Exit code 1 when
less than 99.9 % converge or a success misses its tolerance.
"""

from __future__ import annotations

import argparse
import collections
import contextlib
import multiprocessing
import os
import platform
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from random_robots import random_robot

from tactr.statics import Prepared

WANTED = 0.999
TOLERANCE = 1e-6  # m
AUDIT_TOLERANCE = 1e-10
ANOTHER_SHAPE = 1e-3  # m
FLOOR = 1e-9  # m, below which an estimate is not asked to hold


@dataclass(frozen=True)
class Outcome:
    """One robot: what became of it. error: its true discretisation error where audited, m."""

    seed: int
    tubes: int
    converged: bool
    status: str
    message: str
    residual: float
    residual_tolerance: float
    discretisation_error: float
    iterations: int
    seconds: float
    fallback: bool
    error: float | None = None


def outcome_of(seed: int, *, audit: bool) -> Outcome:
    """Solve the robot of one seed from a cold start."""
    robot = random_robot(seed)
    shape = Prepared(robot, tolerance=TOLERANCE, stations=2).solve()
    error = None
    if audit and shape.converged:
        fine = Prepared(robot, tolerance=AUDIT_TOLERANCE, stations=2).solve(guess=shape)
        if fine.converged:
            error = float(((fine.tip_position - shape.tip_position) ** 2).sum() ** 0.5)
    return Outcome(
        seed=seed,
        tubes=len(robot.tubes),
        converged=shape.converged,
        status=shape.status.value,
        message=shape.message,
        residual=shape.residual,
        residual_tolerance=shape.residual_tolerance,
        discretisation_error=shape.discretisation_error,
        iterations=shape.iterations,
        seconds=shape.solve_time,
        fallback=shape._solution.used_continuation,
        error=error,
    )


def outcomes(seeds: Iterable[int], *, processes: int, audit: bool) -> Iterator[Outcome]:
    """Outcomes in the order of the seeds."""
    work = partial(outcome_of, audit=audit)
    if processes == 1:
        yield from map(work, seeds)
        return
    with multiprocessing.Pool(processes) as pool:
        yield from pool.imap(work, seeds, chunksize=50)


def report(found: list[Outcome], wall: float) -> bool:
    """Print what was found; True when it is good enough."""
    good = [o for o in found if o.converged]
    bad = [o for o in found if not o.converged]
    unstable = [o.seed for o in good if o.status != "converged"]
    print(f"machine: {machine()}, load {os.getloadavg()[0]:.1f}; wall time {wall:.0f} s")
    print(f"converged: {len(good)} of {len(found)} ({100 * len(good) / len(found):.2f} %), cold start")
    for tubes in sorted({o.tubes for o in found}):
        share = [o.converged for o in found if o.tubes == tubes]
        print(f"  {tubes} tubes: {sum(share)} of {len(share)}")
    print(f"of these to an unstable equilibrium, no stable one found: {len(unstable)} {unstable or ''}")
    print_successes(good)
    print_audit([Audit(o.error, o.discretisation_error, o.seed) for o in good if o.error is not None])
    missed = [o.seed for o in good if o.residual > o.residual_tolerance or o.discretisation_error > TOLERANCE]
    print(f"successes over a tolerance: {len(missed)} {missed or ''}")
    print(f"failures: {len(bad)} {dict(collections.Counter(o.status for o in bad)) or ''}")
    for o in bad:
        print(f"  seed {o.seed}: {o.tubes} tubes, {o.iterations} iterations, {o.seconds:.2f} s, {o.message}")
    return len(good) >= WANTED * len(found) and not missed


def machine() -> str:
    """The processor's name and number of cores."""
    name = platform.processor() or platform.machine()
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as file:
        name = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), name)
    return f"{name}, {os.cpu_count()} cores"


def print_successes(good: list[Outcome]) -> None:
    """Print residuals and times."""
    if not good:
        return
    residual, error = max(o.residual for o in good), max(o.discretisation_error for o in good)
    tolerance = min(o.residual_tolerance for o in good)
    print(f"worst residual of a success: {residual:.1e} (tolerances from {tolerance:.0e})")
    print(f"worst estimated discretisation error of a success: {error:.1e} m (tolerance {TOLERANCE:.0e} m)")
    times = 1e3 * np.sort([o.seconds for o in good])
    print(
        f"time of a success: median {np.median(times):.2f} ms, 99 % {np.quantile(times, 0.99):.1f} ms, "
        f"slowest {times[-1]:.0f} ms; by the fallback: {sum(o.fallback for o in good)}"
    )


class Audit(NamedTuple):
    """True and estimated discretisation error of one robot, m."""

    error: float
    estimate: float
    seed: int


def print_audit(audits: list[Audit]) -> None:
    """Print how the estimated error compares with the true one."""
    near = [a for a in audits if a.error <= ANOTHER_SHAPE]
    far = [a.seed for a in audits if a.error > ANOTHER_SHAPE]
    if not audits:
        return
    print(f"audited: {len(audits)}; another equilibrium found with finer steps: {len(far)} {far[:10] or ''}")
    held = np.mean([a.error <= max(a.estimate, FLOOR) for a in near])
    within = np.mean([a.error <= TOLERANCE for a in near])
    print(f"  true error below its estimate: {100 * held:.2f} %, below the tolerance: {100 * within:.2f} %")
    worst = sorted(near, reverse=True)[:5]
    listed = (f"{a.error:.1e} ({a.estimate:.1e}; {a.seed})" for a in worst)
    print(f"  worst true errors in m (estimate; seed): {', '.join(listed)}")


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--audit", action="store_true", help="compare with solves at a much finer tolerance")
    options = parser.parse_args()
    begin = time.perf_counter()
    seeds = range(options.seed, options.seed + options.count)
    found = list(outcomes(seeds, processes=options.processes, audit=options.audit))
    return 0 if report(found, time.perf_counter() - begin) else 1


if __name__ == "__main__":
    raise SystemExit(main())
