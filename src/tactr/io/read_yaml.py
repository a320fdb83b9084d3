"""YAML 1.2 to plain data with line numbers; nothing in a file is executed, referenced or merged."""

from __future__ import annotations

import re
from typing import Any

from tactr.io.document import (
    DEEPEST,
    LARGEST_COUNT,
    DataPath,
    Document,
    Problem,
    ProblemsFound,
    printable,
    refuse_large,
    too_deep,
    too_many,
)

_INTEGER = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_CONSTANTS = {"": None, "~": None, "null": None, "Null": None, "NULL": None}
_CONSTANTS |= {text: text.lower() == "true" for text in ("true", "True", "TRUE", "false", "False", "FALSE")}


def read_yaml(text: str) -> Document:
    """Parse one YAML document. Raises ProblemsFound: not YAML, duplicated keys, anchors, tags, or hostile
    size or nesting."""
    refuse_large(text)
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    builder = _Builder()
    try:
        for event in YAML(typ="safe", pure=True).parse(text):
            builder.take(event)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else None
        problem = str(error.problem or error.context)
        raise ProblemsFound(Problem((), line, f"is not YAML: {problem}{_hint(problem)}")) from None
    except YAMLError as error:
        raise ProblemsFound(Problem((), None, f"is not YAML: {str(error).splitlines()[0]}")) from None
    if builder.problems:
        raise ProblemsFound(*builder.problems)
    return Document(builder.root, builder.lines)


class _Builder:
    """Builds the data from parser events, without recursion, so that depth and size are checked before they
    cost anything."""

    def __init__(self) -> None:
        self.root: Any = None
        self.lines: dict[DataPath, int] = {}
        self.problems: list[Problem] = []
        self._open: list[_Level] = []
        self._count = 0
        self._documents = 0

    def take(self, event: Any) -> None:
        name = type(event).__name__
        line = event.start_mark.line + 1
        if name == "DocumentStartEvent":
            self._documents += 1
            if self._documents > 1:
                raise ProblemsFound(
                    Problem((), line, 'holds a second document (after "---"); a robot file holds one')
                )
        elif name in ("ScalarEvent", "MappingStartEvent", "SequenceStartEvent", "AliasEvent"):
            self._check(event, name, line)
            self._node(event, name, line)
        elif name in ("MappingEndEvent", "SequenceEndEvent"):
            self._open.pop()

    def _check(self, event: Any, name: str, line: int) -> None:
        if name == "AliasEvent" or event.anchor is not None:
            word = ("*" if name == "AliasEvent" else "&") + printable(str(event.anchor or ""))
            right = "the value written out: robot files have no anchors and aliases"
            raise ProblemsFound(Problem((), line, f"uses {word}", right))
        if event.tag is not None:
            right = "plain data: robot files have no tags"
            raise ProblemsFound(Problem((), line, f"uses the tag {printable(str(event.tag))}", right))
        self._count += 1
        if self._count > LARGEST_COUNT:
            raise too_many(line)

    def _node(self, event: Any, name: str, line: int) -> None:
        if name == "ScalarEvent":
            self._place(_scalar(event), line)
            return
        if len(self._open) >= DEEPEST:
            raise too_deep(line)
        value: Any = {} if name == "MappingStartEvent" else []
        path = self._place(value, line)
        self._open.append(_Level(value, path))

    def _place(self, value: Any, line: int) -> DataPath:
        if not self._open:
            self.root = value
            self.lines[()] = line
            return ()
        level = self._open[-1]
        if isinstance(level.value, list):
            path = (*level.path, len(level.value))
            level.value.append(value)
        elif level.key is None:
            level.key = self._key(value, level, line)
            return (*level.path, level.key)
        else:
            path = (*level.path, level.key)
            level.value[level.key] = value
            level.key = None
            return path
        self.lines[path] = line
        return path

    def _key(self, value: Any, level: _Level, line: int) -> str:
        if not isinstance(value, str):
            shown = "a list or mapping" if isinstance(value, (list, dict)) else repr(value)
            raise ProblemsFound(Problem(level.path, line, f"has {shown} as a key; keys are texts"))
        path = (*level.path, value)
        if value in level.value:
            first = self.lines[path]
            self.problems.append(Problem(path, line, f"is given twice; the first one is on line {first}"))
        else:
            self.lines[path] = line
        return value


def _hint(problem: str) -> str:
    if "mapping values are not allowed" in problem:
        return ' (a text that holds ": " has to stand in quotes, and keys of one mapping have to line up)'
    return " (indent with blanks)" if r"'\t'" in problem else ""


class _Level:
    """An open list or mapping; key: the mapping key whose value comes next."""

    def __init__(self, value: Any, path: DataPath) -> None:
        self.value = value
        self.path = path
        self.key: str | None = None


def _scalar(event: Any) -> object:
    text = event.value
    if event.style is not None:
        return text
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if len(text) <= 64 and _INTEGER.fullmatch(text):
        return int(text)
    if len(text) <= 64 and _FLOAT.fullmatch(text):
        return float(text)
    return text
