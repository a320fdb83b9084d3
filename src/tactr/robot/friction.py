"""Friction of a tendon on its channel, as a robot describes it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check

FrictionPieces = tuple[tuple[float, float], ...]
Friction = float | FrictionPieces
FrictionLike = float | Sequence[Sequence[float]] | np.ndarray
EXPECTED = "a coefficient at least 0, or pieces (start in m, coefficient)"


def plain_friction(value: object) -> Friction:
    """A coefficient, or pieces (start, coefficient) of which the first starts at 0, checked."""
    if not isinstance(value, Sequence | np.ndarray) or isinstance(value, str):
        return check.real("friction", value, least=0)
    entries = check.row("friction", value, EXPECTED)
    if not entries:
        raise RobotError("friction", "it is empty", EXPECTED, value=value)
    pieces = tuple(_piece(k, entry) for k, entry in enumerate(entries))
    if pieces[0][0] != 0.0:
        raise RobotError(
            "friction[0]",
            f"the first piece starts at {check.show(pieces[0][0], 'm')}",
            "a first piece that starts at 0",
            value=pieces[0][0],
        )
    check.increasing("friction", [start for start, _ in pieces], "m")
    return pieces


def _piece(k: int, entry: object) -> tuple[float, float]:
    field = f"friction[{k}]"
    parts = check.row(field, entry, EXPECTED)
    if len(parts) != 2:
        raise RobotError(field, f"{check.show(entry)} is not a pair", EXPECTED, value=entry)
    start = check.real(f"{field}[0]", parts[0], "m", least=0)
    return start, check.real(f"{field}[1]", parts[1], least=0)


def plain_contacts(value: object) -> tuple[float, ...] | None:
    """Places of disks in m, ascending, checked; None for a channel all along."""
    if value is None:
        return None
    places = check.numbers("contacts", value, "m", fewest=1, least=0)
    check.increasing("contacts", places, "m")
    return places


def friction_pieces(friction: Friction) -> FrictionPieces:
    """Pieces (start, coefficient), of one coefficient too."""
    return friction if isinstance(friction, tuple) else ((0.0, friction),)


def rubs(friction: Friction) -> bool:
    """Whether there is any."""
    return any(coefficient > 0.0 for _, coefficient in friction_pieces(friction))


def check_along(tendon: object, end: float) -> None:
    """Raise RobotError where contacts or pieces of the friction of a Tendon lie at its end or beyond."""
    contacts, friction = getattr(tendon, "contacts"), getattr(tendon, "friction")  # noqa: B009
    places = [(f"contacts[{k}]", place) for k, place in enumerate(contacts or ())]
    if isinstance(friction, tuple):
        places += [(f"friction[{k}][0]", start) for k, (start, _) in enumerate(friction)]
    for field, place in places:
        if not place < end:
            raise RobotError(
                field,
                f"{check.show(place, 'm')} is not before the tendon's end at {check.show(end, 'm')}",
                f"a place below {check.show(end, 'm')}",
                value=place,
            )
