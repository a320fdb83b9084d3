"""Tubes: a section along a length, with a rest shape and a place in the guide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.material import Material
from tactr.robot.section import Section, Stiffness

Vector3 = tuple[float, float, float]
Precurvature = tuple[tuple[float, Vector3], ...]
PrecurvatureLike = Sequence[float] | np.ndarray | Sequence[tuple[float, Sequence[float] | np.ndarray]]


@dataclass(frozen=True)
class Tube:
    """One tube (or rod) of the robot.

    name: by which tendons, loads and actuation refer to it. length: m, above 0. section: Annulus, Rod or
    Stiffness. material: needed unless the section is a Stiffness. precurvature: rest curvature and twist u* =
    (ux, uy, uz) in 1/m in the tube's own material frame (uz is the rest twist), either one triple, or pieces
    ``(start, (ux, uy, uz))`` constant from ``start`` on, where start is the tube's own arc length sigma in m
    from its proximal end and the first start is 0. It is stored as pieces. translation: m, the z of the
    proximal end, at most 0 (0: at the guide's exit, s = 0). rotation: rad about +z, imposed at the proximal
    end. Raises RobotError.
    """

    name: str
    _: KW_ONLY
    length: float
    section: Section
    material: Material | None = None
    precurvature: Precurvature = ((0.0, (0.0, 0.0, 0.0)),)
    translation: float = 0.0
    rotation: float = 0.0

    if TYPE_CHECKING:  # the constructor takes more forms of precurvature than the field stores

        def __init__(
            self,
            name: str,
            *,
            length: float,
            section: Section,
            material: Material | None = None,
            precurvature: PrecurvatureLike = (0.0, 0.0, 0.0),
            translation: float = 0.0,
            rotation: float = 0.0,
        ) -> None: ...

    def __post_init__(self) -> None:
        name = check.name("name", self.name)
        with check.owned(f"Tube {name!r}"):
            length = check.real("length", self.length, "m", above=0)
            check.store(self, name=name, length=length)
            check.store(
                self, translation=plain_translation(self.translation), rotation=plain_rotation(self.rotation)
            )
            check.store(self, precurvature=_pieces(self.precurvature, length))
            self._check_stiffness()

    def _check_stiffness(self) -> None:
        if isinstance(self.section, type) or not isinstance(self.section, Section):
            raise RobotError(
                "section",
                f"{check.show(self.section)} is not a section",
                "an Annulus, a Rod or a Stiffness",
                value=self.section,
            )
        if self.material is not None and not isinstance(self.material, Material):
            raise RobotError(
                "material",
                f"{check.show(self.material)} is not a material",
                "a Material, such as tactr.materials.nitinol",
                value=self.material,
            )
        if not isinstance(self.stiffness, Stiffness):
            raise RobotError(
                "section",
                f"its stiffness() gives {check.show(self.stiffness)}",
                "a section whose stiffness(material) gives a Stiffness",
                value=self.section,
            )

    @cached_property
    def stiffness(self) -> Stiffness:
        """Stiffness of the section, in N and N m^2."""
        return self.section.stiffness(self.material)

    @property
    def linear_density(self) -> float | None:
        """Mass per length in kg/m; None when it is not known."""
        return self.stiffness.linear_density

    @property
    def outer_diameter(self) -> float | None:
        """Outer diameter in m; None when it is not known."""
        return self.section.outer_diameter

    @property
    def inner_diameter(self) -> float | None:
        """Bore in m; 0 for a rod, None when it is not known."""
        return self.section.inner_diameter

    @property
    def tip(self) -> float:
        """Arc length s of the distal end, m from the guide's exit."""
        return self.translation + self.length


def plain_translation(value: object) -> float:
    """A translation in m, checked."""
    hint = "the proximal end is at the guide's exit or behind it"
    return check.real("translation", value, "m", most=0, hint=hint)


def plain_rotation(value: object) -> float:
    """A rotation in rad, checked."""
    return check.real("rotation", value, "rad")


def _pieces(value: object, length: float) -> Precurvature:
    expected = "(ux, uy, uz) in 1/m, or pieces (start in m, (ux, uy, uz))"
    entries = check.row("precurvature", value, expected)
    if not entries:
        raise RobotError("precurvature", "it is empty", expected, value=value)
    if not _is_row(entries[0]):
        return ((0.0, check.vector("precurvature", entries, "1/m")),)
    pieces = tuple(_piece(k, entry, expected) for k, entry in enumerate(entries))
    starts = [start for start, _ in pieces]
    if starts[0] != 0:
        raise RobotError(
            "precurvature[0]",
            f"the first piece starts at {check.show(starts[0], 'm')}",
            "a first piece that starts at 0, such as (0, (0, 0, 0)) for a straight part",
            value=starts[0],
        )
    check.increasing("precurvature", starts, "m")
    if not starts[-1] < length:
        raise RobotError(
            f"precurvature[{len(starts) - 1}]",
            f"it starts at {check.show(starts[-1], 'm')}, not before the tube's end",
            f"a start below the length {check.show(length, 'm')}",
            value=starts[-1],
        )
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
