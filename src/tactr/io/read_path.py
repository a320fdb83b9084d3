"""A path of actuation from a CSV file: a row for every point."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

from tactr.errors import FileError, RobotError
from tactr.io.csv_table import Table, heading, number, table_in, unit_factor
from tactr.io.document import printable
from tactr.robot import Robot

ACTUATION_KIND = {
    "displacement": "length",
    "tension": "force",
    "rotation": "angle",
    "translation": "length",
}
HEAD = 'a line that names the columns, such as "tension.NAME [N]", then rows'
Point = dict[str, dict[str, float]]


class ActuationPath(NamedTuple):
    """points as ``tactr.drive`` takes them, SI units; lines of the file that they are on."""

    points: list[Point]
    lines: list[int]


class _Column(NamedTuple):
    index: int
    kind: str
    name: str
    factor: float


def read_path(path: str | Path, robot: Robot) -> ActuationPath:
    """A path from a CSV file (UTF-8; commas, semicolons or tabs), a row for every point.

    Columns: "tension.NAME [N]", "displacement.NAME [mm]", "rotation.NAME [deg]", "translation.NAME [mm]",
    with the names of tendons or tubes; what has no column stays as the robot has it. Lines that start with #
    are skipped. Raises FileError with line, column and value.
    """
    table = table_in(Path(path), HEAD)
    columns = [_column(table, k, robot) for k in range(len(table.head))]
    named = [(column.kind, column.name) for column in columns]
    for kind, name in named:
        if named.count((kind, name)) > 1:
            raise _wrong(table, table.line, f"{kind}.{name}", "there are two columns for it", "one")
        if kind == "displacement" and ("tension", name) in named:
            found = "its tension has a column, too"
            raise _wrong(table, table.line, f"{kind}.{name}", found, "a tension or a displacement, not both")
    points = [_point(table, line, row, columns, robot) for line, row in table.rows]
    return ActuationPath(points, [line for line, _ in table.rows])


def _column(table: Table, index: int, robot: Robot) -> _Column:
    name, unit = heading(table.head[index])
    kind, dot, owner = name.partition(".")
    if kind not in ACTUATION_KIND or not dot:
        shown = ", ".join(f"{each}.NAME" for each in ACTUATION_KIND)
        found = f"the column {printable(table.head[index])!r} is not known"
        raise FileError(found, path=table.name, line=table.line, expected=f"{shown}, each with its unit")
    members = robot.tendons if kind in ("tension", "displacement") else robot.tubes
    names = [member.name for member in members]
    if owner not in names:
        what = "tendon" if members is robot.tendons else "tube"
        found = f"the robot has no {what} {printable(owner)!r}"
        raise _wrong(table, table.line, name, found, ", ".join(names) or f"no such column: it has no {what}s")
    return _Column(index, kind, owner, unit_factor(table, name, unit, ACTUATION_KIND[kind]))


def _point(table: Table, line: int, row: list[str], columns: list[_Column], robot: Robot) -> Point:
    point: Point = {}
    for column in columns:
        field = f"{column.kind}.{column.name}"
        cell = row[column.index] if column.index < len(row) else ""
        if not cell:
            raise _wrong(table, line, field, "the cell is empty", "a number in every row")
        value = number(table, line, cell, field) * column.factor
        if not math.isfinite(value):
            raise _wrong(table, line, field, f"{printable(cell)!r} is not finite", "a finite number")
        point.setdefault(column.kind, {})[column.name] = value
        try:
            robot.with_actuation(**{column.kind: {column.name: value}})
        except RobotError as error:
            raise _wrong(table, line, field, error.problem, error.expected) from None
    return point


def _wrong(table: Table, line: int, field: str, found: str, expected: str) -> FileError:
    return FileError(found, path=table.name, line=line, field=field, expected=expected)
