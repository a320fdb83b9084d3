"""Stiffness that varies smoothly along a tube."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._along_fit import fit_along
from tactr.robot.along import Along
from tactr.robot.material import Material
from tactr.robot.section import UNITS, Section, Stiffness, check_rest

Quantity = float | Along


@dataclass(frozen=True, kw_only=True)
class VaryingStiffness:
    """A Stiffness of which at least one constant is an Along: a function of the tube's own arc length.

    Fields, units and meaning are those of Stiffness; every one of EA, GA, EI_x, EI_y, GJ and the two
    components of neutral_axis may be a number or an Along. The diameters are the largest outside and the
    least bore. It is a section and needs no material. Raises RobotError.
    """

    EA: Quantity
    GA: Quantity
    EI_x: Quantity
    EI_y: Quantity
    GJ: Quantity
    neutral_axis: tuple[Quantity, Quantity] = (0.0, 0.0)
    outer_diameter: float | None = None
    inner_diameter: float | None = None
    linear_density: float | None = None

    def __post_init__(self) -> None:
        with check.owned("VaryingStiffness"):
            for field, unit in UNITS.items():
                check.store(self, **{field: _positive(field, getattr(self, field), unit)})
            check.store(self, neutral_axis=_neutral_axis(self.neutral_axis))
            if not any(isinstance(q, Along) for q in self.quantities):
                raise RobotError(
                    "EI_x", "it does not vary, and nothing else does", "an Along, or a Stiffness"
                )
            check_rest(self)

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """EA, GA, EI_x, EI_y, GJ and the neutral axis x, y."""
        return (self.EA, self.GA, self.EI_x, self.EI_y, self.GJ, *self.neutral_axis)

    def stiffness(self, material: Material | None = None) -> VaryingStiffness:
        """Itself; ``material`` is not used."""
        return self

    @classmethod
    def function(
        cls,
        function: Callable[[float], Section],
        length: float,
        *,
        material: Material | None = None,
        breaks: Sequence[float] = (),
    ) -> VaryingStiffness:
        """A section that varies smoothly: ``function`` takes the tube's arc length sigma (m) to a section.

        Its constants are fitted on 0 to ``length`` (m) within 1e-9 of their largest values, and the function
        is not called again. breaks: places in m of jumps and kinks. The linear density stays unknown unless
        it is constant. Raises RobotError.
        """
        seen: list[Stiffness] = []

        def constants(sigma: float) -> list[float]:
            seen.append(_constant(function(sigma), material, sigma))
            return [*(getattr(seen[-1], name) for name in UNITS), *seen[-1].neutral_axis]

        with check.owned("VaryingStiffness"):
            EA, GA, EI_x, EI_y, GJ, x, y = (
                Along(parts, length) for parts in fit_along(constants, 7, length, breaks=breaks)
            )
        widths = [s.outer_diameter for s in seen if s.outer_diameter is not None]
        bores = [s.inner_diameter for s in seen if s.inner_diameter is not None]
        densities = {s.linear_density for s in seen}
        return cls(
            EA=EA,
            GA=GA,
            EI_x=EI_x,
            EI_y=EI_y,
            GJ=GJ,
            neutral_axis=(x, y),
            outer_diameter=max(widths) if len(widths) == len(seen) else None,
            inner_diameter=min(bores) if len(bores) == len(seen) else None,
            linear_density=densities.pop() if len(densities) == 1 else None,
        )


def _constant(section: object, material: Material | None, sigma: float) -> Stiffness:
    stiffness = None
    if isinstance(section, Section) and not isinstance(section, type):
        stiffness = section.stiffness(material)
    if not isinstance(stiffness, Stiffness):
        raise RobotError(
            "function",
            f"it returned {check.show(section)} at sigma = {sigma:.9g} m",
            "an Annulus, a Rod or another section that does not vary itself",
            value=section,
        )
    return stiffness


def _positive(field: str, value: object, unit: str) -> Quantity:
    if not isinstance(value, Along):
        return check.real(field, value, unit, above=0)
    if value.end == math.inf:
        return value  # a polynomial without end: the tube that uses it checks it
    least = value.least(0.0, value.end)
    if not least > 0:
        raise RobotError(
            field,
            f"it falls to {check.show(least, unit)}",
            f"values in {unit} above 0 all along",
            value=value,
        )
    return value


def _neutral_axis(value: object) -> tuple[Quantity, Quantity]:
    expected = "(x, y) in m"
    entries = check.row("neutral_axis", value, expected)
    if len(entries) != 2:
        raise RobotError("neutral_axis", f"{len(entries)} entries found", expected, value=value)
    x, y = (
        entry if isinstance(entry, Along) else check.real(f"neutral_axis[{k}]", entry, "m")
        for k, entry in enumerate(entries)
    )
    return x, y
