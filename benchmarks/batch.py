"""Solves per second of tactr.solve_batch, and how the cost grows.

    python benchmarks/batch.py [--seconds 1.0] [--items 2048] [--device cpu]

Prints the machine, then solves per second from cold (no guesses), at 1 micrometre, least time of several
repeats: against the size of the batch, the number of threads, the instructions (none: one by one; baseline
and avx2: four side by side), of tubes and of tendons. Items are one robot at random tensions (half to one
and a half times its own) and rotations (within half a radian of its own). The robot with three tubes and
three tendons is that of benchmarks/speed.py. Cost per solve against tubes and tendons is fitted by
a + b tubes + c tendons: linear growth is the claim, what is left of the fit shows how far it holds.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable

import numpy as np
from speed import machine, three_tubes

import tactr
from tactr import Annulus, Material, Robot, Straight, Tendon, Tube, _core
from tactr.batch.designs import design_of

LEAST_REPEATS = 3
TOLERANCE = 1e-6
TARGET_ONE_CORE, TARGET_TWO_CORES = 15_000, 1.9


def family(tubes: int, tendons: int) -> Robot:
    """Nested precurved tubes whose ends are spread evenly over 240 mm, straight tendons on them in turn."""
    bore, made = 0.4e-3, []
    for i in reversed(range(tubes)):
        outer = bore + 0.2e-3
        made.append(
            Tube(
                f"tube {i}",
                length=0.24 * (i + 1) / tubes,
                section=Annulus(outer, bore),
                material=Material(E=60e9, nu=0.3),
                precurvature=(4.0 * np.cos(2.0 * i), 4.0 * np.sin(2.0 * i), 0.0),
                rotation=0.4 * i,
            )
        )
        bore = outer + 0.05e-3
    hosts = [f"tube {j % tubes}" for j in range(tendons)]
    pulls = [
        Tendon(f"tendon {j}", host, Straight.polar(4e-3, 2.4 * j), tension=0.5)
        for j, host in enumerate(hosts)
    ]
    return Robot(made[::-1], pulls)


def actuations(robot: Robot, items: int) -> tuple[np.ndarray, np.ndarray]:
    """Random tensions (items, tendons) N and rotations (items, tubes) rad."""
    rng = np.random.default_rng(0)
    tension = np.array([tendon.tension for tendon in robot.tendons], dtype=float)
    rotation = np.array([tube.rotation for tube in robot.tubes])
    return (
        tension * rng.uniform(0.5, 1.5, (items, len(tension))),
        rotation + rng.uniform(-0.5, 0.5, (items, len(rotation))),
    )


def least_time(work: Callable[[], object], seconds: float) -> float:
    """Of several repeats, s."""
    best, spent, repeats = np.inf, 0.0, 0
    while spent < seconds or repeats < LEAST_REPEATS:
        start = time.perf_counter()
        work()
        took = time.perf_counter() - start
        best, spent, repeats = min(best, took), spent + took, repeats + 1
    return best


def rate(robot: Robot, items: int, seconds: float, *, threads: int = 1, device: str = "cpu") -> float:
    """Solves per second through tactr.solve_batch."""
    tension, rotation = actuations(robot, items)

    def work() -> None:
        batch = tactr.solve_batch(
            robot, tension=tension, rotation=rotation, tolerance=TOLERANCE, threads=threads, device=device
        )
        if not batch.converged.all():
            raise RuntimeError(repr(batch))

    return items / least_time(work, seconds)


def kernel_rate(robot: Robot, items: int, seconds: float, lanes: str) -> tuple[float, float]:
    """Solves per second of the kernel on one thread, and the share solved side by side."""
    tension, rotation = actuations(robot, items)
    design = design_of(robot, TOLERANCE)
    translation = np.tile(design.translation, (items, 1))
    tolerance, skip = np.full(items, design.residual_tolerance), np.zeros(items, dtype=np.uint8)
    share = 0.0

    def work() -> None:
        nonlocal share
        found = _core.solve_batch(
            [design.core],
            tension,
            rotation,
            translation,
            tolerance,
            skip,
            np.zeros((1, 1)),
            TOLERANCE,
            10**6,
            [],
            1,
            lanes,
        )
        share = float(found["side_by_side"].mean())

    return items / least_time(work, seconds), share


def growth(seconds: float, items: int) -> None:
    """Cost against tubes and tendons, and the linear fit."""
    rows = [(n, 3) for n in range(1, 7)] + [(3, m) for m in (1, 2, 4, 6, 8, 12)]
    cost = []
    print(f"\n{'tubes':>5}{'tendons':>9}{'solves/s':>12}{'us':>9}   {'side by side':>12}")
    for tubes, tendons in rows:
        found, share = kernel_rate(family(tubes, tendons), items, seconds, "widest")
        cost.append(1e6 / found)
        print(f"{tubes:5d}{tendons:9d}{found:12.0f}{cost[-1]:9.1f}   {share:12.0%}")
    packed = [k for k, (tubes, _) in enumerate(rows) if tubes <= 4]
    A = np.array([[1.0, *rows[k]] for k in packed])
    fit, *_ = np.linalg.lstsq(A, np.array(cost)[packed], rcond=None)
    off = np.abs(A @ fit - np.array(cost)[packed]) / np.array(cost)[packed]
    print(
        f"fit up to four tubes: {fit[0]:.1f} + {fit[1]:.1f} tubes + {fit[2]:.1f} tendons us, "
        f"off by {off.mean():.0%} on average and {off.max():.0%} at most"
    )


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=1.0, help="spent on each measurement")
    parser.add_argument("--items", type=int, default=2048, help="configurations in a batch")
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    given = parser.parse_args()
    print(f"machine: {machine()}")
    robot = three_tubes()
    print("\nthree tubes, three tendons, from cold, 1 um\n")
    for lanes in ("none", "baseline", "avx2"):
        try:
            found, share = kernel_rate(robot, given.items, given.seconds, lanes)
        except ValueError as error:
            print(f"{lanes:>10}: {error}")
            continue
        print(f"{lanes:>10}: {found:9.0f} solves/s on one thread, {share:.0%} side by side")
    print(f"\n{'items':>8}{'threads':>9}{'solves/s':>12}")
    for items in (1, 16, 256, given.items):
        print(f"{items:8d}{1:9d}{rate(robot, items, given.seconds, device=given.device):12.0f}")
    one = rate(robot, given.items, given.seconds)
    print(
        f"one thread: {one:.0f}/s, target {TARGET_ONE_CORE}: {'met' if one >= TARGET_ONE_CORE else 'missed'}"
    )
    threads = 2
    while threads <= (os.cpu_count() or 1):
        many = rate(robot, given.items, given.seconds, threads=threads)
        verdict = (
            f", target {TARGET_TWO_CORES}: {'met' if many / one >= TARGET_TWO_CORES else 'missed'}"
            if threads == 2
            else ""
        )
        print(f"{threads} threads: {many:.0f}/s, {many / one:.2f} times one{verdict}")
        threads *= 2
    growth(given.seconds, given.items)


if __name__ == "__main__":
    main()
