"""Cross-sections: what turns a material into the stiffness of a tube."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._along_fit import fit_along
from tactr.robot.along import Along
from tactr.robot.material import Material


@runtime_checkable
class Section(Protocol):
    """Anything with diameters in m (None when unknown; a bore of 0 is solid) and a stiffness."""

    @property
    def outer_diameter(self) -> float | None: ...

    @property
    def inner_diameter(self) -> float | None: ...

    def stiffness(self, material: Material | None = None) -> Stiffness:
        """Stiffness of the section in ``material``; RobotError where a material is needed and missing."""
        ...


@dataclass(frozen=True, kw_only=True)
class Stiffness:
    """Stiffness of a section given directly; it is also a section itself, and then needs no material.

    EA (axial) and GA (shear, both directions) in N; EI_x, EI_y (bending about the tube's own x and y axes
    through the neutral axis) and GJ (torsion) in N m^2; all above 0. Each is a number, or an Along: a function
    of the tube's own arc length. neutral_axis: (x, y) in m, where an axial force bends nothing, from the
    centreline in the tube's material frame; numbers or Alongs. There n3 = EA (v3 - v3* + (u - u*)_x y - (u -
    u*)_y x) acts, which adds (y n3, -x n3) to the moment about the centreline. outer_diameter, inner_diameter
    in m, or None when unknown: the fit of tubes in each other is then not checked. linear_density in kg/m, or
    None when unknown. Raises RobotError.
    """

    EA: float | Along
    GA: float | Along
    EI_x: float | Along
    EI_y: float | Along
    GJ: float | Along
    neutral_axis: tuple[float | Along, float | Along] = (0.0, 0.0)
    outer_diameter: float | None = None
    inner_diameter: float | None = None
    linear_density: float | None = None

    def __post_init__(self) -> None:
        with check.owned("Stiffness"):
            for field, unit in (
                ("EA", "N"),
                ("GA", "N"),
                ("EI_x", "N m^2"),
                ("EI_y", "N m^2"),
                ("GJ", "N m^2"),
            ):
                check.store(self, **{field: _positive(field, getattr(self, field), unit)})
            check.store(self, neutral_axis=_neutral_axis(self.neutral_axis))
            if self.outer_diameter is not None:
                check.store(
                    self, outer_diameter=check.real("outer_diameter", self.outer_diameter, "m", above=0)
                )
            if self.inner_diameter is not None:
                bore = check.real("inner_diameter", self.inner_diameter, "m", least=0)
                check.store(self, inner_diameter=bore)
                _check_wall(self.outer_diameter, bore)
            if self.linear_density is not None:
                density = check.real("linear_density", self.linear_density, "kg/m", above=0)
                check.store(self, linear_density=density)

    @classmethod
    def function(
        cls,
        function: Callable[[float], Section],
        length: float,
        *,
        material: Material | None = None,
        breaks: Sequence[float] = (),
    ) -> Stiffness:
        """A section that varies smoothly: ``function`` takes the tube's arc length sigma (m) to a section.

        Its constants are fitted on 0 to ``length`` (m) within 1e-9 of their largest values, and the function
        is not called again. breaks: places in m of jumps and kinks. The diameters are the largest outside and
        the least bore, for the fit of tubes in each other; the linear density stays unknown unless it is
        constant. Raises RobotError.
        """
        with check.owned("Stiffness"):
            return _fitted(cls, function, length, material, breaks)

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


def _positive(field: str, value: object, unit: str) -> float | Along:
    if not isinstance(value, Along):
        return check.real(field, value, unit, above=0)
    if value.end == math.inf:
        return value  # a polynomial without end: the tube that uses it checks it
    least = value.least(0.0, value.end)
    if not least > 0:
        raise RobotError(
            field, f"it falls to {check.show(least, unit)}", f"values in {unit} above 0 all along", value=value
        )
    return value


def _neutral_axis(value: object) -> tuple[float | Along, float | Along]:
    expected = "(x, y) in m"
    entries = check.row("neutral_axis", value, expected)
    if len(entries) != 2:
        raise RobotError("neutral_axis", f"{len(entries)} entries found", expected, value=value)
    x, y = (
        entry if isinstance(entry, Along) else check.real(f"neutral_axis[{k}]", entry, "m")
        for k, entry in enumerate(entries)
    )
    return x, y


_CONSTANTS = ("EA", "GA", "EI_x", "EI_y", "GJ")


def _fitted(
    kind: type[Stiffness],
    function: Callable[[float], Section],
    length: float,
    material: Material | None,
    breaks: Sequence[float],
) -> Stiffness:
    seen: list[Stiffness] = []

    def constants(sigma: float) -> list[float | Along]:
        section = function(sigma)
        if isinstance(section, type) or not isinstance(section, Section):
            raise RobotError(
                "function",
                f"it returned {check.show(section)} at sigma = {sigma:.9g} m",
                "an Annulus, a Rod or another section",
                value=section,
            )
        stiffness = section.stiffness(material)
        seen.append(stiffness)
        return [*(getattr(stiffness, name) for name in _CONSTANTS), *stiffness.neutral_axis]

    fitted = [Along(parts, length) for parts in fit_along(constants, 7, length, breaks=breaks)]
    widths = [s.outer_diameter for s in seen if s.outer_diameter is not None]
    bores = [s.inner_diameter for s in seen if s.inner_diameter is not None]
    densities = {s.linear_density for s in seen}
    return kind(
        **dict(zip(_CONSTANTS, fitted[:5], strict=True)),
        neutral_axis=(fitted[5], fitted[6]),
        outer_diameter=max(widths) if len(widths) == len(seen) else None,
        inner_diameter=min(bores) if len(bores) == len(seen) else None,
        linear_density=densities.pop() if len(densities) == 1 else None,
    )


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
