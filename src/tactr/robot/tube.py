"""Tubes: a section along a length, with a rest shape and a place in the guide."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.limits import TubeLimits, plain_limits
from tactr.robot.material import Material
from tactr.robot.parts import Part, check_parts, parts_of, plain_material, plain_section
from tactr.robot.pieces import Pieces, PiecesLike, PrecurvatureLike, Vector3, plain_precurvature
from tactr.robot.rest import RestShape
from tactr.robot.section import Section, Stiffness
from tactr.robot.stretch import Stretch, stretches_of
from tactr.robot.tube_friction import TubeFriction, plain_tube_friction

AT_LEAST_ZERO = {"rotation_compliance": "rad/(N m)", "rotation_play": "rad", "translation_play": "m"}


@dataclass(frozen=True)
class Tube:
    """One tube (or rod) of the robot.

    name: by which tendons, loads and actuation refer to it. length: m, above 0. section: Annulus, Rod,
    Stiffness, VaryingStiffness, AsymmetricNotches or SymmetricNotches, or pieces ``(start, section)``.
    material: needed unless the section is a stiffness; one, or pieces ``(start, material)``. precurvature:
    rest curvature and twist u* = (ux, uy, uz) in 1/m in the tube's own material frame (uz is the rest twist),
    either one triple, or pieces ``(start, (ux, uy, uz))``, stored as pieces; or a RestShape, for smooth ones
    and rest shear and stretch. Pieces hold from ``start`` on, where start is the tube's own arc length sigma
    in m from its proximal end and the first start is 0. translation: m, the z of the proximal end, at most 0
    (0: at the guide's exit, s = 0). rotation: rad about +z, imposed at the proximal end. rotation_compliance:
    rad/(N m), at least 0, of a spring through which it is: the end turns by the torque that the actuator
    holds times this less. limits: how far its actuators go, if known. rotation_play: rad, translation_play:
    m, at least 0: the whole backlash of its actuators, which counts in ``tactr.drive`` only. Raises
    RobotError.
    """

    name: str
    _: KW_ONLY
    length: float
    section: Section | Pieces[Section]
    material: Material | Pieces[Material] | None = None
    precurvature: Pieces[Vector3] | RestShape = ((0.0, (0.0, 0.0, 0.0)),)
    translation: float = 0.0
    rotation: float = 0.0
    rotation_compliance: float = 0.0
    limits: TubeLimits | None = None
    rotation_play: float = 0.0
    translation_play: float = 0.0
    friction: TubeFriction | None = None

    if TYPE_CHECKING:  # the constructor takes more forms than the fields store

        def __init__(
            self,
            name: str,
            *,
            length: float,
            section: Section | PiecesLike[Section],
            material: Material | PiecesLike[Material] | None = None,
            precurvature: PrecurvatureLike = (0.0, 0.0, 0.0),
            translation: float = 0.0,
            rotation: float = 0.0,
            rotation_compliance: float = 0.0,
            limits: TubeLimits | None = None,
            rotation_play: float = 0.0,
            translation_play: float = 0.0,
            friction: TubeFriction | float | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        name = check.name("name", self.name)
        with check.owned(f"Tube {name!r}"):
            length = check.real("length", self.length, "m", above=0)
            check.store(self, name=name, length=length)
            check.store(
                self, translation=plain_translation(self.translation), rotation=plain_rotation(self.rotation)
            )
            check.store(self, limits=plain_limits(self.limits, TubeLimits))
            for field, unit in AT_LEAST_ZERO.items():
                check.store(self, **{field: check.real(field, getattr(self, field), unit, least=0)})
            check.store(self, section=plain_section(self.section, length))
            check.store(self, material=plain_material(self.material, length))
            check.store(self, precurvature=plain_precurvature(self.precurvature, length))
            check_parts(self.parts, length)
            check.store(self, friction=plain_tube_friction(self.friction, self.outer_diameter))

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The tube cut where its section or material changes."""
        return parts_of(self.section, self.material, self.length)

    @cached_property
    def stretches(self) -> tuple[Stretch, ...]:
        """Stiffness, rest strains and neutral axis along the tube, as polynomials."""
        return stretches_of(self.parts, self.precurvature, self.length)

    @property
    def stiffness(self) -> Stiffness:
        """Stiffness of the section, in N and N m^2. RobotError where it is not the same all along."""
        stiffness = self.parts[0].stiffness
        if len(self.parts) > 1 or not isinstance(stiffness, Stiffness):
            raise RobotError(
                "section",
                "its stiffness is not the same all along",
                "tube.parts or tube.stretches to read it",
            )
        return stiffness

    @property
    def linear_density(self) -> float | None:
        """Mass per length in kg/m, the mean over the tube; None when it is not known."""
        masses = [
            (part.end - part.start) * part.stiffness.linear_density
            for part in self.parts
            if part.stiffness.linear_density is not None
        ]
        if len(masses) < len(self.parts):
            return None
        return sum(masses) / self.length if len(masses) > 1 else self.parts[0].stiffness.linear_density

    @property
    def outer_diameter(self) -> float | None:
        """Outer diameter in m, the largest along the tube; None when it is not known."""
        widths = [part.section.outer_diameter for part in self.parts]
        return None if None in widths else max(width for width in widths if width is not None)

    @property
    def inner_diameter(self) -> float | None:
        """Bore in m, the least along the tube; 0 for a rod, None when it is not known."""
        bores = [part.section.inner_diameter for part in self.parts]
        return None if None in bores else min(bore for bore in bores if bore is not None)

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
