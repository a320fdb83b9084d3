"""Friction of a tube in the next body around it."""

from __future__ import annotations

from dataclasses import dataclass

from tactr.errors import RobotError
from tactr.robot import _check as check

LEVER_IN_RADII = 4.0  # two diameters: see TubeFriction


@dataclass(frozen=True)
class TubeFriction:
    """Coulomb friction of a tube that turns in the next outer tube, the outermost one in the guide.

    coefficient: of friction, at least 0. radius: m, of the contact; None: half the tube's outer diameter.
    lever: m, over which a concentrated contact moment (at the end of a tube, or where rest curvature jumps)
    is borne by two opposite forces; None: two outer diameters, an assumption. It acts in ``tactr.drive``; a
    plain solve has no friction. Raises RobotError.
    """

    coefficient: float
    radius: float | None = None
    lever: float | None = None

    def __post_init__(self) -> None:
        check.store(self, coefficient=check.real("coefficient", self.coefficient, least=0))
        for field in ("radius", "lever"):
            value = getattr(self, field)
            if value is not None:
                check.store(self, **{field: check.real(field, value, "m", above=0)})


def plain_tube_friction(value: object, outer_diameter: float | None) -> TubeFriction | None:
    """A number as a coefficient, a TubeFriction or None, checked."""
    if value is None:
        return None
    if not isinstance(value, TubeFriction):
        expected = "a coefficient of at least 0, a TubeFriction, or None"
        try:
            value = TubeFriction(check.real("friction", value, least=0))
        except RobotError as error:
            raise RobotError("friction", error.problem, expected, value=value) from None
    if value.radius is None and outer_diameter is None:
        raise RobotError(
            "friction.radius", "the tube's outer diameter is not known", "the radius of the contact in m"
        )
    return value


def contact_radius(friction: TubeFriction, outer_diameter: float | None) -> float:
    """Radius on which a tube rubs, m."""
    return friction.radius if friction.radius is not None else 0.5 * (outer_diameter or 0.0)


def contact_lever(friction: TubeFriction, outer_diameter: float | None) -> float:
    """Lever of its concentrated contact moments, m."""
    if friction.lever is not None:
        return friction.lever
    return LEVER_IN_RADII * contact_radius(friction, outer_diameter)
