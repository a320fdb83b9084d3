"""From a study file to a Study."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from tactr.errors import FileError, RobotError
from tactr.io import load
from tactr.io.document import DataPath, Document, Problem, ProblemsFound, read_text
from tactr.io.fields import Quantity
from tactr.io.file_error import file_error
from tactr.io.path_kinds import kind_of
from tactr.io.units import show
from tactr.robot import Robot
from tactr.studies.axes import Axis, Range, Samples, Values, check_path
from tactr.studies.insertion import InsertionOrder
from tactr.studies.layout import STUDY
from tactr.studies.study import Study

ENDINGS = (".yaml", ".yml", ".toml")
WRITTEN = {"low": "from", "high": "to"}  # fields of the classes by their keys in the file


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read a study from a YAML or TOML file.

    Quantities carry units. Raises FileError (its text lists every problem with file, line and field), also
    for the robot file that it names.
    """
    try:
        text = read_text(Path(path))
        return _Reading(_document(text, Path(path)), Path(path), text).study()
    except ProblemsFound as found:
        raise file_error(found.problems, os.fspath(path)) from None


def _document(text: str, path: Path) -> Document:
    if path.suffix.lower() not in ENDINGS:
        raise ProblemsFound(
            Problem((), None, f"has the ending {path.suffix!r}", f"one of {', '.join(ENDINGS)}")
        )
    if path.suffix.lower() == ".toml":
        from tactr.io.read_toml import read_toml

        return read_toml(text)
    from tactr.io.read_yaml import read_yaml

    return read_yaml(text)


class _Reading:
    def __init__(self, document: Document, path: Path, text: str) -> None:
        self._document, self._path, self._text = document, path, text
        self._problems: list[Problem] = []
        if document.data is None:
            raise ProblemsFound(Problem((), None, "is empty", "at least robot and vary"))
        self._data: dict[str, Any] = STUDY.read(document.data, (), self._report)

    def study(self) -> Study:
        self._stop()
        robot = self._robot(self._data["robot"])
        axes = [self._axis(robot, k, entry) for k, entry in enumerate(self._data["vary"])]
        self._stop()
        data = {
            key: self._data[key]
            for key in ("name", "outputs", "stations", "tolerance", "chunk")
            if key in self._data
        }
        for key, kind in (("samples", Samples), ("insertion", InsertionOrder)):
            if key in self._data:
                data[key] = self._tried(lambda key=key, kind=kind: kind(**self._data[key]), key)
        self._stop()
        vary = [axis for axis in axes if axis is not None]
        study = self._tried(lambda: Study(robot, vary, source=self._text, **data))
        self._stop()
        return study

    def _robot(self, name: str) -> Robot:
        from tactr import examples

        path = self._path.parent / name
        if not path.suffix and not path.exists():
            try:
                return examples.load(name)
            except FileError as error:
                self._report(("robot",), f"{error.problem}, and no such file", error.expected)
                self._stop()
        if not path.exists():
            self._report(("robot",), f"there is no file {name!r}", "a robot file, or the name of an example")
            self._stop()
        return load(path)

    def _axis(self, robot: Robot, k: int, entry: dict[str, Any]) -> Axis | None:
        kind, place = Quantity(kind_of(robot, entry["path"])), ("vary", k)
        before = len(self._problems)
        self._tried(lambda: check_path(robot, entry["path"]), *place)
        if self._problems[before:]:
            return None
        if "values" in entry:
            values = [
                kind.read(value, (*place, "values", j), self._report)
                for j, value in enumerate(entry["values"])
            ]
            return (
                None
                if self._problems[before:]
                else self._tried(lambda: Values(entry["path"], values), "vary", k)
            )
        low, high = (kind.read(entry[key], (*place, key), self._report) for key in ("from", "to"))
        if self._problems[before:]:
            return None
        if not low < high:
            self._report(
                (*place, "to"), f"{show(entry['to'])} is not above {show(entry['from'])}", "from below to"
            )
            return None
        sampled = self._tried(lambda: Range(entry["path"], low, high), "vary", k)
        if "points" not in entry or sampled is None:
            return sampled
        return Values(entry["path"], np.linspace(low, high, entry["points"]).tolist())

    def _tried(self, make: Any, *place: str | int) -> Any:
        try:
            return make()
        except RobotError as error:
            self._report(
                (*place, *_path(error.field)) if place[:1] != _path(error.field)[:1] else place,
                error.problem,
                error.expected,
            )

    def _report(self, path: DataPath, found: str, expected: str) -> None:
        self._problems.append(Problem(path, self._document.line(path), found, expected))

    def _stop(self) -> None:
        if self._problems:
            raise ProblemsFound(*self._problems)


def _path(field: str) -> DataPath:
    """ "vary[0].low" as it stands in the file: ("vary", 0, "from")."""
    path: list[str | int] = []
    for name, index in re.findall(r"([A-Za-z_]+)|\[(\d+)\]", field):
        path.append(int(index) if index else str(WRITTEN.get(name, name)))
    return tuple(path)
