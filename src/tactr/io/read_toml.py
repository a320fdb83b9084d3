"""TOML to plain data; the standard parser keeps no positions, so lines are found again in the text."""

from __future__ import annotations

import re
import tomllib

from tactr.io.document import (
    DEEPEST,
    LARGEST_COUNT,
    DataPath,
    Document,
    Problem,
    ProblemsFound,
    refuse_large,
    too_deep,
    too_many,
)

_PART = re.compile(r"\"([^\"]*)\"|'([^']*)'|([A-Za-z0-9_\-]+)")


def read_toml(text: str) -> Document:
    """Parse a TOML document. Raises ProblemsFound: not TOML, duplicated keys, hostile size or nesting."""
    refuse_large(text)
    _refuse_long_keys(text)
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        match = re.search(r"line (\d+)", str(error))
        raise ProblemsFound(Problem((), int(match[1]) if match else None, f"is not TOML: {error}")) from None
    except RecursionError:
        raise too_deep(1) from None
    _check_size(data)
    return Document(data, _lines(text))


def _refuse_long_keys(text: str) -> None:
    """Refuse dotted keys of many parts, on which the standard parser spends quadratic time."""
    for number, line in enumerate(text.splitlines(), start=1):
        if line.count(".") > DEEPEST:
            for words in re.split(r"[=\[\]{},#]", line):
                parts = words.split(".")
                if len(parts) > DEEPEST and all(len(part.split()) == 1 for part in parts):
                    raise too_deep(number)


def _check_size(data: object) -> None:
    count, waiting = 0, [(data, 0)]
    while waiting:
        value, depth = waiting.pop()
        count += 1
        if depth > DEEPEST:
            raise too_deep(1)
        if count > LARGEST_COUNT:
            raise too_many(1)
        if isinstance(value, dict):
            waiting += [(entry, depth + 1) for entry in value.values()]
        elif isinstance(value, list):
            waiting += [(entry, depth + 1) for entry in value]


def _lines(text: str) -> dict[DataPath, int]:
    """The line of every table header and of every key that starts a line; inline tables share the line they
    are on."""
    lines: dict[DataPath, int] = {(): 1}
    counts: dict[DataPath, int] = {}
    table: DataPath = ()
    for number, line in enumerate(text.splitlines(), start=1):
        line = line.strip()
        if line.startswith("["):
            table = _table(_parts(line.lstrip("[").partition("]")[0]), line.startswith("[["), counts)
            lines.setdefault(table, number)
        elif "=" in line:
            lines.setdefault((*table, *_parts(line.partition("=")[0])), number)
    return lines


def _table(parts: list[str], array: bool, counts: dict[DataPath, int]) -> DataPath:
    """The path of a table header; counts: how many tables of each array have been seen."""
    path: DataPath = ()
    for part in parts[:-1]:
        path = (*path, part)
        if path in counts:
            path = (*path, counts[path] - 1)
    path = (*path, *parts[-1:])
    if not array:
        return path
    counts[path] = counts.get(path, 0) + 1
    return (*path, counts[path] - 1)


def _parts(key: str) -> list[str]:
    return [double or single or bare for double, single, bare in _PART.findall(key)]
