"""What friction costs: a step of ``tactr.drive`` with it against a plain warm solve without, on one core.

    python benchmarks/friction.py [--points 60] [--repeats 5]

For every robot and path: time per point of ``tactr.drive`` (state in, state out, heat and stability of every
step) and of ``Prepared.solve`` from the shape before without friction, along the same path; the least of the
repeats, and the median, in CPU time, which does not count what else runs on the machine; and the median
ratio of the two, measured in turn.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from speed import three_tubes

import tactr
from tactr import Annulus, Material, Robot, Straight, Tendon, Tube
from tactr.statics import Prepared, Shape


def bending(**fields: object) -> Robot:
    """One tube of 200 mm that a tendon bends by up to 1.5 rad."""
    section = Annulus(2e-3, 1.6e-3)
    tube = Tube("tube", length=0.2, section=section, material=Material(E=5e9, nu=0.3))
    return Robot([tube], [Tendon("up", "tube", Straight(0.0, 1.2e-3), **fields)])  # pyright: ignore


def with_friction(robot: Robot, coefficient: float) -> Robot:
    """The robot with this coefficient on all tendons."""
    return robot.replace(tendons=tuple(replace(t, friction=coefficient) for t in robot.tendons))


def legs(corners: list[float], points: int) -> np.ndarray:
    """Along corners, evenly, (about points,)."""
    each = max(points // (len(corners) - 1), 1)
    parts = [np.linspace(a, b, each + 1)[1:] for a, b in pairwise(corners)]
    return np.concatenate([[corners[0]], *parts])


def microseconds(run: Callable[[], object], points: int) -> float:
    """Of CPU, per point."""
    start = time.process_time()
    run()
    return (time.process_time() - start) / points * 1e6


def turned(name: str, line: np.ndarray) -> tuple[Robot, Robot, np.ndarray]:
    """A built-in robot whose tubes rub in each other and in the guide, the same without friction, and
    rotations (points, tubes) that turn the innermost tube along a line, rad."""
    plain = tactr.examples.load(name)
    outer, *others = plain.tubes
    rubbing = replace(outer, friction=0.1), *(replace(tube, friction=0.15) for tube in others)
    rows = np.tile([tube.rotation for tube in plain.tubes], (len(line), 1))
    rows[:, -1] += line
    return plain.replace(tubes=rubbing), plain, rows


def plain_run(prepared: Prepared, kind: str, rows: np.ndarray, shape: Shape) -> None:
    """Warm solves along the path, from the shape at its start."""
    for row in rows:
        shape = prepared.solve(**{kind: row}, guess=shape)


def compare(
    name: str, robot: Robot, plain: Robot, rows: np.ndarray, repeats: int, kind: str = "tension"
) -> None:
    """Prints one row. kind: of actuation, rows (points, actuators)."""
    driven = tactr.drive(robot, {kind: rows})
    prepared = Prepared(plain)
    start = prepared.solve(**{kind: rows[0]})
    count, steps = len(rows), sum(driven.steps)
    times = []
    for _ in range(repeats):  # in turn: the speed of a machine changes while it is measured
        drive = microseconds(lambda: tactr.drive(robot, {kind: rows}), count)
        solve = [microseconds(lambda: plain_run(prepared, kind, rows, start), count) for _ in range(3)]
        times.append((drive, float(np.median(solve))))
    drive, solve = np.transpose(times)
    state = "" if driven.converged else "  NOT CONVERGED"
    print(
        f"{name:34}{steps:5d}{drive.min():10.0f}{np.median(drive):10.0f}{solve.min():10.0f}{np.median(solve):10.0f}"
        f"{np.median(drive / solve):8.1f}{state}"
    )


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description="Cost of friction of tendons and between tubes.")
    parser.add_argument("--points", type=int, default=60)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    one, disks = bending(friction=0.15), bending(friction=0.15, contacts=np.arange(0.02, 0.2, 0.02))
    three, rows = three_tubes(), np.array([3.0, 2.0, 1.0])
    title = "robot and path", "steps", "drive us", "median", "warm us", "median", "ratio"
    print(f"{title[0]:34}{title[1]:>5}" + "".join(f"{t:>10}" for t in title[2:6]) + f"{title[6]:>8}")
    for path, corners in (("pulled", [2.0, 8.0]), ("loops", [8.0, 3.0, 7.0, 2.0, 8.0])):
        line = legs(corners, options.points)
        one_row, three_rows = line[:, None], 0.25 * line[:, None] * rows
        compare(f"1 tube, 1 tendon, {path}", one, bending(), one_row, options.repeats)
        compare(f"1 tube, 9 disks, {path}", disks, bending(), one_row, options.repeats)
        rubbing = with_friction(three, 0.15)
        compare(f"3 tubes, 3 tendons, {path}", rubbing, three, three_rows, options.repeats)
    line = legs([0.0, 2.0, 0.5, 1.5, -0.5], options.points)
    for name in ("two_tube_90", "three_tube_a"):
        rubbing, plain, turns = turned(name, line)
        count = len(plain.tubes)
        compare(f"{count} tubes that rub, turned", rubbing, plain, turns, options.repeats, "rotation")


if __name__ == "__main__":
    main()
