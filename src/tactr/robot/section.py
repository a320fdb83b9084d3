"""Cross-sections: what turns a material into the stiffness of a tube."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.material import Material

if TYPE_CHECKING:
    from tactr.robot.varying import VaryingStiffness

UNITS = {"EA": "N", "GA": "N", "EI_x": "N m^2", "EI_y": "N m^2", "GJ": "N m^2"}


@runtime_checkable
class Section(Protocol):
    """Anything with diameters in m (None when unknown; a bore of 0 is solid) and a stiffness."""

    @property
    def outer_diameter(self) -> float | None: ...

    @property
    def inner_diameter(self) -> float | None: ...

    def stiffness(self, material: Material | None = None) -> Stiffness | VaryingStiffness:
        """Stiffness of the section in ``material``; RobotError where a material is needed and missing."""
        ...


@dataclass(frozen=True, kw_only=True)
class Stiffness:
    """Stiffness of a section given directly; it is also a section itself, and then needs no material.

    EA (axial) and GA (shear, both directions) in N; EI_x, EI_y (bending about the tube's own x and y axes
    through the neutral axis) and GJ (torsion) in N m^2; all above 0. neutral_axis: (x, y) in m, where an
    axial force bends nothing, from the centreline in the tube's material frame: there n3 = EA (v3 - v3* + (u
    - u*)_x y - (u - u*)_y x) acts, which adds (y n3, -x n3) to the moment about the centreline.
    outer_diameter, inner_diameter in m, or None when unknown: the fit of tubes in each other is then not
    checked. linear_density in kg/m, or None when unknown. Raises RobotError.
    """

    EA: float
    GA: float
    EI_x: float
    EI_y: float
    GJ: float
    neutral_axis: tuple[float, float] = (0.0, 0.0)
    outer_diameter: float | None = None
    inner_diameter: float | None = None
    linear_density: float | None = None

    def __post_init__(self) -> None:
        with check.owned("Stiffness"):
            for field, unit in UNITS.items():
                check.store(self, **{field: check.real(field, getattr(self, field), unit, above=0)})
            x, y = check.numbers("neutral_axis", self.neutral_axis, "m", fewest=2, most=2)
            check.store(self, neutral_axis=(x, y))
            check_rest(self)

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """Itself; ``material`` is not used."""
        return self


@dataclass(frozen=True)
class Annulus:
    """A round tube: outer_diameter above inner_diameter, inner_diameter at least 0, in m.

    A = pi (D^2 - d^2) / 4, I = pi (D^4 - d^4) / 64, J = 2 I; shear stiffness GA = G A with shear factor 1, as
    in the published model. Raises RobotError.
    """

    outer_diameter: float
    inner_diameter: float

    def __post_init__(self) -> None:
        with check.owned("Annulus"):
            outer = check.real("outer_diameter", self.outer_diameter, "m", above=0)
            bore = check.real("inner_diameter", self.inner_diameter, "m", least=0)
            _check_wall(outer, bore)
            check.store(self, outer_diameter=outer, inner_diameter=bore)

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """Stiffness in N and N m^2, and the mass per length where the material's density is known."""
        return _round(self.outer_diameter, self.inner_diameter, material)


@dataclass(frozen=True)
class Rod:
    """A solid round rod of ``diameter`` in m; nothing fits inside. Formulas of Annulus. Raises RobotError."""

    diameter: float

    def __post_init__(self) -> None:
        with check.owned("Rod"):
            check.store(self, diameter=check.real("diameter", self.diameter, "m", above=0))

    @property
    def outer_diameter(self) -> float:
        """The diameter, m."""
        return self.diameter

    @property
    def inner_diameter(self) -> float:
        """0: a rod has no bore."""
        return 0.0

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """Stiffness in N and N m^2, and the mass per length where the material's density is known."""
        return _round(self.diameter, 0.0, material)


def check_rest(section: Stiffness | VaryingStiffness) -> None:
    """Check and store diameters and linear density."""
    bore, width, density = section.inner_diameter, section.outer_diameter, section.linear_density
    if width is not None:
        check.store(section, outer_diameter=check.real("outer_diameter", width, "m", above=0))
    if bore is not None:
        check.store(section, inner_diameter=check.real("inner_diameter", bore, "m", least=0))
        _check_wall(section.outer_diameter, bore)
    if density is not None:
        check.store(section, linear_density=check.real("linear_density", density, "kg/m", above=0))


def _check_wall(outer: float | None, bore: float) -> None:
    if outer is not None and not bore < outer:
        raise RobotError(
            "inner_diameter",
            f"{check.show(bore, 'm')} leaves no wall inside the outer diameter {check.show(outer, 'm')}",
            f"a bore below {check.show(outer, 'm')}",
            value=bore,
        )


def _round(outer: float, bore: float, material: Material | None) -> Stiffness:
    if material is None:
        raise RobotError(
            "material",
            "none is given, and the section alone has no stiffness",
            "a Material, or the section given as Stiffness",
        )
    area = math.pi * (outer - bore) * (outer + bore) / 4
    inertia = area * (outer**2 + bore**2) / 16
    shear = material.shear_modulus
    density = None if material.density is None else material.density * area
    try:
        return Stiffness(
            EA=material.E * area,
            GA=shear * area,
            EI_x=material.E * inertia,
            EI_y=material.E * inertia,
            GJ=shear * 2 * inertia,
            outer_diameter=outer,
            inner_diameter=bore,
            linear_density=density,
        )
    except RobotError as error:
        raise RobotError(
            "section",
            f"its stiffness {error.field} comes out as {error.problem}",
            "a diameter in m and moduli in Pa",
            value=outer,
        ) from None
