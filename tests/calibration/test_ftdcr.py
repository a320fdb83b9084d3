"""A real robot, judged on recordings that were held out; benchmarks/ftdcr.py gives all figures."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr import Frame, Measurements, Parameter

ROOT = Path(__file__).resolve().parents[2]
FRAME = Frame(position=(0.269e-3, 1.950e-3, 1.606e-3), rotation=tuple(np.radians((0.341, -2.291, 0.0))))
COLUMNS = ROOT / "examples" / "ftdcr_columns.yaml"


def recordings(shared: Path, name: str) -> Measurements:
    path = shared / "data" / "ftdcr_v4" / f"{name}.csv"
    if not path.exists():
        pytest.skip(f"no recordings: there is no {path.name} in the folder of reference data")
    return Measurements.read(path, columns=COLUMNS)


@pytest.fixture(scope="module")
def benchmark_module():
    path = ROOT / "benchmarks" / "ftdcr.py"
    if not path.exists():
        pytest.skip("no benchmarks folder")
    spec = importlib.util.spec_from_file_location("ftdcr_benchmark", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up there
    spec.loader.exec_module(module)
    return module


def test_single_pulls_out_predict_the_way_back(shared: Path) -> None:
    """Each tendon pulled alone: calibrated on the way out, judged on the way back, where friction leaves the
    tip elsewhere."""
    data = recordings(shared, "tendon_pull").rows(slice(0, None, 2))
    robot = tactr.examples.load("ftdcr")
    pulled = np.max(np.stack([data.displacement[tendon.name] for tendon in robot.tendons], axis=1), axis=1)
    assert data.group is not None
    back = np.zeros(len(data), dtype=bool)
    for group in dict.fromkeys(data.group):
        rows = np.array([name == group for name in data.group])
        top = np.flatnonzero(rows)[np.argmax(pulled[rows])]
        back |= rows & (np.arange(len(data)) > top)
    free = [
        "sensor.z",
        Parameter("tendons.*.compliance", common=True),
        "tendons.*.routing.phase",
        "tendons.*.zero",
    ]
    fit = tactr.calibrate(robot, data, parameters=free, folds=back)
    assert fit.hold_out is not None and fit.hold_out.missing == 0
    assert fit.hold_out.mean < 8e-3
    moved = np.linalg.norm(np.ptp(data.points[:, 0], axis=0))
    assert fit.hold_out.mean < 0.05 * moved


def test_the_calibrated_robot_meets_the_recordings(shared: Path) -> None:
    """The robot file that is shipped, which was calibrated on these recordings, on one of ten rows."""
    data = recordings(shared, "train").rows(slice(0, None, 10))
    fit = tactr.calibrate(tactr.examples.load("ftdcr_calibrated"), data, parameters=[], frame=FRAME)
    assert np.isfinite(fit.error).all() and fit.error.mean() < 4e-3


@pytest.mark.slow
def test_held_out_blocks_in_time(shared: Path, benchmark_module) -> None:
    """A fifth of the recording, in five blocks spread over it, predicted from the rest."""
    data = recordings(shared, "train")
    split = benchmark_module.blocks(data, 20, 4)
    held = split.label == 1
    train = data.rows(np.flatnonzero(~held)[::12])
    robot, free = tactr.examples.load("ftdcr"), benchmark_module.FULL
    fit = tactr.calibrate(robot, train, parameters=free, noise=benchmark_module.NOISE)
    error = fit.errors(data.rows(held))
    assert np.isfinite(error).all()
    assert error.mean() < 4.2e-3
