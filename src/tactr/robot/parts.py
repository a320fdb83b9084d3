"""The parts of a tube: one section of one material each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.along import EDGE, Along
from tactr.robot.material import Material
from tactr.robot.pieces import Pieces, check_starts
from tactr.robot.section import UNITS, Section, Stiffness
from tactr.robot.varying import VaryingStiffness

SECTION = "an Annulus, a Rod or a Stiffness"
MATERIAL = "a Material, such as tactr.materials.nitinol"


class Part(NamedTuple):
    """A tube from sigma = ``start`` to ``end`` (m); field: where the section stands in the tube."""

    start: float
    end: float
    section: Section
    stiffness: Stiffness | VaryingStiffness
    field: str


def plain_section(value: object, length: float) -> Section | Pieces[Section]:
    """A section, or pieces of several, checked."""
    return _one_or_pieces("section", value, Section, "section", SECTION, length)


def plain_material(value: object, length: float) -> Material | Pieces[Material] | None:
    """A material, or pieces of several, checked; None stays."""
    return (
        None if value is None else _one_or_pieces("material", value, Material, "material", MATERIAL, length)
    )


def _one_or_pieces(field: str, value: object, kind: type, what: str, expected: str, length: float) -> Any:
    if isinstance(value, (list, tuple)):
        pieces = [_piece(f"{field}[{k}]", entry, kind, what, expected) for k, entry in enumerate(value)]
        if not pieces:
            raise RobotError(field, "it is empty", f"{expected}, or pairs (start in m, {what})", value=value)
        check_starts(field, [start for start, _ in pieces], length)
        return tuple(pieces) if len(pieces) > 1 else pieces[0][1]
    return _of_kind(field, value, kind, what, expected)


def _piece(field: str, entry: object, kind: type, what: str, expected: str) -> tuple[float, Any]:
    pair = check.row(field, entry, f"a pair (start in m, {what})")
    if len(pair) != 2:
        raise RobotError(
            field, f"{check.show(entry)} is not a pair", f"a pair (start in m, {what})", value=entry
        )
    start = check.real(f"{field}[0]", pair[0], "m", least=0)
    return start, _of_kind(f"{field}[1]", pair[1], kind, what, expected)


def _of_kind(field: str, value: object, kind: type, what: str, expected: str) -> Any:
    if isinstance(value, type) or not isinstance(value, kind):
        raise RobotError(field, f"{check.show(value)} is not a {what}", expected, value=value)
    return value


def parts_of(
    section: Section | Pieces[Section], material: Material | Pieces[Material] | None, length: float
) -> tuple[Part, ...]:
    """The parts between the starts of sections and materials. Raises RobotError."""
    sections = section if isinstance(section, tuple) else ((0.0, section),)
    materials = material if isinstance(material, tuple) else ((0.0, material),)
    starts = sorted({start for start, _ in sections} | {start for start, _ in materials})
    parts = []
    for start, end in zip(starts, [*starts[1:], length], strict=True):
        k = _at(sections, start)
        field = f"section[{k}][1]" if isinstance(section, tuple) else "section"
        found = sections[k][1]
        try:
            stiffness = found.stiffness(materials[_at(materials, start)][1])
        except RobotError as error:
            raise (
                RobotError(field, error.problem, error.expected) if error.field == "section" else error
            ) from None
        parts.append(Part(start, end, found, stiffness, field))
    return tuple(parts)


def _at(pieces: Sequence[tuple[float, Any]], start: float) -> int:
    return max(k for k, (first, _) in enumerate(pieces) if first <= start)


def check_parts(parts: Sequence[Part], length: float) -> None:
    """Refuse what gives no stiffness, or one that does not reach the part's end or is not above 0 there."""
    for part in parts:
        if not isinstance(part.stiffness, (Stiffness, VaryingStiffness)):
            raise RobotError(
                part.field,
                f"its stiffness() gives {check.show(part.stiffness)}",
                "a section whose stiffness(material) gives a Stiffness",
                value=part.section,
            )
        for name, unit in UNITS.items():
            _check_quantity(part, name, getattr(part.stiffness, name), unit)
        for k, quantity in enumerate(part.stiffness.neutral_axis):
            _check_quantity(part, f"neutral_axis[{k}]", quantity, "")


def _check_quantity(part: Part, name: str, quantity: float | Along, unit: str) -> None:
    if not isinstance(quantity, Along):
        return
    field = f"{part.field}.{name}"
    if quantity.end < part.end - EDGE:
        raise RobotError(
            field,
            f"it is defined to {check.show(quantity.end, 'm')}, and used to {check.show(part.end, 'm')}",
            "values to where the section ends (sigma counts from the tube's proximal end)",
            value=quantity.end,
        )
    least = quantity.least(part.start, part.end)
    if unit and not least > 0:
        raise RobotError(
            field,
            f"it falls to {check.show(least, unit)}",
            f"values in {unit} above 0 all along",
            value=least,
        )
