"""Friction of tendons on random robots: do points settle, do finer steps change them, do loops close.

    python benchmarks/friction_wide.py [--count 40] [--first 0] [--points 20]

Takes the robots of random_robots.py with seeds first, first + 1, ... that have up to three tubes and pulled
tendons, and an equilibrium at their tensions, until there are count. Their tendons get coefficients up to
0.5, one for all or each its own, and in a quarter of the robots disks. Two paths of tactr.drive, points to a
leg, each from rest: all tendons in step, 0 -> T -> 0.4 T -> T three times over; and out of step, every
tendon between T and 0.4 T with a phase of its own, three cycles of two legs. Prints a line for each robot,
and what all of them come to:

lost          points that did not settle, of all points
one way, back, phases    how far twice as many points move the tip at most: on the way to T, on the first way
              back, and over the first cycle out of step
third, again  how far the third cycle's tips are from the second's at most, in step and out of step
heat, heat2   heat over the third cycle against the motors' work, share of the work; in step, out of step
creep         the largest slip of a tendon whose tension was left as it was, out of step
ms            CPU time for a point, all paths together

A change of the tip counts only where both points are reached. Exit code 1 where a point does not settle, or
where the tip changes by more than 1 um one way, or 10 um on the way back.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from friction import legs
from random_robots import random_robot

import tactr
from tactr import Robot, Tendon
from tactr.friction.driven import Driven
from tactr.statics import Prepared

MOST_TUBES, MOST_FRICTION, LOW = 3, 0.5, 0.4
ONE_WAY, BACK = 1e-6, 1e-5  # m, by which half the steps may move the tip
UM = 1e6


@dataclass(frozen=True)
class Outcome:
    """One robot; lengths in m, NaN where there is nothing to compare."""

    seed: int
    tubes: int
    tendons: int
    disks: bool
    friction: float
    lost: int
    points: int
    one_way: float
    back: float
    phases: float
    third: float
    again: float
    heat: float
    heat_phases: float
    creep: float
    seconds: float
    failed: tuple[str, ...]

    def __str__(self) -> str:
        lengths = (self.one_way, self.back, self.phases, self.third, self.again)
        moved = "".join(f"{UM * x:10.3g}" for x in lengths)
        tail = f"{self.heat:9.3f}{self.heat_phases:9.3f}{1e3 * self.creep:9.3f}"
        time = 1e3 * self.seconds / self.points
        return (
            f"{self.seed:6}{self.tubes:6}{self.tendons:8}"
            f"{'yes' if self.disks else 'no':>6}{self.friction:9.2f}"
            f"{self.lost:6}{moved}{tail}{time:8.1f}  {'; '.join(self.failed)}"
        )


TITLES = (
    f"{'seed':>6}{'tubes':>6}{'tendons':>8}{'disks':>6}{'friction':>9}{'lost':>6}"
    f"{'one way':>10}{'back':>10}{'phases':>10}{'third':>10}{'again':>10}"
    f"{'heat':>9}{'heat2':>9}{'creep':>9}{'ms':>8}\n"
    f"{'':41}{'um':>10}{'um':>10}{'um':>10}{'um':>10}{'um':>10}{'':>18}{'mm':>9}"
)


def rubbing_robot(seed: int) -> Robot | None:
    """The robot of a seed with friction; None where there is nothing to pull, or no equilibrium."""
    robot = random_robot(seed)
    if len(robot.tubes) > MOST_TUBES or not any(t.tension for t in robot.tendons):
        return None
    if not Prepared(robot, stations=2).solve().converged:
        return None
    rng = np.random.default_rng([seed, 3])
    coefficients = rng.uniform(0.0, MOST_FRICTION, len(robot.tendons))
    if rng.random() < 0.5:
        coefficients[:] = coefficients[0]
    disks = int(rng.integers(3, 13)) if rng.random() < 0.25 else 0
    tendons = [
        replace(t, friction=float(c), contacts=_contacts(robot, t, disks) if disks else None)
        for t, c in zip(robot.tendons, coefficients, strict=True)
    ]
    return robot.replace(tendons=tendons)


def _contacts(robot: Robot, tendon: Tendon, disks: int) -> np.ndarray:
    """So many places on what is outside the guide."""
    tube = next(tube for tube in robot.tubes if tube.name == tendon.tube)
    end = tube.length if tendon.end is None else tendon.end
    return np.linspace(-tube.translation, end, disks + 1)[1:] * 0.999


def rubbing_robots(first: int) -> Iterator[tuple[int, Robot]]:
    """One after the other, with their seeds."""
    seed = first
    while True:
        robot = rubbing_robot(seed)
        if robot is not None:
            yield seed, robot
        seed += 1


def in_step(robot: Robot, points: int, cycles: int) -> np.ndarray:
    """Tensions (k, tendons): from 0 to T, and so many times back to 0.4 T and up again."""
    return legs([0.0, 1.0, *([LOW, 1.0] * cycles)], (2 * cycles + 1) * points)[:, None] * _tension(robot)


def out_of_step(robot: Robot, seed: int, points: int, cycles: int) -> np.ndarray:
    """Tensions (k, tendons): to where the cycles begin, and so many cycles of two legs."""
    phase = np.random.default_rng([seed, 4]).uniform(0.0, 2.0 * np.pi, len(robot.tendons))
    turn = np.linspace(0.0, 2.0 * np.pi * cycles, 2 * cycles * points + 1)[:, None]
    share = 0.5 * (1.0 + LOW) + 0.5 * (1.0 - LOW) * np.cos(turn + phase)
    approach = np.linspace(0.0, 1.0, points + 1)[:-1, None] * share[0]
    return np.concatenate([approach, share]) * _tension(robot)


def _tension(robot: Robot) -> np.ndarray:
    return np.array([t.tension for t in robot.tendons], dtype=float)


def outcome_of(seed: int, robot: Robot, points: int) -> Outcome:
    """Drive the robot of one seed along both paths."""
    start = time.process_time()
    rows = [
        in_step(robot, points, 3),
        in_step(robot, 2 * points, 1)[: 4 * points + 1],
        out_of_step(robot, seed, points, 3),
        _halved(out_of_step(robot, seed, points, 1)),
    ]
    step, fine, phased, fine_phased = driven = [tactr.drive(robot, {"tension": r}, stations=2) for r in rows]
    seconds = time.process_time() - start
    n, creep = points, phased.creep[points + 1 :]
    coefficients = [t.friction for t in robot.tendons]
    return Outcome(
        seed=seed,
        tubes=len(robot.tubes),
        tendons=sum(t.tension != 0.0 for t in robot.tendons),
        disks=robot.tendons[0].contacts is not None,
        friction=float(np.mean(np.array(coefficients, dtype=float))),
        lost=sum(bool(text) for d in driven for text in d.failed),
        points=sum(len(r) for r in rows),
        one_way=_apart(step.tips[: n + 1], fine.tips[: 2 * n + 1 : 2]),
        back=_apart(step.tips[n + 1 : 2 * n + 1], fine.tips[2 * n + 2 :: 2]),
        phases=_apart(phased.tips[n : 3 * n + 1], fine_phased.tips[2 * n :: 2]),
        third=_apart(step.tips[5 * n :], step.tips[3 * n : 5 * n + 1]),
        again=_apart(phased.tips[5 * n :], phased.tips[3 * n : 5 * n + 1]),
        heat=_heat_share(step, 5 * n),
        heat_phases=_heat_share(phased, 5 * n),
        creep=float(creep.max(initial=0.0)),
        seconds=seconds,
        failed=tuple(sorted({text for d in driven for text in d.failed if text})),
    )


def _halved(rows: np.ndarray) -> np.ndarray:
    """With a point in the middle of every way."""
    out = np.empty((2 * len(rows) - 1, rows.shape[1]))
    out[::2] = rows
    out[1::2] = 0.5 * (rows[1:] + rows[:-1])
    return out


def _apart(one: np.ndarray, other: np.ndarray) -> float:
    """Largest distance of tips where both are known, m."""
    gaps = np.linalg.norm(one - other, axis=1)
    return float(np.nanmax(gaps)) if np.isfinite(gaps).any() else np.nan


def _heat_share(driven: Driven, first: int) -> float:
    """By how much the heat from a point on is more than the motors' work, share of that; NaN where a load has
    no potential, or a point is not reached."""
    if any(driven.failed[first:]):
        return np.nan
    try:
        work = tactr.work(driven.shapes[first:]).total
    except tactr.RobotError:
        return np.nan
    return float(driven.heat[first + 1 :].sum() / work - 1.0)


def report(found: list[Outcome]) -> bool:
    """Prints what all come to; True where it is good enough."""
    lost = [o for o in found if o.lost]
    points = sum(o.points for o in found)
    print(
        f"\n{len(found)} robots; points that did not settle: {sum(o.lost for o in found)} of {points}, "
        f"in {len(lost)} robots"
    )
    lines = (
        ("half the steps, one way, um", "one_way", UM, ONE_WAY),
        ("half the steps, way back, um", "back", UM, BACK),
        ("half the steps, out of step, um", "phases", UM, BACK),
        ("third cycle against second, um", "third", UM, BACK),
        ("the same, out of step, um", "again", UM, BACK),
        ("heat over work less 1, share", "heat", 1.0, 0.1),
        ("the same, out of step, share", "heat_phases", 1.0, 0.1),
    )
    print(f"{'':36}{'median':>10}{'90 %':>10}{'worst':>10}{'seed':>7}  over")
    for title, name, unit, limit in lines:
        known = [o for o in found if np.isfinite(getattr(o, name))]
        values = np.abs([getattr(o, name) for o in known])
        if not len(values):
            continue
        over = f"{(values > limit).sum()} of {len(values)} over {unit * limit:.3g}"
        numbers = "".join(
            f"{unit * x:10.3g}" for x in (np.median(values), np.quantile(values, 0.9), values.max())
        )
        print(f"{title:36}{numbers}{known[int(values.argmax())].seed:7}  {over}")
    times = 1e3 * np.array([o.seconds / o.points for o in found])
    numbers = "".join(f"{x:10.3g}" for x in (np.median(times), np.quantile(times, 0.9), times.max()))
    print(f"{'CPU time for a point, ms':36}{numbers}{found[int(times.argmax())].seed:7}")
    return not lost and all(not o.one_way > ONE_WAY and not o.back > BACK for o in found)


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--points", type=int, default=20)
    options = parser.parse_args()
    print(TITLES)
    found = []
    for seed, robot in rubbing_robots(options.first):
        if len(found) == options.count:
            break
        found.append(outcome_of(seed, robot, options.points))
        print(found[-1], flush=True)
    return 0 if report(found) else 1


if __name__ == "__main__":
    raise SystemExit(main())
