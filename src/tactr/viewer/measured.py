"""Measured points laid over a shape, and how far off it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tactr.errors import FileError
from tactr.io.csv_table import Table, heading, number, read_table, unit_factor

AXES = ("x", "y", "z")
EXPECTED = "a head such as x [mm], y [mm], z [mm]"


@dataclass(frozen=True, repr=False, eq=False)
class Misfit:
    """Distances of measured points to a shape, m: mean and largest to its centreline, and of the last point
    to its tip. gaps (n, 2, 3) m: from every point to the nearest on the centreline."""

    mean: float
    largest: float
    tip: float
    gaps: np.ndarray

    def __str__(self) -> str:
        mean, largest, tip = (1e3 * value for value in (self.mean, self.largest, self.tip))
        return (
            f"{len(self.gaps)} measured points: to the centreline {mean:.2f} mm on average, {largest:.2f} mm "
            f"at most; the last one to the tip {tip:.2f} mm"
        )


def read_points(text: str, name: str = "measured points") -> np.ndarray:
    """Points (n, 3) in m, world axes, from CSV with the columns x, y and z, units in the head.

    Raises FileError with name and line.
    """
    table = read_table(text, name, EXPECTED)
    columns = _columns(table)
    if not table.rows:
        raise FileError("has a head but no points", path=name, expected="one point a line")
    return np.array(
        [
            [factor * _finite(table, line, row, column, axis) for axis, (column, factor) in columns.items()]
            for line, row in table.rows
        ]
    )


def misfit(points: np.ndarray, centreline: np.ndarray, tip: np.ndarray) -> Misfit:
    """How far points (n, 3) are from a centreline (k, 3), straight in between, and its tip (3,), m."""
    start, along = centreline[:-1], np.diff(centreline, axis=0)
    away = points[:, None] - start
    share = np.einsum("nka,ka->nk", away, along) / np.einsum("ka,ka->k", along, along)
    foot = start + np.clip(share, 0.0, 1.0)[..., None] * along
    distance = np.linalg.norm(points[:, None] - foot, axis=-1)
    nearest = distance.argmin(axis=1)
    row = np.arange(len(points))
    gaps = np.stack([points, foot[row, nearest]], axis=1)
    least = distance[row, nearest]
    return Misfit(float(least.mean()), float(least.max()), float(np.linalg.norm(points[-1] - tip)), gaps)


def _columns(table: Table) -> dict[str, tuple[int, float]]:
    """Column and size of the unit in m, by axis."""
    place = {"path": table.name, "line": table.line, "expected": EXPECTED}
    found: dict[str, tuple[int, float]] = {}
    for k, cell in enumerate(table.head):
        axis, unit = heading(cell.lower())
        if axis not in AXES or not unit:
            continue
        if axis in found:
            raise FileError("is given twice", field=axis, **place)
        found[axis] = k, unit_factor(table, axis, heading(cell)[1], "length")
    for axis in AXES:
        if axis not in found:
            raise FileError("is missing, or has no unit", field=axis, **place)
    return {axis: found[axis] for axis in AXES}


def _finite(table: Table, line: int, row: list[str], column: int, axis: str) -> float:
    cell = row[column] if column < len(row) else ""
    value = number(table, line, cell, axis)
    if not np.isfinite(value):
        raise FileError(
            f"{cell!r} is not a number", path=table.name, line=line, field=axis, expected="a number"
        )
    return value
