"""Random plausible robots of a wider set: insertion, loads, displacements, up to five tubes.

As random_robots.py, but for

tubes         1 to 5, equally likely.
length        distal ends innermost longest for half of the robots, else in any order: inner tubes withdrawn
              inside outer ones.
translation   three in four robots have proximal ends 0 to 200 mm behind the guide's exit, each its own.
loads         half of the robots: a force at the tip, of a size uniform from 0 to 1 N, or to 100 EI / L^2
              where that is less (EI of the tubes glued together, the least along the robot), in any
              direction, in world axes (3 in 4) or body axes. At 100 EI / L^2, forty times the load at which
              the robot buckles, all of it but a tenth next to the guide hangs along the force like a string.
              30 %: gravity in any direction.
displacements half of the robots that have tendons: 10 um/N to 1 mm/N of compliance for half their tendons,
none
              for the others; half of them, at least one, pulled by the displacements that they have in the
              equilibrium at their tensions, those without tension in half the cases 0 to 2 mm less. A robot
              without such an equilibrium stays at its tensions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from random_robots import _direction, _Place, _tendons, _tensioned, _tubes

from tactr.robot import Gravity, PointLoad, Robot, Tube
from tactr.robot.load import Load
from tactr.statics import Prepared, Status

STREAM = 20_000  # so that no robot of the narrower set returns
LARGEST_FORCE = 1.0  # N
MOST_SLENDER = 100.0  # EI / L^2


def wide_robot(seed: int, *, most_slender: float = MOST_SLENDER) -> Robot:
    """The robot of this seed at tensions, as distributed above; most_slender: of the tip force, EI / L^2."""
    rng = np.random.default_rng([seed, STREAM])
    tubes = _tubes(rng, _places(rng, int(rng.integers(1, 6))))
    tendons = _tensioned(rng, tubes, _tendons(rng, tubes))
    return Robot(tubes, tendons, _loads(rng, tubes, most_slender), name=f"wide {seed}")


def displaced(robot: Robot, seed: int, tolerance: float = 1e-6) -> Robot:
    """The robot, or, for half of those with tendons, the same pulled by displacements."""
    rng = np.random.default_rng([seed, STREAM, 1])
    if not robot.tendons or rng.random() < 0.5:
        return robot
    springs = [10 ** rng.uniform(-5, -3) if rng.random() < 0.5 else 0.0 for _ in robot.tendons]
    tendons = [replace(t, compliance=c) for t, c in zip(robot.tendons, springs, strict=True)]
    shape = Prepared(robot.replace(tendons=tendons), tolerance=tolerance, stations=2).solve()
    if shape.status is not Status.CONVERGED:
        return robot
    loose = (shape.tension == 0.0) & (rng.random(len(springs)) < 0.5)
    displacement = shape.displacement - loose * rng.uniform(0.0, 2e-3, len(springs))
    kept = rng.permutation(len(springs)) >= (len(springs) + 1) // 2
    displacement[kept] = np.nan
    return shape.robot.with_actuation(displacement=displacement)


def _places(rng: np.random.Generator, count: int) -> list[_Place]:
    length = rng.uniform(0.06, 0.3)
    tips = np.sort(np.append(rng.uniform(0.15, 1.0, count - 1), 1.0)) * length
    if rng.random() < 0.5:
        rng.shuffle(tips)
    starts = -rng.uniform(0.0, 0.2, count) if rng.random() < 0.75 else np.zeros(count)
    return [_Place(float(start), float(tip)) for start, tip in zip(starts, tips, strict=True)]


def _loads(rng: np.random.Generator, tubes: list[Tube], most_slender: float) -> list[Load]:
    loads: list[Load] = []
    if rng.random() < 0.5:
        last = max(tubes, key=lambda tube: tube.tip)
        most = min(LARGEST_FORCE, most_slender * bending_force(tubes))
        x, y, z = rng.uniform(0.0, most) * _direction(rng)
        axes = "world" if rng.random() < 0.75 else "body"
        loads.append(PointLoad(last.name, force=(x, y, z), axes=axes))
    if rng.random() < 0.3:
        x, y, z = 9.81 * _direction(rng)
        loads.append(Gravity((x, y, z)))
    return loads


def bending_force(tubes: Sequence[Tube]) -> float:
    """EI / length^2 of the tubes glued together, least anywhere, N: 2.5 of these buckle a column."""
    length = max(tube.tip for tube in tubes)
    s = (np.arange(200) + 0.5) * length / 200
    return min(sum(tube.stiffness.EI_x for tube in tubes if tube.tip > place) for place in s) / length**2


def slenderness(robot: Robot) -> float:
    """Force at the tip over EI / length^2, as bending_force has it."""
    force = max((math.hypot(*load.force) for load in robot.loads if isinstance(load, PointLoad)), default=0.0)
    return force / bending_force(robot.tubes)
