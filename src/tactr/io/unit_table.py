"""The units that robot files and the command line understand, with exact factors, and the kinds of quantity
they measure."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

Dimension = tuple[int, int, int, int]
"""Powers of length, mass, time and angle. Angle counts, so that a rate in rad/m is told from a curvature in
1/m."""

# Fifty digits, so that "180 deg" rounds to the double closest to pi.
_PI = Fraction("3.14159265358979323846264338327950288419716939937510")
_LENGTH, _MASS, _TIME, _ANGLE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
_FORCE, _PRESSURE, _MOMENT = (1, 1, -2, 0), (-1, 1, -2, 0), (2, 1, -2, 0)


def _scaled(dimension: Dimension, **factors: str) -> dict[str, tuple[Fraction, Dimension]]:
    return {name: (Fraction(factor), dimension) for name, factor in factors.items()}


UNITS: dict[str, tuple[Fraction, Dimension]] = {
    **_scaled(_LENGTH, m="1", dm="1e-1", cm="1e-2", mm="1e-3", um="1e-6", nm="1e-9", inch="0.0254"),
    "µm": (Fraction("1e-6"), _LENGTH),  # micro sign
    "μm": (Fraction("1e-6"), _LENGTH),  # Greek letter mu
    **_scaled(_MASS, kg="1", g="1e-3", mg="1e-6"),
    **_scaled(_TIME, s="1", ms="1e-3"),
    **_scaled(_FORCE, N="1", kN="1e3", mN="1e-3", uN="1e-6"),
    **_scaled(_PRESSURE, Pa="1", kPa="1e3", MPa="1e6", GPa="1e9"),
    **_scaled(_MOMENT, Nm="1", Nmm="1e-3", mNm="1e-3"),
    **_scaled(_ANGLE, rad="1", mrad="1e-3"),
    "deg": (_PI / 180, _ANGLE),
    "°": (_PI / 180, _ANGLE),
    "turn": (2 * _PI, _ANGLE),
}


@dataclass(frozen=True)
class Kind:
    """A kind of quantity: its name, the dimensions it accepts, an example, and the units it is written in,
    best first."""

    name: str
    dimensions: tuple[Dimension, ...]
    example: str
    units: tuple[str, ...]

    @property
    def si_unit(self) -> str:
        """The SI one of its units; "1" of a pure number."""
        return "N" if "N" in self.units else self.units[-1] or "1"


_CURVATURE = ((-1, 0, 0, 0), (-1, 0, 0, 1))
_BENDING = (3, 1, -2, 0)

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("number", ((0, 0, 0, 0),), "0.3", ("",)),
        Kind("length", (_LENGTH,), "140 mm", ("mm", "m")),
        Kind("angle", (_ANGLE,), "30 deg", ("deg", "rad")),
        Kind("angle rate", ((-1, 0, 0, 1),), "0.5 deg/mm", ("deg/mm", "rad/m")),
        Kind("curvature", _CURVATURE, "10 1/m", ("1/m",)),
        Kind("modulus", (_PRESSURE,), "65 GPa", ("GPa", "MPa", "Pa")),
        Kind("density", ((-3, 1, 0, 0),), "6450 kg/m^3", ("kg/m^3",)),
        Kind("linear density", ((-1, 1, 0, 0),), "2 g/m", ("g/m", "kg/m")),
        Kind("force", (_FORCE,), "2 N", ("N",)),
        Kind("compliance", ((0, -1, 2, 0),), "0.1 mm/N", ("mm/N", "m/N")),
        Kind("torsional compliance", ((-2, -1, 2, 1),), "0.1 deg/N/mm", ("deg/N/mm", "rad/N/m")),
        Kind("force per length", ((0, 1, -2, 0),), "0.3 N/m", ("N/m",)),
        Kind("moment", (_MOMENT,), "5 N mm", ("N mm", "N m")),
        Kind("moment per length", (_FORCE,), "0.1 N m/m", ("N m/m",)),
        Kind("acceleration", ((1, 0, -2, 0),), "9.81 m/s^2", ("m/s^2",)),
        Kind("bending or torsional stiffness", (_BENDING,), "5000 N mm^2", ("N mm^2", "N m^2")),
        Kind("axial or shear stiffness", (_FORCE,), "12 kN", ("N", "kN")),
    )
}

BARE_KINDS = frozenset({"number", "slope"})

_NAMES: dict[Dimension, str] = {
    (0, 0, 0, 0): "a pure number",
    _LENGTH: "a length",
    (2, 0, 0, 0): "an area",
    _MASS: "a mass",
    _TIME: "a time",
    _ANGLE: "an angle",
    (-1, 0, 0, 1): "an angle rate",
    (-1, 0, 0, 0): "a curvature (1/length)",
    _PRESSURE: "a modulus or pressure",
    _FORCE: "a force",
    (0, 1, -2, 0): "a force per length",
    (0, -1, 2, 0): "a compliance",
    (-2, -1, 2, 1): "a torsional compliance",
    _MOMENT: "a moment",
    (-3, 1, 0, 0): "a density",
    (-1, 1, 0, 0): "a mass per length",
    (1, 0, -2, 0): "an acceleration",
    _BENDING: "a bending or torsional stiffness",
}


def kind_name(dimension: Dimension) -> str:
    """What a unit of this dimension measures, in words, for error messages."""
    if dimension in _NAMES:
        return _NAMES[dimension]
    symbols = zip(("length", "mass", "time", "angle"), dimension, strict=True)
    return "a quantity in " + " ".join(f"{name}^{power}" for name, power in symbols if power)


def coefficient_kind(base: str, power: int) -> Kind:
    """The kind of the coefficient of sigma**power in a polynomial whose value is of the kind ``base``."""
    if power == 0:
        return KINDS[base]
    if base not in ("length", "angle"):
        return _stiffness_coefficient(base, power)
    length = -power + (1 if base == "length" else 0)
    dimension: Dimension = (length, 0, 0, 0 if base == "length" else 1)
    if dimension == (0, 0, 0, 0):
        return Kind("slope", (dimension,), "0.05", ("",))
    top = "1" if base == "length" else "rad"
    unit = f"{top}/m" if length == -1 else f"{top}/m^{-length}"
    return Kind(f"coefficient of sigma^{power}", (dimension,), f"2 {unit}", (unit,))


_FRONT = {
    "bending or torsional stiffness": ("N", 2),
    "axial or shear stiffness": ("N", 0),
    "number": ("1", 0),
}


def _stiffness_coefficient(base: str, power: int) -> Kind:
    """The same for what describes a tube, in newtons and metres."""
    front, length = _FRONT.get(base, ("1", -1))
    length -= power
    metres = {0: "", 1: "m", -1: "m"}.get(length, f"m^{abs(length)}")
    unit = f"{front} {metres}".strip() if length >= 0 else f"{front}/{metres}"
    dimensions = tuple((m - power, kg, s, rad) for m, kg, s, rad in KINDS[base].dimensions)
    return Kind(f"coefficient of sigma^{power}", dimensions, f"2 {unit}", (unit,))
