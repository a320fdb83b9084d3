"""The reachable volume of three precurved tubes, their insertions in order, and how far it can be trusted."""

from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory

import tactr
from tactr import InsertionOrder, Range, Samples, Study, examples

robot = examples.load("three_tube_ctr")
study = Study(
    robot,
    [
        *(Range(f"tubes.{tube.name}.rotation", -pi, pi) for tube in robot.tubes),
        Range("tubes.outer.translation", -0.19, -0.10),
        Range("tubes.middle.translation", -0.32, -0.11),
        Range("tubes.inner.translation", -0.45, -0.12),
    ],
    insertion=InsertionOrder(exposed=0.0, carriages=0.010),  # no tip behind the next outer one; 10 mm apart
    samples=Samples(4000, method="sobol", seed=1),
    name="three precurved tubes",
)
with TemporaryDirectory() as folder:
    results = tactr.sweep(study, Path(folder) / "results.zarr")
    summary = results.summary(voxel=0.015)
    highest = float(results.dataset.tip_position.sel(axis="z").max())
print(summary)
reached = summary.reached
