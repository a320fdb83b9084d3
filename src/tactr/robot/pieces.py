"""Piecewise constant fields of a tube: pairs (start, value)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.rest import RestShape

REACH = 1e-9
"""How far (m) a rest shape may end before the tube: lengths differ by rounding."""

T = TypeVar("T")
Vector3 = tuple[float, float, float]
Pieces = tuple[tuple[float, T], ...]
PiecesLike = Sequence[tuple[float, T]]
PrecurvatureLike = (
    Sequence[float] | np.ndarray | PiecesLike[Sequence[float]] | PiecesLike[np.ndarray] | RestShape
)


def plain_precurvature(value: object, length: float) -> Pieces[Vector3] | RestShape:
    """A rest shape, checked: pieces of u*, or a RestShape that reaches the tube's end."""
    if not isinstance(value, RestShape):
        return _pieces(value, length)
    if value.end < length - REACH:
        raise RobotError(
            "precurvature",
            f"it is defined to {check.show(value.end, 'm')} only",
            f"a rest shape to the tube's length {check.show(length, 'm')}",
            value=value.end,
        )
    return value


def check_starts(field: str, starts: Sequence[float], length: float) -> None:
    """Refuse starts that do not begin at 0, ascend, and lie before the tube's end."""
    if starts[0] != 0:
        raise RobotError(
            f"{field}[0]",
            f"the first piece starts at {check.show(starts[0], 'm')}",
            "a first piece that starts at 0, such as (0, (0, 0, 0)) for a straight part"
            if field == "precurvature"
            else "a first piece that starts at 0",
            value=starts[0],
        )
    check.increasing(field, starts, "m")
    if not starts[-1] < length:
        raise RobotError(
            f"{field}[{len(starts) - 1}]",
            f"it starts at {check.show(starts[-1], 'm')}, not before the tube's end",
            f"a start below the length {check.show(length, 'm')}",
            value=starts[-1],
        )


def _pieces(value: object, length: float) -> Pieces[Vector3]:
    expected = "(ux, uy, uz) in 1/m, or pieces (start in m, (ux, uy, uz))"
    entries = check.row("precurvature", value, expected)
    if not entries:
        raise RobotError("precurvature", "it is empty", expected, value=value)
    if not _is_row(entries[0]):
        return ((0.0, check.vector("precurvature", entries, "1/m")),)
    pieces = tuple(_piece(k, entry, expected) for k, entry in enumerate(entries))
    check_starts("precurvature", [start for start, _ in pieces], length)
    return pieces


def _is_row(entry: object) -> bool:
    if isinstance(entry, np.ndarray):
        return entry.ndim > 0
    return isinstance(entry, Sequence) and not isinstance(entry, str)


def _piece(k: int, entry: object, expected: str) -> tuple[float, Vector3]:
    field = f"precurvature[{k}]"
    parts = check.row(field, entry, expected)
    if len(parts) != 2:
        raise RobotError(field, f"{check.show(entry)} is not a pair", expected, value=entry)
    return check.real(f"{field}[0]", parts[0], "m", least=0), check.vector(f"{field}[1]", parts[1], "1/m")
