"""Measured points laid over a shape, and how far off it is."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass

import numpy as np

from tactr.errors import FileError
from tactr.io.units import UnitError, kind, parse_quantity

AXES = ("x", "y", "z")
HEAD = re.compile(r"\s*([xyz])\s*[\[(]\s*([^\])]+?)\s*[\])]\s*", re.IGNORECASE)
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
    lines = text.lstrip("\ufeff").splitlines()
    separator = next((mark for mark in ("\t", ";", ",") if lines and mark in lines[0]), ",")
    rows = list(csv.reader(lines, delimiter=separator))
    if not rows:
        raise FileError("is empty", path=name, expected=EXPECTED)
    columns = _columns(rows[0], name)
    points = [
        [factor * _number(row, column, axis, name, line) for axis, (column, factor) in columns.items()]
        for line, row in enumerate(rows[1:], start=2)
        if any(cell.strip() for cell in row)
    ]
    if not points:
        raise FileError("has a head but no points", path=name, expected="one point a line")
    return np.array(points)


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


def _columns(head: list[str], name: str) -> dict[str, tuple[int, float]]:
    """Column and size of the unit in m, by axis."""
    found: dict[str, tuple[int, float]] = {}
    for k, cell in enumerate(head):
        match = HEAD.fullmatch(cell)
        if match is None:
            continue
        axis = match[1].lower()
        if axis in found:
            raise FileError("is given twice", path=name, line=1, field=axis, expected=EXPECTED)
        try:
            found[axis] = k, parse_quantity(f"1 {match[2]}", kind("length"))
        except UnitError as error:
            raise FileError(error.found, path=name, line=1, field=axis, expected=error.expected) from None
    for axis in AXES:
        if axis not in found:
            raise FileError("is missing, or has no unit", path=name, line=1, field=axis, expected=EXPECTED)
    return {axis: found[axis] for axis in AXES}


def _number(row: list[str], column: int, axis: str, name: str, line: int) -> float:
    cell = row[column].strip() if column < len(row) else ""
    try:
        number = float(cell)
    except ValueError:
        number = np.nan
    if not np.isfinite(number):
        raise FileError(f"{cell!r} is not a number", path=name, line=line, field=axis, expected="a number")
    return number
