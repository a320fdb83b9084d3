"""Measurements from CSV files."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tactr.calibration.measurements import ACTUATION, Measurements, Remark, seen
from tactr.errors import FileError
from tactr.io.csv_table import Table, heading, number, table_in, unit_factor
from tactr.io.document import ProblemsFound, printable, read_text
from tactr.io.file_error import file_error
from tactr.io.read_path import ACTUATION_KIND
from tactr.io.units import UnitError, kind, parse_quantity

KIND = {**ACTUATION_KIND, "tip": "length"}
HEAD = "a line that names the columns, then rows"
EXAMPLES = 'such as "tip.x [mm]", "displacement.NAME [mm]", "tension.NAME [N]", "time [s]" or "group"'
_BRACKETS = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*")
_POINT = re.compile(r"(?P<place>tip|at\s+(?P<s>[^.]+(?:\.\d+)?\s*[a-zµ]+))\.(?P<axis>[xyz])")


class Column(NamedTuple):
    """index in the file; quantity such as "tip.x"; factor to SI."""

    index: int
    quantity: str
    factor: float


def read_measurements(path: Path, columns: str | Path | Mapping[str, str] | None) -> Measurements:
    """As ``Measurements.read``."""
    table = table_in(path, HEAD)
    named = {name: name for name in table.head} if columns is None else _mapped(table, columns)
    return _built(table, _columns(table, named))


def _mapped(table: Table, columns: str | Path | Mapping[str, str]) -> dict[str, str]:
    """From the column's name in the file to the quantity with its unit."""
    origin: str | Path = table.name
    if not isinstance(columns, Mapping):
        origin, columns = columns, _mapping(Path(columns))
    if not isinstance(columns, Mapping) or not all(isinstance(v, str) for v in columns.values()):
        expected = 'a mapping such as {"tip.x": "marker_x [mm]", "tension.left": "load_cell_1 [N]"}'
        raise FileError("columns are not a mapping of texts", path=origin, expected=expected)
    named: dict[str, str] = {}
    for quantity, column in columns.items():
        match = _BRACKETS.fullmatch(column)
        assert match is not None
        name, unit = column if column in table.head else match["name"], match["unit"]
        if name in named:
            raise FileError(f"the column {name!r} is used twice", path=origin)
        named[name] = str(quantity) if unit is None else f"{quantity} [{unit}]"
    return named


def _mapping(path: Path) -> Mapping[str, str]:
    from tactr.io.read_yaml import read_yaml

    try:
        return read_yaml(read_text(path)).data  # pyright: ignore[reportReturnType]
    except ProblemsFound as problems:
        raise file_error(problems.problems, path) from None


def _columns(table: Table, named: dict[str, str]) -> list[Column]:
    where = {"path": table.name, "line": table.line}
    missing = [name for name in named if name not in table.head]
    if missing:
        expected = f"one of {', '.join(printable(name) for name in table.head)}"
        raise FileError(f"there is no column {missing[0]!r}", expected=expected, **where)
    doubled = [name for name in named if table.head.count(name) > 1]
    if doubled:
        raise FileError("there are two columns called so", field=printable(doubled[0]), **where)
    found = [_column(table, table.head.index(name), text) for name, text in named.items()]
    quantities = [column.quantity for column in found]
    for quantity in quantities:
        if quantities.count(quantity) > 1:
            raise FileError("there are two columns for it", field=quantity, **where)
    places = {q[:-2] for q in quantities if q[-2:] in (".x", ".y", ".z") and q.split(".")[0] not in ACTUATION}
    for place in sorted(places) or ["tip"]:
        for axis in "xyz":
            if f"{place}.{axis}" not in quantities:
                expected = f'"{place}.{axis} [mm]" in the header, or named by columns'
                raise FileError(f"the column {place}.{axis} is missing", expected=expected, **where)
    if not any(q.split(".")[0] in ACTUATION for q in quantities):
        expected = '"displacement.NAME [mm]", "tension.NAME [N]" or the like'
        raise FileError("no column says what actuated the robot", expected=expected, **where)
    return found


def _column(table: Table, index: int, text: str) -> Column:
    name, unit = heading(text)
    if name == "group":
        return Column(index, name, 1.0)
    point = _POINT.fullmatch(name)
    first = "tip" if point else name.split(".")[0]
    if name != "time" and (first not in KIND or "." not in name or (first == "tip" and not point)):
        found = f"the column {printable(text)!r} is not known"
        expected = f"names {EXAMPLES}; or a mapping of columns, which leaves others out"
        raise FileError(found, path=table.name, line=table.line, expected=expected)
    if point and point["s"]:
        name = f"{_place(table, point['s'])!r}.{point['axis']}"
    factor = _seconds(table, unit) if name == "time" else unit_factor(table, name, unit, KIND[first])
    return Column(index, name, factor)


def _place(table: Table, text: str) -> float:
    try:
        return parse_quantity(text.strip(), kind("length"))
    except UnitError as error:
        raise FileError(f"at {text}: {error}", path=table.name, line=table.line) from None


def _seconds(table: Table, unit: str | None) -> float:
    factors = {"s": 1.0, "ms": 1e-3, "min": 60.0}
    if unit in factors:
        return factors[unit]
    found = "the column has no unit" if not unit else f"unit [{printable(unit)}]"
    raise FileError(found, path=table.name, line=table.line, field="time", expected="s, ms or min")


def _built(table: Table, columns: list[Column]) -> Measurements:
    rows = table.rows
    numbers = {c.quantity: _numbers(table, c) for c in columns if c.quantity != "group"}
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
        raise FileError("every row lacks a number", path=table.name)
    group = next((c.index for c in columns if c.quantity == "group"), None)
    time = numbers.get("time")
    return Measurements(
        points[whole],
        places=(*places, *([None] if "tip.x" in numbers else [])),
        **{k: {name: v[whole] for name, v in kinds.items()} for k, kinds in actuation.items()},
        time=None if time is None else time[whole],
        group=None if group is None else tuple(_cell(rows[i][1], group) for i in np.flatnonzero(whole)),
        lines=lines[whole],
        source=Path(table.name).name,
        remarks=remarks,
    )


def _missing(lines: np.ndarray, count: int) -> str:
    shown = ", ".join(str(line) for line in lines[:8]) + (", ..." if len(lines) > 8 else "")
    return f"{len(lines)} of {count} rows lack a number and are left out (lines {shown})"


def _numbers(table: Table, column: Column) -> np.ndarray:
    """SI units, NaN for cells that are empty or not finite."""
    cells = [(line, _cell(row, column.index)) for line, row in table.rows]
    values = [number(table, line, cell, column.quantity) if cell else np.nan for line, cell in cells]
    scaled = np.array(values) * column.factor
    return np.where(np.isfinite(scaled), scaled, np.nan)


def _cell(row: list[str], index: int) -> str:
    return row[index] if index < len(row) else ""
