"""What people type: robot files or example names, and assignments such as outer=3."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tactr.errors import FileError, TactrError

if TYPE_CHECKING:
    from tactr.robot import Robot


class UsageError(TactrError):
    """A command line that cannot be meant."""


def read_robot(file: str) -> Robot:
    """The robot of a file, or of a built-in example. Raises FileError."""
    from tactr import examples
    from tactr.io import load

    if file in examples.names() and not Path(file).exists():
        return examples.load(file)
    if not Path(file).suffix and not Path(file).exists():
        raise FileError(
            f"{file!r} is neither a file nor a built-in example{_near(file, examples.names())}",
            expected=f"a file.yaml or one of {', '.join(examples.names())}",
        )
    return load(file)


def read_assignments(
    option: str, words: Sequence[str], kind: str, *, bare: str | None = None
) -> dict[str, float] | list[float] | None:
    """Values in SI units by name (name=value), or in order where no word has a name; None where there are no
    words.

    kind: of the quantity; bare: unit of a number without one. Raises UsageError.
    """
    if not words:
        return None
    named = [word for word in words if "=" in word]
    if not named:
        return [_read(option, word, kind, bare) for word in words]
    values: dict[str, float] = {}
    for word in words:
        name, sign, value = word.rpartition("=")
        name = name.strip()
        if not sign:
            hint = "; a FILE goes before the options" if not word[:1].isdigit() else ""
            raise UsageError(
                f"--{option}: {word!r} has no name; expected name=value, such as {named[0]}{hint}"
            )
        if name in values:
            raise UsageError(f"--{option}: {name!r} is given twice")
        values[name] = _read(option, value, kind, bare)
    return values


def read_vectors(
    option: str, words: Sequence[str], kind: str, *, bare: str
) -> dict[str, tuple[float, float, float]]:
    """Vectors in SI units by name, from words such as "inner=0.1 N, 0, -0.05 N". Raises UsageError.

    kind: of the quantity; bare: unit of a number without one.
    """
    vectors: dict[str, tuple[float, float, float]] = {}
    for word in words:
        name, sign, text = word.rpartition("=")
        name, parts = name.strip(), text.split(",")
        if not sign or not name or len(parts) != 3:
            raise UsageError(
                f'--{option}: {word!r} is not a vector of a tube; expected name="x, y, z", '
                f'such as inner="0.1 {bare}, 0, 0"'
            )
        if name in vectors:
            raise UsageError(f"--{option}: {name!r} is given twice")
        x, y, z = (_read(option, part, kind, bare) for part in parts)
        vectors[name] = (x, y, z)
    return vectors


def read_length(option: str, word: str) -> float:
    """A length in m. Raises UsageError."""
    return _read(option, word, "length", None)


def _read(option: str, text: str, kind: str, bare: str | None) -> float:
    from tactr.io.units import UnitError, parse_quantity
    from tactr.io.units import kind as kind_of

    try:
        return parse_quantity(text.strip(), kind_of(kind), bare=bare)
    except UnitError as error:
        raise UsageError(f"--{option}: {error}") from None


def _near(word: str, known: Sequence[str]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(word.lower(), known, n=1)
    return f" (did you mean {near[0]}?)" if near else ""
