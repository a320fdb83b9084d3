"""Tables of numbers in CSV files: a head that names columns with their units, then rows."""

from __future__ import annotations

import csv
import re
from io import StringIO
from pathlib import Path
from typing import NamedTuple

from tactr.errors import FileError
from tactr.io.document import printable
from tactr.io.units import UnitError, kind, parse_quantity

SEPARATORS = (",", ";", "\t")
COMMENT = "#"
_HEADING = re.compile(r"(?P<name>.*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?")


class Table(NamedTuple):
    """name of the file; line of the head and its cells; the rows, each with its line. Cells are stripped."""

    name: str
    line: int
    head: list[str]
    rows: list[tuple[int, list[str]]]


def table_in(path: Path, expected: str) -> Table:
    """The table of a file, which has at least one row; expected: as in ``read_table``. Raises FileError."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise FileError("no such file", path=path) from None
    except OSError as error:
        raise FileError(f"cannot be read: {error.strerror or error}", path=path) from None
    table = read_table(decoded(content, str(path)), str(path), expected)
    if not table.rows:
        raise FileError("holds no rows", path=path, expected=expected)
    return table


def decoded(content: bytes, name: str) -> str:
    """The text of a CSV file, with or without a byte order mark. Raises FileError."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        expected = "CSV saved as UTF-8"
        raise FileError("is not a text in UTF-8", path=name, line=line, expected=expected) from None


def read_table(text: str, name: str, expected: str) -> Table:
    """Separated by commas, semicolons or tabs, as the head is; lines that start with # are skipped.

    expected: what the head should be, for errors. Raises FileError.
    """
    text = text.removeprefix("\ufeff")
    said = (line for line in text.splitlines() if line.strip() and not line.lstrip().startswith(COMMENT))
    separator = max(SEPARATORS, key=next(said, "").count)
    reader = csv.reader(StringIO(text, newline=""), delimiter=separator)
    try:
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader]
    except csv.Error as error:
        raise FileError(f"cannot be read: {error}", path=name) from None
    rows = [(line, row) for line, row in rows if any(row) and not row[0].startswith(COMMENT)]
    if not rows:
        raise FileError("is empty", path=name, expected=expected)
    line, head = rows[0][0], _without_trailing(rows[0][1])
    if all(_is_number(cell) for cell in head):
        found = "the line before the rows holds numbers, no names"
        raise FileError(found, path=name, line=line, expected=f"{expected}, not behind a {COMMENT}")
    for at, row in rows[1:]:
        if any(row[len(head) :]):
            found = f"{len(row)} cells, but the head names {len(head)} columns"
            raise FileError(found, path=name, line=at, expected="as many, with decimal points")
    return Table(name, line, head, rows[1:])


def heading(cell: str) -> tuple[str, str | None]:
    """ "x [mm]" or "x (mm)" as name and unit, which is None where there is none."""
    match = _HEADING.fullmatch(cell.strip())
    assert match is not None
    return match["name"], None if match["unit"] is None else match["unit"].strip()


def unit_factor(table: Table, field: str, unit: str | None, what: str) -> float:
    """SI units in the unit of a column; what: kind of quantity. Raises FileError."""
    if not unit:
        expected = f'"{field} [{kind(what).units[0]}]"'
        raise FileError(
            "the column has no unit", path=table.name, line=table.line, field=field, expected=expected
        )
    try:
        return parse_quantity(f"1 {unit}", kind(what))
    except UnitError as error:
        raise FileError(
            f"unit [{printable(unit)}]: {error.found}",
            path=table.name,
            line=table.line,
            field=field,
            expected=error.expected,
        ) from None


def number(table: Table, line: int, cell: str, field: str) -> float:
    """Of a cell, NaN and infinity too. Raises FileError."""
    try:
        return float(cell)
    except ValueError:
        expected = "a number" + (", with a decimal point" if _is_number(cell.replace(",", ".")) else "")
        raise FileError(
            f"{printable(cell)!r} is not a number", path=table.name, line=line, field=field, expected=expected
        ) from None


def _without_trailing(cells: list[str]) -> list[str]:
    """Without the empty cells at the end that spreadsheets write."""
    return cells[: max(k for k, cell in enumerate(cells, start=1) if cell)]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
