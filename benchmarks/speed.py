"""How long a solve takes, on one core.

    python benchmarks/speed.py [--seconds 1.0]

Prints the machine and, for four robots, the median and the least time of many solves: warm from a
neighbouring shape (tensions 5 % and rotations 0.05 rad away) and cold, in the kernel
(Shape.solve_time) and from Python (Prepared.solve with arrays, and the tip). The targets are the project's.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import platform
import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tactr import Annulus, Helix, Material, PointLoad, Robot, Rod, Straight, Tendon, Tube, _core
from tactr.statics import Prepared, Shape

CHANGE_TENSION, CHANGE_ROTATION = 0.05, 0.05  # share, rad
DIRECTIONS = 20  # neighbouring shapes to start from, in random directions


class Row(NamedTuple):
    """One line of the table, times in s; target in microseconds, nan where there is none."""

    name: str
    times: np.ndarray
    target: float = float("nan")


def three_tubes() -> Robot:
    """Three precurved tubes turned apart; straight tendons on the outer two, a helix on the inner."""
    rows = [
        (0.14, 1.35e-3, 1.07e-3, 65e9, 24.4e9, (2.0, 0.0, 0.0), 0.0),
        (0.187, 1.0e-3, 0.8e-3, 45e9, 16.91e9, (4.0, 1.0, 0.0), 0.6),
        (0.246, 0.7e-3, 0.4e-3, 215e9, 80e9, (0.0, 6.0, 0.0), 1.2),
    ]
    tubes = [
        Tube(
            f"tube {i}",
            length=length,
            section=Annulus(outer, inner),
            material=Material(E=E, G=G),
            precurvature=rest,
            rotation=angle,
        )
        for i, (length, outer, inner, E, G, rest, angle) in enumerate(rows)
    ]
    tendons = [
        Tendon("tendon 0", "tube 0", Straight(0.0, 6.5e-3), tension=3.0),
        Tendon("tendon 1", "tube 1", Straight(-5.629165124598851e-3, 3.25e-3), tension=2.0),
        Tendon("tendon 2", "tube 2", Helix(6.5e-3, 3.0), tension=1.0),
    ]
    return Robot(tubes, tendons)


def one_tube(*, loaded: bool) -> Robot:
    """A rod with four straight tendons, with or without a force at its tip."""
    rod = Tube("rod", length=0.2, section=Rod(0.8e-3), material=Material(E=54e9, nu=0.3))
    tendons = [
        Tendon(f"tendon {j}", "rod", Straight.polar(5e-3, j * np.pi / 2), tension=tension)
        for j, tension in enumerate((1.0, 0.5, 0.1, 0.3))
    ]
    return Robot([rod], tendons, [PointLoad("rod", force=(0.05, 0.02, -0.03))] if loaded else [])


def concentric() -> Robot:
    """Three precurved tubes without tendons, pushed back and turned behind the guide."""
    rows = [
        ("outer", 0.199, 1.175e-3, 1.03e-3, 7.0, -0.1, 1.0),
        ("middle", 0.3305, 0.9e-3, 0.81e-3, 5.0, -0.2, 0.5),
        ("inner", 0.463, 0.762e-3, 0.65e-3, 10.0, -0.3, 0.0),
    ]
    tubes = [
        Tube(
            name,
            length=length,
            section=Annulus(2 * radius, 2 * bore),
            material=Material(E=58e9, nu=0.3),
            precurvature=[(0.0, (0.0, 0.0, 0.0)), (length - 0.05, (curvature, 0.0, 0.0))],
            translation=b,
            rotation=angle,
        )
        for name, length, radius, bore, curvature, b, angle in rows
    ]
    return Robot(tubes)


def derivatives(robot: Robot, seconds: float) -> Row:
    """Tip Jacobian with respect to every actuator and compliance of the tip, in one pass of the kernel."""
    shape = Prepared(robot).solve()
    reach, none = max(tube.tip for tube in robot.tubes), np.array([])
    found = []
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds:
        start = time.perf_counter()
        _core.sensitivities(shape._prepared, shape._solution, none, False, True, reach, [])
        found.append(time.perf_counter() - start)
    return Row("three tubes, three tendons, all derivatives", np.array(found))


def neighbours(prepared: Prepared, tension: np.ndarray, rotation: np.ndarray) -> list[Shape]:
    """Converged shapes at an actuation a little away, in random directions."""
    rng = np.random.default_rng(0)
    shapes = []
    for _ in range(DIRECTIONS):
        pull = tension * (1.0 + CHANGE_TENSION * rng.choice([-1.0, 1.0], tension.size))
        turn = rotation + CHANGE_ROTATION * rng.standard_normal(rotation.size)
        shape = prepared.solve(tension=pull, rotation=turn)
        if not shape.converged:
            raise RuntimeError(shape.message)
        shapes.append(shape)
    return shapes


def timed(
    solve: Callable[[Shape | None], Shape], guesses: list[Shape] | list[None], seconds: float
) -> np.ndarray:
    """Time in the kernel and in all, of solves repeated for so long; (2, many), s."""
    found = []
    begin = time.perf_counter()
    while len(found) < DIRECTIONS or time.perf_counter() - begin < seconds:
        for guess in guesses:
            start = time.perf_counter()
            shape = solve(guess)
            _ = shape.tip_position  # raises unless converged
            found.append((shape.solve_time, time.perf_counter() - start))
    return np.array(found).T


def rows_of(name: str, robot: Robot, targets: tuple[float, float, float], seconds: float) -> list[Row]:
    """Warm in the kernel and from Python, cold in the kernel and from Python."""
    prepared = Prepared(robot)
    tension = np.array([tendon.tension for tendon in robot.tendons], dtype=float)
    rotation = np.array([tube.rotation for tube in robot.tubes], dtype=float)

    def solve(guess: Shape | None) -> Shape:
        return prepared.solve(tension=tension, rotation=rotation, guess=guess)

    warm = timed(solve, neighbours(prepared, tension, rotation), seconds)
    cold = timed(solve, [None], seconds)
    return [
        Row(f"{name}, warm, kernel", warm[0], targets[0]),
        Row(f"{name}, warm, from Python", warm[1], targets[1]),
        Row(f"{name}, cold, kernel", cold[0], targets[2]),
        Row(f"{name}, cold, from Python", cold[1]),
    ]


def report(rows: list[Row]) -> None:
    """Print the table."""
    print(f"{'solve':54}{'median':>9}{'least':>9}{'solves':>9}{'target':>9}   (microseconds)")
    for row in rows:
        median, least = 1e6 * float(np.median(row.times)), 1e6 * float(row.times.min())
        target = "" if np.isnan(row.target) else f"{row.target:.0f}"
        verdict = "" if not target else "met" if median <= row.target else "missed"
        print(f"{row.name:54}{median:9.1f}{least:9.1f}{row.times.size:9d}{target:>9}   {verdict}")


def machine() -> str:
    """The processor's name, number of cores and load."""
    name = platform.processor() or platform.machine()
    with contextlib.suppress(OSError), open("/proc/cpuinfo", encoding="utf-8") as file:
        name = next((line.split(":")[1].strip() for line in file if line.startswith("model name")), name)
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    return f"{name}, {os.cpu_count()} cores{load}; Python {platform.python_version()}, numpy {np.__version__}"


def stay_on_one_core() -> None:
    """Pin this process where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=1.0, help="spent on each measurement")
    seconds = parser.parse_args().seconds
    stay_on_one_core()
    print(f"machine: {machine()}")
    none = float("nan")
    report(
        [
            *rows_of("three tubes, three tendons", three_tubes(), (100.0, 150.0, 300.0), seconds),
            *rows_of("one loaded tube, four tendons", one_tube(loaded=True), (60.0, none, none), seconds),
            derivatives(three_tubes(), seconds),
            *rows_of("three tubes behind a guide, no tendons", concentric(), (60.0, none, none), seconds),
            *rows_of("one unloaded tube, four tendons", one_tube(loaded=False), (20.0, none, none), seconds),
        ]
    )


if __name__ == "__main__":
    main()
