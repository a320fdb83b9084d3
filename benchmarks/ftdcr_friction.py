"""The real robot of ftdcr.py driven along its recording with friction of its tendons: what that changes.

    python benchmarks/ftdcr_friction.py                      # minutes for every coefficient above 0
    python benchmarks/ftdcr_friction.py --friction 0.05 0.2 --every 6

All numbers but the coefficient are those of the robot ftdcr_calibrated, which was calibrated without friction
on rows of all the recording: nothing is fitted here, and nothing held out. Every so many rows are driven
along in their order, with linear displacements in between, from rest.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import ftdcr
import numpy as np

import tactr
from tactr import Frame

FRAME = Frame(position=(0.269e-3, 1.950e-3, 1.606e-3), rotation=tuple(np.radians((0.341, -2.291, 0.0))))


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--friction", type=float, nargs="+", default=[0.0, 0.05], help="coefficients")
    parser.add_argument("--every", type=int, default=6, help="one of so many rows")
    options = parser.parse_args(arguments)
    if not ftdcr.DATA.is_dir():
        print(
            f"skipped: there are no recordings in ../{ftdcr.DATA.relative_to(ftdcr.ROOT.parent)}",
            file=sys.stderr,
        )
        return
    data = ftdcr.load()[1].rows(slice(0, None, options.every))
    robot = tactr.examples.load("ftdcr_calibrated")
    path = {"displacement": np.stack([data.displacement[tendon.name] for tendon in robot.tendons], axis=1)}
    measured = data.points[:, 0]
    moved = np.gradient(measured, axis=0)
    speed = np.linalg.norm(moved, axis=1)
    moving = speed > 1e-3
    for coefficient in options.friction:
        rubbing = robot.replace(tendons=tuple(replace(t, friction=coefficient) for t in robot.tendons))
        start = perf_counter()
        driven = tactr.drive(rubbing, path, stations=2)
        elapsed = perf_counter() - start
        residual = driven.tips @ FRAME.matrix.T + np.array(FRAME.position) - measured
        error = 1e3 * np.linalg.norm(residual, axis=1)
        ahead = 1e3 * (residual * moved).sum(axis=1)[moving] / speed[moving]
        print(
            f"friction {coefficient:g}: {driven}, {elapsed:.0f} s; mean error {np.nanmean(error):.3f} mm, "
            f"{np.nanmean(ahead):.3f} mm ahead; creep up to {1e3 * driven.creep.max():.2f} mm",
            flush=True,
        )


if __name__ == "__main__":
    main()
