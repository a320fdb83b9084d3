"""Shapes computed by SoRoSim, another Cosserat code: gravity, a wrench in the middle and one at the tip."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr import Gravity, Material, PointLoad, Robot, Rod, Tube


@dataclass(frozen=True)
class Specimen:
    """A rod of the data set; tolerance: m, the tabulated loads are rounded."""

    tube: Tube
    tolerance: float


SPECIMENS = {
    "SpringSteel": Specimen(
        Tube("rod", length=0.6, section=Rod(0.0016), material=Material(E=200e9, nu=0.33, density=7870.0)),
        0.7e-3,
    ),
    "TPU": Specimen(
        Tube("rod", length=0.4, section=Rod(0.01), material=Material(E=70e6, nu=0.4, density=1200.0)), 0.4e-3
    ),
}


@dataclass(frozen=True)
class Entry:
    """One shape: loads in the file's axes, where the rod lies along x; stations as fractions of each half."""

    gravity: np.ndarray
    middle: np.ndarray  # (2, 3): moment, force
    tip: np.ndarray
    fractions: np.ndarray
    positions: np.ndarray


def entries(path: Path) -> Iterator[Entry]:
    with path.open(encoding="utf-8", newline="") as file:
        _, fractions, *rows = csv.reader(file)
    for k in range(0, len(rows), 6):
        block = np.array([row[1:] for row in rows[k : k + 6]], dtype=float).reshape(2, 3, -1)
        yield Entry(
            block[1, :, 0],
            block[..., 1],
            block[..., 2],
            np.array(fractions[4:], dtype=float),
            block[1, :, 3:].T,
        )


def turned(v: np.ndarray) -> tuple[float, float, float]:
    """From the file's axes to ours: x, along the rod, becomes z."""
    x, y, z = v
    return float(y), float(z), float(x)


@pytest.mark.parametrize("name", SPECIMENS)
def test_all_shapes(shared: Path, name: str) -> None:
    specimen = SPECIMENS[name]
    half = specimen.tube.length / 2
    errors = []
    for entry in entries(shared / "data" / "sorosim_statics" / f"{name}.csv"):
        loads = [
            Gravity(turned(entry.gravity)),
            PointLoad("rod", at=half, moment=turned(entry.middle[0]), force=turned(entry.middle[1])),
            PointLoad("rod", moment=turned(entry.tip[0]), force=turned(entry.tip[1])),
        ]
        stations = half * np.concatenate([entry.fractions[:7], 1.0 + entry.fractions[7:]])
        shape = tactr.solve(Robot([specimen.tube], loads=loads), stations=stations)
        assert shape.converged, shape.message
        expected = [turned(p) for p in entry.positions]
        errors.append(np.linalg.norm(shape.centreline - expected, axis=1).max())
    assert len(errors) == 100
    assert max(errors) <= specimen.tolerance
    assert float(np.median(errors)) <= 0.2e-3
