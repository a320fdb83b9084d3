"""Measurements from CSV files."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tactr.calibration.measurements import ACTUATION, Measurements, Remark, seen
from tactr.errors import FileError
from tactr.io.document import ProblemsFound, printable, read_text
from tactr.io.file_error import file_error
from tactr.io.units import UnitError, kind, parse_quantity

KIND = {
    "displacement": "length",
    "tension": "force",
    "rotation": "angle",
    "translation": "length",
    "tip": "length",
    "time": "time",
}
EXAMPLES = 'such as "tip.x [mm]", "displacement.NAME [mm]", "tension.NAME [N]", "time [s]" or "group"'
_HEADER = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*")
_POINT = re.compile(r"(?P<place>tip|at\s+(?P<s>[^.]+(?:\.\d+)?\s*[a-zµ]+))\.(?P<axis>[xyz])")


class Column(NamedTuple):
    """index in the file; quantity such as "tip.x"; factor to SI."""

    index: int
    quantity: str
    factor: float


def read_measurements(path: Path, columns: str | Path | Mapping[str, str] | None) -> Measurements:
    """As ``Measurements.read``."""
    rows = _rows(path)
    line, header = rows[0]
    named = _mapped(path, columns) if columns is not None else {name: name for name in header}
    found = _columns(path, line, header, named)
    return _built(path, found, rows[1:])


def _rows(path: Path) -> list[tuple[int, list[str]]]:
    """Lines that say something, with their numbers."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except FileNotFoundError:
        raise FileError("no such file", path=path) from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise FileError(f"cannot be read: {error}", path=path) from None
    rows = [(line, row) for line, row in rows if any(row) and not row[0].startswith("#")]
    if len(rows) < 2:
        raise FileError("holds no rows", path=path, expected="a line that names the columns, then rows")
    return rows


def _mapped(path: Path, columns: str | Path | Mapping[str, str]) -> dict[str, str]:
    """From the column's name in the file to the quantity with its unit."""
    origin: Path | None = None
    if not isinstance(columns, Mapping):
        from tactr.io.read_yaml import read_yaml

        origin = Path(columns)
        try:
            document = read_yaml(read_text(origin))
        except ProblemsFound as problems:
            raise file_error(problems.problems, str(columns)) from None
        columns = document.data  # pyright: ignore[reportAssignmentType]
    if not isinstance(columns, Mapping) or not all(isinstance(v, str) for v in columns.values()):
        expected = 'a mapping such as {"tip.x": "marker_x [mm]", "tension.left": "load_cell_1 [N]"}'
        raise FileError("columns are not a mapping of texts", path=origin or path, expected=expected)
    named: dict[str, str] = {}
    for quantity, column in columns.items():
        match = _HEADER.fullmatch(column)
        assert match is not None
        if match["name"] in named:
            raise FileError(f"the column {match['name']!r} is used twice", path=origin or path)
        named[match["name"]] = f"{quantity} [{match['unit']}]" if match["unit"] is not None else str(quantity)
    return named


def _columns(path: Path, line: int, header: list[str], named: dict[str, str]) -> list[Column]:
    missing = [name for name in named if name not in header]
    if missing:
        raise FileError(
            f"there is no column {missing[0]!r}",
            path=path,
            line=line,
            expected=f"one of {', '.join(printable(name) for name in header)}",
        )
    doubled = [name for name in named if header.count(name) > 1]
    if doubled:
        raise FileError("there are two columns called so", path=path, line=line, field=printable(doubled[0]))
    found = [_column(path, line, header.index(name), text) for name, text in named.items()]
    quantities = [column.quantity for column in found]
    for quantity in quantities:
        if quantities.count(quantity) > 1:
            raise FileError("there are two columns for it", path=path, line=line, field=quantity)
    places = {q[:-2] for q in quantities if q[-2:] in (".x", ".y", ".z") and q.split(".")[0] not in ACTUATION}
    for place in sorted(places) or ["tip"]:
        for axis in "xyz":
            if f"{place}.{axis}" not in quantities:
                expected = f'"{place}.{axis} [mm]" in the header, or named by columns'
                raise FileError(
                    f"the column {place}.{axis} is missing", path=path, line=line, expected=expected
                )
    if not any(q.split(".")[0] in ACTUATION for q in quantities):
        expected = '"displacement.NAME [mm]", "tension.NAME [N]" or the like'
        raise FileError("no column says what actuated the robot", path=path, line=line, expected=expected)
    return found


