"""The real robot of ftdcr.py driven along its recording with friction or backlash: what that changes.

    python benchmarks/ftdcr_friction.py --every 1                         # all rows, 10 to 20 minutes
    python benchmarks/ftdcr_friction.py --every 1 --friction --fit play   # backlash alone, 2 minutes

Every so many rows are driven along in their order, with linear displacements in between, from rest, once for
every coefficient of all tendons and every backlash of all motors, and for every coefficient with the backlash
that was best. The one that fits the first part of the rows best is chosen, and judged on the rest, which is
held out from that choice. All other numbers are those of the robot ftdcr_calibrated: calibrated without
friction, on rows of all the recording. With --fit one backlash, one coefficient, or both, of all tendons are
calibrated on the first part, with their standard errors.
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
from tactr import Frame, Measurements, Parameter, Robot

START = {"play": 5e-5, "friction": 0.02}  # m, -
FRAME = Frame(position=(0.269e-3, 1.950e-3, 1.606e-3), rotation=tuple(np.radians((0.341, -2.291, 0.0))))


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--friction", type=float, nargs="*", default=[0.02, 0.05, 0.1, 0.2], help="coefficients"
    )
    parser.add_argument(
        "--play", type=float, nargs="*", default=[0.03, 0.04, 0.05, 0.06, 0.08, 0.1], help="in mm"
    )
    parser.add_argument("--every", type=int, default=6, help="one of so many rows")
    parser.add_argument("--train", type=float, default=0.5, help="share of the rows that choose")
    parser.add_argument("--fit", nargs="*", default=[], choices=list(START), help="calibrate these, too")
    options = parser.parse_args(arguments)
    if not ftdcr.DATA.is_dir():
        print(
            f"skipped: there are no recordings in ../{ftdcr.DATA.relative_to(ftdcr.ROOT.parent)}",
            file=sys.stderr,
        )
        return
    data = ftdcr.load()[1].rows(slice(0, None, options.every))
    train = round(options.train * len(data))
    print(f"{len(data)} rows, {train} to choose by, {len(data) - train} held out", flush=True)
    tried = [{}, *({"play": 1e-3 * play} for play in options.play)]
    tried += [{"friction": coefficient} for coefficient in options.friction]
    errors = [_driven(data, train, fields) for fields in tried]
    play = tried[_best(errors[: 1 + len(options.play)], train)]
    if play:
        together = [{"friction": coefficient} | play for coefficient in options.friction]
        errors += [_driven(data, train, fields) for fields in together]
        tried += together
    best = _best(errors, train)
    plain, chosen = (float(np.nanmean(errors[k][train:])) for k in (0, best))
    print(f"chosen: {_told(tried[best])}; held out {chosen:.3f} mm, {plain:.3f} mm without friction and play")
    if options.fit:
        _fit(data, train, options.fit)


def _best(errors: list[np.ndarray], train: int) -> int:
    return int(np.argmin([np.nanmean(error[:train]) for error in errors]))


def _driven(data: Measurements, train: int, fields: dict[str, float]) -> np.ndarray:
    """Error of every row, (n,), mm."""
    robot: Robot = tactr.examples.load("ftdcr_calibrated")
    path = {"displacement": np.stack([data.displacement[tendon.name] for tendon in robot.tendons], axis=1)}
    changed = robot.replace(tendons=tuple(replace(tendon, **fields) for tendon in robot.tendons))
    start = perf_counter()
    driven = tactr.drive(changed, path, stations=2)
    elapsed = perf_counter() - start
    measured = data.points[:, 0]
    residual = 1e3 * (driven.tips @ FRAME.matrix.T + np.array(FRAME.position) - measured)
    error = np.linalg.norm(residual, axis=1)
    error[[bool(text) for text in driven.failed]] = np.nan
    moved = np.gradient(measured, axis=0)
    speed = np.linalg.norm(moved, axis=1)
    moving = speed > 1e-3
    ahead = (residual * moved).sum(axis=1)[moving] / speed[moving]
    print(
        f"{_told(fields)}: {driven}, {elapsed:.0f} s; mean error {np.nanmean(error[:train]):.3f} mm of the "
        f"rows to choose by, {np.nanmean(error[train:]):.3f} mm held out, {np.nanmean(error):.3f} mm in all, "
        f"{np.nanmean(ahead):.3f} mm ahead; creep up to {1e3 * driven.creep.max():.2f} mm",
        flush=True,
    )
    return error


def _fit(data: Measurements, train: int, names: Sequence[str]) -> None:
    free = [Parameter(f"tendons.*.{name}", common=True, start=START[name]) for name in names]
    robot = tactr.examples.load("ftdcr_calibrated")
    fit = tactr.calibrate(robot, data.rows(slice(train)), parameters=free, frame=FRAME, history=True)
    print(f"{fit}\nheld out {1e3 * np.nanmean(fit.errors(data)[train:]):.3f} mm")


def _told(fields: dict[str, float]) -> str:
    units = {"play": (1e3, " mm"), "friction": (1.0, "")}
    parts = [f"{name} {value * units[name][0]:g}{units[name][1]}" for name, value in fields.items()]
    return ", ".join(parts) or "nothing"


if __name__ == "__main__":
    main()
