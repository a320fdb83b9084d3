"""Configurations a second of a sweep on 1 and 2 dask workers of this machine, in turns.

python benchmarks/sweep_workers.py [SAMPLES] [ROUNDS]. Start-up of the workers is not counted: the time is
that from the first chunk's arrival to the last one's. The load average is printed: other work shifts all.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from tactr import Range, Samples, Study, examples, sweep


def study(samples: int) -> Study:
    """Three tubes with three tendons, all tensions and rotations."""
    robot = examples.load("three_tube_a")
    tensions = [Range(f"tendons.{tendon.name}.tension", 0.0, 3.0) for tendon in robot.tendons]
    turns = [Range(f"tubes.{tube.name}.rotation", -3.0, 3.0) for tube in robot.tubes]
    return Study(
        robot, [*tensions, *turns], samples=Samples(samples),
        outputs=["tip", "stability", "jacobian"],
    )  # fmt: skip


def rate(chosen: Study, workers: int) -> tuple[float, float]:
    """Configurations a second, and this process's own share of a core meanwhile."""
    marks: list[tuple[float, float, int]] = []
    with TemporaryDirectory() as folder:
        sweep(
            chosen, Path(folder) / "x.zarr", workers=workers,
            progress=lambda done, _: marks.append((time.perf_counter(), time.process_time(), done)),
        )  # fmt: skip
    (begin, cpu, first), (end, cpu_end, last) = marks[1], marks[-1]
    return (last - first) / (end - begin), (cpu_end - cpu) / (end - begin)


def main() -> None:
    samples, rounds = (int(word) for word in (*sys.argv[1:], "40960", "3")[:2])
    chosen, rates = study(samples), {1: [], 2: []}
    for _ in range(rounds):
        for workers in (1, 2):
            found, own = rate(chosen, workers)
            rates[workers].append(found)
            load = os.getloadavg()[0]
            print(
                f"{workers} workers: {found:.0f}/s, this process {100 * own:.0f} % of a core, load {load:.1f}"
            )
    print(f"ratio of medians {median(rates[2]) / median(rates[1]):.2f}")


if __name__ == "__main__":
    main()
