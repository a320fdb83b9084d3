"""Linear elastic, isotropic materials."""

from __future__ import annotations

from dataclasses import dataclass

from tactr.errors import RobotError
from tactr.robot import _check as check


@dataclass(frozen=True, kw_only=True)
class Material:
    """A linear elastic material, given by Young's modulus and either shear modulus or Poisson's ratio.

    E: Young's modulus, Pa, above 0. G: shear modulus, Pa, above 0. nu: Poisson's ratio, above -1 and at most
    0.5. density: kg/m^3, above 0, or None when it does not matter (no gravity). source: where the values come
    from.

    Exactly one of ``G`` and ``nu`` is given; ``shear_modulus`` and ``poisson_ratio`` answer either way,
    through G = E / (2 (1 + nu)). Raises RobotError.
    """

    E: float
    G: float | None = None
    nu: float | None = None
    density: float | None = None
    name: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        label = check.name("name", self.name, empty=True)
        with check.owned(f"Material {label!r}" if label else "Material"):
            check.store(self, E=check.real("E", self.E, "Pa", above=0, hint="45e9 is 45 GPa"))
            self._check_shear()
            if self.density is not None:
                check.store(self, density=check.real("density", self.density, "kg/m^3", above=0))
            if not isinstance(self.source, str):
                raise RobotError(
                    "source", f"{check.show(self.source)} is not a text", "a text", value=self.source
                )

    def _check_shear(self) -> None:
        if self.G is None and self.nu is None:
            raise RobotError("G", "neither G nor nu is given", "one of G (in Pa) and nu (Poisson's ratio)")
        if self.G is not None and self.nu is not None:
            raise RobotError(
                "G", "both G and nu are given", "only one of G (in Pa) and nu (Poisson's ratio)", value=self.G
            )
        if self.G is not None:
            check.store(self, G=check.real("G", self.G, "Pa", above=0, hint="17e9 is 17 GPa"))
        else:
            check.store(self, nu=check.real("nu", self.nu, above=-1, most=0.5))

    @property
    def shear_modulus(self) -> float:
        """G in Pa, given or from E and nu."""
        if self.G is not None:
            return self.G
        assert self.nu is not None
        return self.E / (2 * (1 + self.nu))

    @property
    def poisson_ratio(self) -> float:
        """nu, given or from E and G (a G measured on its own may give a value outside -1 to 0.5)."""
        if self.nu is not None:
            return self.nu
        assert self.G is not None
        return self.E / (2 * self.G) - 1
