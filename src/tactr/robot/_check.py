"""Checks shared by the description classes: each returns a plain value or raises RobotError."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from types import TracebackType
from typing import Any, TypeVar

import numpy as np

from tactr.errors import RobotError

T = TypeVar("T")


class owned:
    """Context that writes ``owner`` ("Tube 'outer'") into a RobotError that passes through it."""

    def __init__(self, owner: str) -> None:
        self.owner = owner

    def __enter__(self) -> None:
        return None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, RobotError) and not error.owner:
            error.owner = self.owner


def store(target: object, **values: object) -> None:
    """Set fields of a frozen dataclass while it is being built."""
    for name, value in values.items():
        object.__setattr__(target, name, value)


def show(value: object, unit: str = "") -> str:
    """A value for an error text: numbers with their unit, anything else shortened."""
    if isinstance(value, Real) and not isinstance(value, (bool, np.bool_)):
        try:
            return f"{float(value):.9g} {unit}".rstrip()
        except OverflowError:
            return f"{'-' if value < 0 else ''}inf {unit}".rstrip()
    try:
        text = repr(value)
    except Exception:  # a broken repr must not hide the real error
        text = f"<{type(value).__name__}>"
    return text if len(text) <= 60 else text[:57] + "..."


Bounds = tuple[float | None, float | None, float | None, float | None]  # above, least, below, most


def real(
    field: str,
    value: object,
    unit: str = "",
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
    hint: str = "",
) -> float:
    """``value`` as a finite float within the bounds given; ``hint`` is appended to what would be right."""
    number = value if type(value) is float else _plain(field, value, unit, (above, least, below, most), hint)
    small = (above is not None and number <= above) or (least is not None and number < least)
    large = (below is not None and number >= below) or (most is not None and number > most)
    if small or large or not math.isfinite(number):
        found = f"{show(number, unit)} is too {'small' if small else 'large'}"
        if not math.isfinite(number):
            found = f"{show(number)} is not a finite number"
        raise RobotError(field, found, _expected(unit, (above, least, below, most), hint), value=value)
    return number


def _plain(field: str, value: object, unit: str, bounds: Bounds, hint: str) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        expected = _expected(unit, bounds, hint)
        found = f"{show(value)} is not a number"
        if isinstance(value, str):
            found = f"{show(value)} is text, not a number"
            expected += "; texts with units are for robot files" if unit else ""
        raise RobotError(field, found, expected, value=value)
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _expected(unit: str, bounds: Bounds, hint: str) -> str:
    parts = [f"a finite number in {unit}" if unit else "a finite number"]
    limits = [
        f"{word} {show(bound, unit if bound else '')}"
        for word, bound in zip(("above", "at least", "below", "at most"), bounds, strict=True)
        if bound is not None
    ]
    if limits:
        parts.append(" and ".join(limits))
    return " ".join(parts) + (f" ({hint})" if hint else "")


def row(field: str, value: object, expected: str) -> list[Any]:
    """An ordered collection (list, tuple, array) as a list; texts, mappings and sets are refused."""
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return list(value)
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes, bytearray)):
        return list(value)
    raise RobotError(field, f"{show(value)} is not a list, tuple or array", expected, value=value)


def numbers(
    field: str,
    value: object,
    unit: str = "",
    *,
    fewest: int = 0,
    most: int | None = None,
    least: float | None = None,
) -> tuple[float, ...]:
    """An ordered collection of finite numbers as a tuple of floats, each at least ``least``."""
    if fewest == most:
        size = f"{fewest} numbers"
    else:
        size = f"at least {fewest} numbers" if most is None else f"{fewest} to {most} numbers"
    expected = f"{size} in {unit}" if unit else size
    entries = row(field, value, expected)
    if len(entries) < fewest or (most is not None and len(entries) > most):
        raise RobotError(field, f"{len(entries)} entries found", expected, value=value)
    return tuple(real(f"{field}[{k}]", entry, unit, least=least) for k, entry in enumerate(entries))


def vector(field: str, value: object, unit: str = "") -> tuple[float, float, float]:
    """Three finite numbers as a tuple of floats."""
    x, y, z = numbers(field, value, unit, fewest=3, most=3)
    return x, y, z


def increasing(field: str, values: Sequence[float], unit: str = "") -> None:
    """Refuse ``values`` unless each is above the one before."""
    for k in range(1, len(values)):
        if not values[k] > values[k - 1]:
            raise RobotError(
                f"{field}[{k}]",
                f"{show(values[k], unit)} does not come after {show(values[k - 1], unit)}",
                "values that increase strictly",
                value=values[k],
            )


def name(field: str, value: object, *, empty: bool = False) -> str:
    """A text fit to be a name: printable, without blanks at its ends."""
    expected = "a text" if empty else "a text that is not empty"
    if not isinstance(value, str):
        raise RobotError(field, f"{show(value)} is not a text", expected, value=value)
    if not value and not empty:
        raise RobotError(field, "the name is empty", expected, value=value)
    if value != value.strip() or not value.isprintable():
        raise RobotError(
            field,
            f"{show(value)} has blanks at an end or unprintable characters",
            "a printable text without blanks at its ends",
            value=value,
        )
    return str(value)


def near(value: object, names: Iterable[str]) -> str:
    """``'one of a, b, c'``, with a suggestion when ``value`` nearly matches one of them."""
    options = list(names)
    if not options:
        return "none, because there are none"
    listed = (
        "one of " + ", ".join(repr(option) for option in options) if len(options) > 1 else repr(options[0])
    )
    if isinstance(value, str):
        from difflib import get_close_matches

        lowered = {option.lower(): option for option in reversed(options)}
        match = get_close_matches(value.strip().lower(), lowered, n=1, cutoff=0.6)
        if match:
            listed += f" (did you mean {lowered[match[0]]!r}?)"
    return listed


def choice(field: str, value: object, options: Sequence[str]) -> str:
    """``value`` if it is one of ``options``."""
    if not isinstance(value, str) or value not in options:
        raise RobotError(field, f"{show(value)} is not known", near(value, options), value=value)
    return str(value)


def instances(field: str, value: object, kind: type[T] | tuple[type[T], ...], label: str) -> tuple[T, ...]:
    """An ordered collection whose entries are all of ``kind``, as a tuple; ``label`` names the kind."""
    expected = f"a list or tuple of {label}"
    if isinstance(value, kind):
        raise RobotError(field, f"a single {type(value).__name__} was given", expected, value=value)
    if isinstance(value, Mapping):
        raise RobotError(field, "a mapping was given", expected, value=value)
    entries = row(field, value, expected)
    for k, entry in enumerate(entries):
        if not isinstance(entry, kind):
            raise RobotError(f"{field}[{k}]", f"{show(entry)} is not one of the {label}", label, value=entry)
    return tuple(entries)


def starts(field: str, values: Sequence[float]) -> None:
    """Refuse starts (m) unless the first is 0 and each is above the one before."""
    if values[0] != 0:
        raise RobotError(
            f"{field}[0]",
            f"it starts at {show(values[0], 'm')}",
            "a first start of 0 (arc length counts from the tube's proximal end)",
            value=values[0],
        )
    increasing(field, values, "m")
