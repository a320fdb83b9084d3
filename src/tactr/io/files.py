"""Robot files: `load` and `save`, in YAML 1.2 or TOML by the ending of the name."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from tactr.io.document import Document, Problem, ProblemsFound, read_text
from tactr.io.file_error import file_error

if TYPE_CHECKING:
    from tactr.robot import Robot

Format = Literal["yaml", "toml"]
_FORMATS: dict[str, Format] = {".yaml": "yaml", ".yml": "yaml", ".toml": "toml"}


def load(path: str | os.PathLike[str]) -> Robot:
    """Read a robot from a YAML or TOML file.

    Quantities carry units and are converted to SI. Raises FileError (its text lists every problem with file,
    line and field).
    """
    try:
        return _parse(read_text(Path(path)), _format(path))
    except ProblemsFound as found:
        raise file_error(found.problems, os.fspath(path)) from None


def loads(text: str, *, format: Format = "yaml") -> Robot:
    """Read a robot from a text, as `load` does from a file. Raises FileError."""
    try:
        return _parse(text, format)
    except ProblemsFound as found:
        raise file_error(found.problems, None) from None


def save(robot: Robot, path: str | os.PathLike[str]) -> None:
    """Write a robot to a YAML or TOML file, which `load` reads back as an equal robot (comments are not
    kept).

    Raises RobotError for what a file cannot hold (a routing that is a Python function), FileError where it
    cannot be written.
    """
    try:
        text = dumps(robot, format=_format(path))
        Path(path).write_text(text, encoding="utf-8", newline="\n")
    except ProblemsFound as found:
        raise file_error(found.problems, os.fspath(path)) from None
    except OSError as error:
        raise file_error(
            [Problem((), None, f"cannot be written: {error.strerror or error}")], os.fspath(path)
        ) from None


def dumps(robot: Robot, *, format: Format = "yaml") -> str:
    """The text of a robot file. Raises RobotError for what a file cannot hold."""
    from tactr.io.unbuild import unbuild

    data = unbuild(robot)
    if format == "toml":
        import tomli_w

        return tomli_w.dumps(data)
    from tactr.io.write_yaml import write_yaml

    return write_yaml(data)


def _format(path: str | os.PathLike[str]) -> Format:
    suffix = Path(path).suffix.lower()
    if suffix not in _FORMATS:
        raise ProblemsFound(Problem((), None, f"has the ending {suffix!r}", f"one of {', '.join(_FORMATS)}"))
    return _FORMATS[suffix]


def _parse(text: str, format: Format) -> Robot:
    from tactr.io.build import build

    return build(_read(text, format))


def _read(text: str, format: Format) -> Document:
    if format == "toml":
        from tactr.io.read_toml import read_toml

        return read_toml(text)
    from tactr.io.read_yaml import read_yaml

    return read_yaml(text)
