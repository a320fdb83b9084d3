"""What a robot file says before anything is made of it: plain data, and the line of each part."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

DataPath = tuple[str | int, ...]
"""Where a value stands in the data: ("tubes", 1, "length")."""

# A YAML parser in pure Python takes about 50 microseconds an entry: the worst file takes a fifth of a second.
LARGEST_FILE = 64 * 1024
LARGEST_COUNT = 5_000
DEEPEST = 12


@dataclass(frozen=True)
class Problem:
    """One thing wrong with a robot file: path and line (from 1; None: unknown) of the field, texts."""

    path: DataPath
    line: int | None
    found: str
    expected: str = ""


class ProblemsFound(Exception):
    """Problems on their way to becoming one `tactr.FileError`."""

    def __init__(self, *problems: Problem) -> None:
        super().__init__(problems)
        self.problems = problems


@dataclass(frozen=True)
class Document:
    """Plain data (mappings, lists, texts, numbers, booleans, None) with the line of each part."""

    data: object
    lines: dict[DataPath, int] = field(default_factory=dict)

    def line(self, path: DataPath) -> int | None:
        """The line of the field, or of the closest enclosing field that has one."""
        for length in range(len(path), -1, -1):
            if path[:length] in self.lines:
                return self.lines[path[:length]]
        return None


def field_name(path: DataPath) -> str:
    """("tubes", 1, "length") as people write it: "tubes[1].length"."""
    name = ""
    for key in path:
        name += f"[{key}]" if isinstance(key, int) else f".{printable(key)}" if name else printable(key)
    return name


def printable(text: str) -> str:
    """A text from a file made safe and short enough to show: no control characters, at most 60 characters."""
    text = "".join(c if c.isprintable() else repr(c)[1:-1] for c in text[:60])
    return text if len(text) <= 60 else text[:57] + "..."


def read_text(path: Path) -> str:
    """The text of a robot file; one too large is refused before it is read. Raises ProblemsFound."""
    try:
        if path.is_dir():
            raise _unreadable("is a directory, not a robot file")
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except FileNotFoundError:
        raise _unreadable("no such file") from None
    except OSError as error:
        raise _unreadable(f"cannot be read: {error.strerror or error}") from None
    if len(content) > LARGEST_FILE:
        raise _too_large()
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise _unreadable("is not a text in UTF-8", line) from None


def refuse_large(text: str) -> None:
    """Refuse, from a look at its punctuation, a text that would take long to parse. Raises ProblemsFound."""
    if len(text) > LARGEST_FILE:
        raise _too_large()
    if sum(map(text.count, ",\n:")) > 1.2 * LARGEST_COUNT:
        raise _unreadable(f"has more than {LARGEST_COUNT} entries; robot files have a few hundred")
    depth = 0
    for position, character in _brackets(text):
        depth += 1 if character in "[{" else -1
        if depth > DEEPEST:
            raise too_deep(text.count("\n", 0, position) + 1)


def too_deep(line: int) -> ProblemsFound:
    return _unreadable(f"is nested more than {DEEPEST} levels deep; robot files need at most 7", line)


def too_many(line: int) -> ProblemsFound:
    return _unreadable(f"has more than {LARGEST_COUNT} entries; robot files have a few hundred", line)


def _too_large() -> ProblemsFound:
    return _unreadable(f"is larger than {LARGEST_FILE // 1024} KiB; robot files are a few KiB")


def _brackets(text: str):
    import re

    return ((match.start(), match[0]) for match in re.finditer(r"[\[\]{}]", text))


def _unreadable(message: str, line: int | None = None) -> ProblemsFound:
    return ProblemsFound(Problem((), line, message))
