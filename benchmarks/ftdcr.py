"""A real three-segment, nine-tendon robot: calibrated on recordings, judged on what was held out of them.

    python benchmarks/ftdcr.py                  # all figures of docs/model_card.md
    python benchmarks/ftdcr.py --save FILE.yaml # write the calibrated robot, too

The recordings are read from ../shared/data/ftdcr_v4 beside the repository; without them nothing is done.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tactr
from tactr import Calibration, Measurements, Parameter, Robot
from tactr.io.files import dumps

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data" / "ftdcr_v4"
LENGTH = 0.1865  # m

COMPLIANCE = Parameter("tendons.*.compliance", common=True)
RADIUS = Parameter("tendons.*.routing.radius", common=True)
SENSOR = ["sensor.x", "sensor.y", "sensor.z", "sensor.rx", "sensor.ry"]
PHASES, ZEROS = "tendons.*.routing.phase", "tendons.*.zero"
BEND = ["tubes.backbone.precurvature.0.1.x", "tubes.backbone.precurvature.0.1.y"]
WEIGHT = "loads.0.force.z"
# Motors zeroed by hand, a backbone built straight: without single pulls the data hardly tell which is off.
KNOWN_ZEROS = Parameter(ZEROS, prior=(0.0, 0.3e-3))
KNOWN_BEND = [Parameter(path, prior=(0.0, 0.5)) for path in BEND]
STEPS: dict[str, list[str | Parameter]] = {
    "angles and elasticity of the tendons": ["sensor.z", COMPLIANCE, PHASES],
    "+ zeros of the motors, tilt of the base": [*SENSOR, COMPLIANCE, PHASES, ZEROS],
    "+ offset of the tendons, curvature of the rod": [*SENSOR, COMPLIANCE, PHASES, ZEROS, RADIUS, *BEND],
    "+ weight": [*SENSOR, COMPLIANCE, PHASES, ZEROS, RADIUS, *BEND, WEIGHT],
    "+ priors": [*SENSOR, COMPLIANCE, PHASES, KNOWN_ZEROS, RADIUS, *KNOWN_BEND, WEIGHT],
}
FULL = STEPS["+ priors"]
NOISE = 7e-3  # m, three times what a row misses: errors of rows near each other are alike, and count together
TRAIN_EVERY = 12  # neighbouring rows, 0.55 s apart, say nearly the same


@dataclass(frozen=True)
class Split:
    """What is held out together: names of parts and the part of each row."""

    name: str
    label: np.ndarray


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--every", type=int, default=TRAIN_EVERY, help="train on one of so many rows")
    parser.add_argument("--save", type=Path, help="write the robot calibrated on all rows")
    options = parser.parse_args(arguments)
    if not DATA.is_dir():
        print(f"skipped: there are no recordings in ../{DATA.relative_to(ROOT.parent)}", file=sys.stderr)
        return
    robot, data = load()
    print(f"{data}\n")
    splits = [blocks(data, 5, 1), blocks(data, 20, 4), motions(data)]
    for name, parameters in STEPS.items():
        chosen = splits if parameters is FULL else splits[:1]
        for split in chosen:
            error = held_out(robot, data, parameters, split, options.every)
            print(f"{name}; {split.name}: {told(error, split.label)}", flush=True)
    fit = calibrated(robot, data, options.every)
    print(f"\ncalibrated on one of {options.every} rows:\n\n{fit}\n")
    print(where_the_errors_sit(fit, data))
    print(f"\nframe: {fit.frame}")
    if options.save is not None:
        options.save.write_text(robot_file(fit), encoding="utf-8")
        print(f"wrote {options.save}")


def load(name: str = "train") -> tuple[Robot, Measurements]:
    """The robot as published, and recordings of it."""
    robot = tactr.examples.load("ftdcr")
    columns = ROOT / "examples" / "ftdcr_columns.yaml"
    return robot, Measurements.read(DATA / f"{name}.csv", columns=columns)


def calibrated(robot: Robot, data: Measurements, every: int = TRAIN_EVERY) -> Calibration:
    """With all that the physics of the model has a name for, on one of so many rows."""
    return tactr.calibrate(robot, data.rows(slice(0, None, every)), parameters=FULL, noise=NOISE)


def robot_file(fit: Calibration) -> str:
    """The calibrated robot, its numbers to six digits, and where the sensor saw it."""
    robot = fit.robot.replace(
        name="ftdcr_calibrated",
        description=(
            "The robot ftdcr with what its recordings say of it (benchmarks/ftdcr.py, docs/model_card.md): "
            "angles, offset and elasticity of the tendons, lengths at which the motors read zero, curvature "
            f"and weight. The sensor saw its base at {_rounded(fit.frame.position, 1e3)} mm, turned by the "
            f"rotation vector {_rounded(fit.frame.rotation, 180.0 / np.pi)} deg."
        ),
        assumed=("tubes[0].material: E and nu as in ftdcr; displacements see E times compliance only",),
    )
    text = re.sub(r"-?\d+\.\d{4,}(e-?\d+)?", lambda number: f"{float(number[0]):.6g}", dumps(robot))
    return f"# the real robot ftdcr, calibrated on its recordings\n{text}"


def _rounded(vector: Sequence[float], factor: float) -> str:
    return "(" + ", ".join(f"{factor * component:.3f}" for component in vector) + ")"


def blocks(data: Measurements, count: int, apart: int) -> Split:
    """Successive rows, so many blocks in time; where several are held out together they are spread."""
    parts = np.array_split(np.arange(len(data)), count)
    together = count // apart
    label = np.concatenate([np.full(len(part), k % together) for k, part in enumerate(parts)])
    return Split(f"{count} blocks in time, {apart} held out at once", label)


def motions(data: Measurements) -> Split:
    """Kinds of motion: single pulls, each segment, each pair of segments."""
    assert data.group is not None
    found = [re.search(r"tendon|seg\d|pair\d\d", name) for name in data.group]
    kinds = [match.group() if match else "other" for match in found]
    names = list(dict.fromkeys(kinds))
    return Split(f"kinds of motion ({', '.join(names)})", np.array([names.index(kind) for kind in kinds]))


def held_out(
    robot: Robot, data: Measurements, parameters: Sequence[str | Parameter], split: Split, every: int
) -> np.ndarray:
    """Error of every row, m, predicted by a calibration on rows of other parts."""
    error = np.empty(len(data))
    for part in np.unique(split.label):
        train = np.flatnonzero(split.label != part)[::every]
        fit = tactr.calibrate(robot, data.rows(train), parameters=parameters, noise=NOISE)
        error[split.label == part] = fit.errors(data.rows(split.label == part))
    return error


def told(error: np.ndarray, label: np.ndarray) -> str:
    means = ", ".join(f"{np.nanmean(error[label == part]) * 1e3:.2f}" for part in np.unique(label))
    mean = np.nanmean(error)
    missing = f", {np.isnan(error).sum()} rows without equilibrium" if np.isnan(error).any() else ""
    return (
        f"mean {mean * 1e3:.2f} mm ({mean / LENGTH:.1%}), median {np.nanmedian(error) * 1e3:.2f} mm, "
        f"parts {means}{missing}"
    )


def where_the_errors_sit(fit: Calibration, data: Measurements) -> str:
    """By kind of motion, along the motion, and against how far two passes are apart."""
    residual = (fit.predict(data) - data.points)[:, 0] * 1e3
    error, split = np.linalg.norm(residual, axis=1), motions(data)
    names = split.name.partition("(")[2].rstrip(")").split(", ")
    kinds = ", ".join(f"{name} {error[split.label == k].mean():.2f}" for k, name in enumerate(names))
    moved = np.gradient(data.points[:, 0] * 1e3, axis=0)
    speed = np.linalg.norm(moved, axis=1)
    moving = speed > 1.0
    along = (residual * moved).sum(axis=1)[moving] / speed[moving]
    pairs, apart = _passes(data, residual)
    return "\n".join(
        [
            f"all rows: mean error {error.mean():.2f} mm; by kind of motion: {kinds}",
            f"along the motion the prediction is {along.mean():.2f} mm ahead (spread {along.std():.2f} mm)",
            f"{pairs} pairs of rows, more than 8 rows apart, have displacements within 0.5 mm: their errors",
            f"differ by {apart:.2f} mm, half of which no function of displacements explains",
        ]
    )


def _passes(data: Measurements, residual: np.ndarray) -> tuple[int, float]:
    """How many pairs of rows nearly share displacements, and how far their residuals are apart, mm."""
    from scipy.spatial import KDTree

    displacement = np.stack(list(data.displacement.values()), axis=1)
    pairs = KDTree(displacement).query_pairs(0.5e-3, output_type="ndarray")
    pairs = pairs[np.abs(pairs[:, 0] - pairs[:, 1]) > 8]
    apart = np.linalg.norm(residual[pairs[:, 0]] - residual[pairs[:, 1]], axis=1)
    rows = np.concatenate([pairs[:, 0], pairs[:, 1]])
    sums, counts = (np.bincount(rows, weights, len(residual)) for weights in (np.tile(apart, 2), None))
    return len(pairs), float((sums[counts > 0] / counts[counts > 0]).mean())


if __name__ == "__main__":
    main()