def _column(path: Path, line: int, index: int, text: str) -> Column:
    match = _HEADER.fullmatch(text)
    assert match is not None
    name, unit = match["name"], match["unit"]
    if name == "group":
        return Column(index, name, 1.0)
    point = _POINT.fullmatch(name)
    first = "tip" if point else name.split(".")[0]
    if first not in KIND or (first != "time" and "." not in name) or (first == "tip" and not point):
        raise FileError(
            f"the column {printable(text)!r} is not known", path=path, line=line, expected=f"names {EXAMPLES}"
        )
    if point and point["s"]:
        name = f"{_place(path, line, point['s'])!r}.{point['axis']}"
    return Column(index, name, _factor(path, line, name, unit, KIND[first]))


def _place(path: Path, line: int, text: str) -> float:
    try:
        return parse_quantity(text.strip(), kind("length"))
    except UnitError as error:
        raise FileError(f"at {text}: {error}", path=path, line=line) from None


def _factor(path: Path, line: int, name: str, unit: str | None, what: str) -> float:
    if what == "time":
        factors = {"s": 1.0, "ms": 1e-3, "min": 60.0}
        if unit in factors:
            return factors[unit]
        raise FileError(f"unit {unit!r}", path=path, line=line, field=name, expected="s, ms or min")
    if not unit:
        expected = f'"{name} [{kind(what).units[0]}]"'
        raise FileError("the column has no unit", path=path, line=line, field=name, expected=expected)
    try:
        return parse_quantity(f"1 {unit}", kind(what))
    except UnitError as error:
        raise FileError(
            f"unit [{printable(unit)}]: {error.found}",
            path=path,
            line=line,
            field=name,
            expected=error.expected,
        ) from None


def _built(path: Path, columns: list[Column], rows: list[tuple[int, list[str]]]) -> Measurements:
    numbers = {c.quantity: _numbers(path, c, rows) for c in columns if c.quantity != "group"}
    places = sorted({float(q[:-2]) for q in numbers if q[0].isdigit()})
    names = [repr(place) for place in places] + (["tip"] if "tip.x" in numbers else [])
    points = np.stack([np.stack([numbers[f"{p}.{a}"] for a in "xyz"], axis=1) for p in names], axis=1)
    actuation = {
        k: {q[len(k) + 1 :]: v for q, v in numbers.items() if q.startswith(f"{k}.")} for k in ACTUATION
    }
    whole = seen(points)
    for kinds in actuation.values():
        for values in kinds.values():
            whole &= np.isfinite(values)
    lines, remarks = np.array([line for line, _ in rows]), ()
    if not whole.all():
        remarks = (Remark("missing-numbers", _missing(lines[~whole], len(lines))),)
    if not whole.any():
        raise FileError("every row lacks a number", path=path)
    group = next((c.index for c in columns if c.quantity == "group"), None)
    time = numbers.get("time")
    return Measurements(
        points[whole],
        places=(*places, *([None] if "tip.x" in numbers else [])),
        **{k: {name: v[whole] for name, v in kinds.items()} for k, kinds in actuation.items()},
        time=None if time is None else time[whole],
        group=None if group is None else tuple(rows[i][1][group] for i in np.flatnonzero(whole)),
        lines=lines[whole],
        source=path.name,
        remarks=remarks,
    )


def _missing(lines: np.ndarray, count: int) -> str:
    shown = ", ".join(str(line) for line in lines[:8]) + (", ..." if len(lines) > 8 else "")
    return f"{len(lines)} of {count} rows lack a number and are left out (lines {shown})"


def _numbers(path: Path, column: Column, rows: list[tuple[int, list[str]]]) -> np.ndarray:
    values = np.empty(len(rows))
    for k, (line, row) in enumerate(rows):
        cell = row[column.index] if column.index < len(row) else ""
        try:
            values[k] = float(cell) * column.factor if cell else np.nan
        except ValueError:
            raise FileError(
                f"{printable(cell)!r} is not a number", path=path, line=line, field=column.quantity
            ) from None
    return np.where(np.isfinite(values), values, np.nan)
