"""From a Robot to the data of a robot file, such that reading the file gives an equal robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tactr.errors import RobotError
from tactr.io.unit_table import KINDS, coefficient_kind
from tactr.io.units import format_quantity
from tactr.robot import (
    Annulus,
    DistributedLoad,
    Gravity,
    Helix,
    Load,
    Material,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Robot,
    Rod,
    Routing,
    Spline,
    Stiffness,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

ZERO = (0.0, 0.0, 0.0)


def unbuild(robot: Robot) -> dict[str, Any]:
    """Plain data with units. Raises RobotError for what a file cannot hold: a routing that is a Python
    function."""
    data: dict[str, Any] = {}
    if robot.name:
        data["name"] = robot.name
    if robot.description:
        data["description"] = robot.description
    if robot.assumed:
        data["assumed"] = list(robot.assumed)
    data["tubes"] = [_tube(tube) for tube in robot.tubes]
    if robot.tendons:
        data["tendons"] = [_tendon(tendon, f"tendons[{k}]") for k, tendon in enumerate(robot.tendons)]
    if robot.loads:
        data["loads"] = [_load(load) for load in robot.loads]
    if "assumed" in data:
        data["assumed"] = _assumed(robot.assumed, data)
    return data


def _write(value: float, kind: str) -> str:
    return format_quantity(value, KINDS[kind])


def _vector(value: Sequence[float], kind: str) -> list[str | int]:
    return [_write(component, kind) if component else 0 for component in value]


def _assumed(remarks: Sequence[str], data: dict[str, Any]) -> dict[str, str] | list[str]:
    """A mapping from field to reason where every remark has that form, or the remarks as they are."""
    from tactr.io.build import exists

    split = [remark.partition(": ") for remark in remarks]
    fields = {field: reason for field, _, reason in split}
    if len(fields) == len(remarks) and all(
        reason and exists(field, data) for field, reason in fields.items()
    ):
        return fields
    return list(remarks)


def _tube(tube: Tube) -> dict[str, Any]:
    data = {"name": tube.name, "length": _write(tube.length, "length"), **_section(tube)}
    if tube.material is not None:
        data["material"] = _material(tube.material)
    if tube.precurvature != ((0.0, ZERO),):
        data["precurvature"] = _precurvature(tube)
    if tube.translation:
        data["translation"] = _write(tube.translation, "length")
    if tube.rotation:
        data["rotation"] = _write(tube.rotation, "angle")
    return data


def _section(tube: Tube) -> dict[str, Any]:
    section = tube.section
    if isinstance(section, Rod):
        return {"diameter": _write(section.diameter, "length")}
    data: dict[str, Any] = {}
    if isinstance(section, (Annulus, Stiffness)):
        for key in ("outer_diameter", "inner_diameter"):
            if (value := getattr(section, key)) is not None:
                data[key] = _write(value, "length")
    if isinstance(section, Stiffness):
        data["stiffness"] = _stiffness(section)
    elif not isinstance(section, Annulus):
        raise RobotError(
            "section",
            f"a {type(section).__name__} cannot be written to a file",
            "an Annulus, a Rod or a Stiffness",
        )
    return data


def _stiffness(section: Stiffness) -> dict[str, str]:
    data = {key: _write(getattr(section, key), "axial or shear stiffness") for key in ("EA", "GA")}
    data |= {
        key: _write(getattr(section, key), "bending or torsional stiffness") for key in ("EI_x", "EI_y", "GJ")
    }
    if section.linear_density is not None:
        data["linear_density"] = _write(section.linear_density, "linear density")
    return data


def _material(material: Material) -> str | dict[str, Any]:
    from tactr.materials import PRESETS

    for name, preset in PRESETS.items():
        if material == preset:
            return name
    data: dict[str, Any] = {"E": _write(material.E, "modulus")}
    if material.G is not None:
        data["G"] = _write(material.G, "modulus")
    if material.nu is not None:
        data["nu"] = material.nu
    if material.density is not None:
        data["density"] = _write(material.density, "density")
    return data | {key: text for key in ("name", "source") if (text := getattr(material, key))}


def _precurvature(tube: Tube) -> list[Any]:
    if len(tube.precurvature) == 1:
        return _vector(tube.precurvature[0][1], "curvature")
    return [{"from": _write(start, "length"), "u": _vector(u, "curvature")} for start, u in tube.precurvature]


def _tendon(tendon: Tendon, place: str) -> dict[str, Any]:
    data: dict[str, Any] = {
        "name": tendon.name,
        "tube": tendon.tube,
        "routing": _routing(tendon.routing, f"{place}.routing"),
    }
    if tendon.host != "own":
        data["host"] = tendon.host
    if isinstance(tendon.tension, TensionProfile):
        profile = tendon.tension
        data["tension"] = {
            "sigma": _vector(profile.sigma, "length"),
            "values": _vector(profile.values, "force"),
        }
    else:
        data["tension"] = _write(tendon.tension, "force")
    if tendon.end is not None:
        data["end"] = _write(tendon.end, "length")
    return data


def _routing(routing: Routing, place: str) -> dict[str, Any]:
    if isinstance(routing, Straight):
        return {"kind": "straight", "x": _write(routing.x, "length"), "y": _write(routing.y, "length")}
    if isinstance(routing, Helix):
        radius, rate, phase = routing.radius, routing.rate, routing.phase
        data = {
            "radius": _write(radius, "length"),
            "rate": _write(rate, "angle rate"),
            "phase": _write(phase, "angle"),
        }
        return {"kind": "helix", **data}
    if isinstance(routing, Polynomial):
        return {"kind": "polynomial", "x": _powers(routing.x, "length"), "y": _powers(routing.y, "length")}
    if isinstance(routing, PolarPolynomial):
        return {
            "kind": "polar_polynomial",
            "radius": _powers(routing.radius, "length"),
            "angle": _powers(routing.angle, "angle"),
        }
    if isinstance(routing, Spline):
        points = [_vector(point, "length") for point in routing.points]
        return {"kind": "spline", "sigma": _vector(routing.sigma, "length"), "points": points}
    if isinstance(routing, Piecewise):
        return {
            "kind": "piecewise",
            "parts": [_part(k, *part, place) for k, part in enumerate(routing.parts)],
        }
    raise RobotError(
        place,
        f"a {type(routing).__name__} is Python code and cannot be written to a file",
        "a Spline through points of it, or another routing",
    )


def _part(k: int, start: float, routing: Routing, place: str) -> dict[str, Any]:
    return {"from": _write(start, "length"), "routing": _routing(routing, f"{place}.parts[{k}].routing")}


def _powers(coefficients: Sequence[float], base: str) -> list[str]:
    return [format_quantity(value, coefficient_kind(base, power)) for power, value in enumerate(coefficients)]


def _load(load: Load) -> dict[str, Any]:
    if isinstance(load, Gravity):
        return {"kind": "gravity", "acceleration": _vector(load.acceleration, "acceleration")}
    if isinstance(load, PointLoad):
        data: dict[str, Any] = {"kind": "point", "tube": load.tube}
        data |= _wrench(load, "force", "moment")
        return data | _places(load, at=None) | _axes(load)
    data = {"kind": "distributed"} | ({} if load.tube is None else {"tube": load.tube})
    return (
        data
        | _wrench(load, "force per length", "moment per length")
        | _places(load, start=0.0, end=None)
        | _axes(load)
    )


def _wrench(load: PointLoad | DistributedLoad, force: str, moment: str) -> dict[str, Any]:
    wrench = {"force": (load.force, force), "moment": (load.moment, moment)}
    return {key: _vector(value, kind) for key, (value, kind) in wrench.items() if value != ZERO}


def _places(load: PointLoad | DistributedLoad, **defaults: float | None) -> dict[str, str]:
    values = {key: getattr(load, key) for key in defaults}
    return {key: _write(value, "length") for key, value in values.items() if value != defaults[key]}


def _axes(load: PointLoad | DistributedLoad) -> dict[str, str]:
    return {} if load.axes == "world" else {"axes": load.axes}
