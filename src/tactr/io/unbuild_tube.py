"""From a Tube to its data in a robot file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tactr.errors import RobotError
from tactr.io.unit_table import BARE_KINDS, KINDS, coefficient_kind
from tactr.io.units import format_quantity
from tactr.robot import (
    Along,
    Annulus,
    AsymmetricNotches,
    Material,
    RestShape,
    Rod,
    Section,
    Stiffness,
    SymmetricNotches,
    Tube,
    TubeFriction,
    VaryingStiffness,
)

ZERO = (0.0, 0.0, 0.0)


def write(value: float, kind: str) -> str:
    """A number with its unit."""
    return format_quantity(value, KINDS[kind])


def write_vector(value: Sequence[float], kind: str) -> list[str | int]:
    """Numbers with their units, zeros bare."""
    return [write(component, kind) if component else 0 for component in value]


def write_ranges(limits: object, **kinds: str) -> dict[str, list[str | int]]:
    """The ranges there are, by name; kinds: of their quantities."""
    ranges = {name: getattr(limits, name) for name in kinds}
    return {name: write_vector(ends, kinds[name]) for name, ends in ranges.items() if ends is not None}


def powers(coefficients: Sequence[float], base: str) -> list[Any]:
    """Coefficients of a polynomial of the kind ``base``, with their units."""
    kinds = [coefficient_kind(base, power) for power in range(len(coefficients))]
    return [
        value if kind.name in BARE_KINDS else format_quantity(value, kind)
        for value, kind in zip(coefficients, kinds, strict=True)
    ]


def unbuild_tube(tube: Tube, place: str) -> dict[str, Any]:
    """Plain data with units. Raises RobotError for a section that a file cannot hold, at ``place``."""
    data: dict[str, Any] = {"name": tube.name, "length": write(tube.length, "length")}
    if isinstance(tube.section, tuple):
        data["sections"] = [
            {"from": write(start, "length"), **_section(section, f"{place}.section[{k}][1]")}
            for k, (start, section) in enumerate(tube.section)
        ]
    else:
        data |= _section(tube.section, f"{place}.section")
    if isinstance(tube.material, tuple):
        data["material"] = [
            {"from": write(start, "length"), "material": _material(material)}
            for start, material in tube.material
        ]
    elif tube.material is not None:
        data["material"] = _material(tube.material)
    if tube.precurvature != ((0.0, ZERO),):
        data["precurvature"] = _precurvature(tube)
    if tube.translation:
        data["translation"] = write(tube.translation, "length")
    if tube.rotation:
        data["rotation"] = write(tube.rotation, "angle")
    if tube.rotation_compliance:
        data["rotation_compliance"] = write(tube.rotation_compliance, "torsional compliance")
    if tube.translation_compliance:
        data["translation_compliance"] = write(tube.translation_compliance, "compliance")
    if tube.limits is not None:
        data["limits"] = write_ranges(tube.limits, rotation="angle", translation="length")
    if tube.rotation_play:
        data["rotation_play"] = write(tube.rotation_play, "angle")
    if tube.translation_play:
        data["translation_play"] = write(tube.translation_play, "length")
    if tube.friction is not None:
        data["friction"] = _friction(tube.friction)
    return data


def _friction(friction: TubeFriction) -> Any:
    lengths = {key: getattr(friction, key) for key in ("radius", "lever")}
    given = {key: write(value, "length") for key, value in lengths.items() if value is not None}
    return {"coefficient": friction.coefficient} | given if given else friction.coefficient


def _section(section: Section, place: str) -> dict[str, Any]:
    if isinstance(section, Rod):
        return {"diameter": write(section.diameter, "length")}
    if not isinstance(section, (Annulus, Stiffness, VaryingStiffness, AsymmetricNotches, SymmetricNotches)):
        raise RobotError(
            place,
            f"a {type(section).__name__} cannot be written to a file",
            "an Annulus, a Rod or a Stiffness",
        )
    data: dict[str, Any] = {}
    for key in ("outer_diameter", "inner_diameter"):
        if (value := getattr(section, key)) is not None:
            data[key] = write(value, "length")
    if isinstance(section, (Stiffness, VaryingStiffness)):
        data["stiffness"] = _stiffness(section)
    elif not isinstance(section, Annulus):
        data["notches"] = _notches(section)
    return data


def _notches(section: AsymmetricNotches | SymmetricNotches) -> dict[str, str]:
    kind = "symmetric"
    if isinstance(section, AsymmetricNotches):
        kind = "staggered" if section.staggered else "asymmetric"
    lengths = {key: write(getattr(section, key), "length") for key in ("depth", "cut", "uncut")}
    return {"kind": kind, **lengths, "side": section.side}


def _stiffness(section: Stiffness | VaryingStiffness) -> dict[str, Any]:
    data = {key: _along(getattr(section, key), "axial or shear stiffness") for key in ("EA", "GA")}
    data |= {
        key: _along(getattr(section, key), "bending or torsional stiffness") for key in ("EI_x", "EI_y", "GJ")
    }
    if section.neutral_axis != (0.0, 0.0):
        data["neutral_axis"] = [_along(q, "length") for q in section.neutral_axis]
    if section.linear_density is not None:
        data["linear_density"] = write(section.linear_density, "linear density")
    return data


def _along(quantity: float | Along, kind: str) -> Any:
    if not isinstance(quantity, Along):
        return quantity if kind == "number" else write(quantity, kind)
    parts = [
        {"from": write(start, "length"), "coefficients": powers(coefficients, kind)}
        for start, coefficients in quantity.parts
    ]
    return {"parts": parts} | ({} if quantity.end == math.inf else {"end": write(quantity.end, "length")})


def _material(material: Material) -> str | dict[str, Any]:
    from tactr.materials import PRESETS

    for name, preset in PRESETS.items():
        if material == preset:
            return name
    data: dict[str, Any] = {"E": write(material.E, "modulus")}
    if material.G is not None:
        data["G"] = write(material.G, "modulus")
    if material.nu is not None:
        data["nu"] = material.nu
    if material.density is not None:
        data["density"] = write(material.density, "density")
    return data | {key: text for key in ("name", "source") if (text := getattr(material, key))}


def _precurvature(tube: Tube) -> Any:
    rest = tube.precurvature
    if isinstance(rest, RestShape):
        data: dict[str, Any] = {"kind": "strains", "u": [_along(q, "curvature") for q in rest.u]}
        return data | ({} if rest.v == (0.0, 0.0, 1.0) else {"v": [_along(q, "number") for q in rest.v]})
    if len(rest) == 1:
        return write_vector(rest[0][1], "curvature")
    return [{"from": write(start, "length"), "u": write_vector(u, "curvature")} for start, u in rest]
