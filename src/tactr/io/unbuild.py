"""From a Robot to the data of a robot file, such that reading the file gives an equal robot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tactr.errors import RobotError
from tactr.io.unbuild_tube import ZERO, powers, unbuild_tube, write, write_ranges, write_vector
from tactr.robot import (
    DistributedLoad,
    Gravity,
    Helix,
    Load,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Robot,
    Routing,
    Spline,
    Straight,
    Tendon,
    TensionProfile,
)


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
    data["tubes"] = [unbuild_tube(tube, f"tubes[{k}]") for k, tube in enumerate(robot.tubes)]
    if robot.tendons:
        data["tendons"] = [_tendon(tendon, f"tendons[{k}]") for k, tendon in enumerate(robot.tendons)]
    if robot.loads:
        data["loads"] = [_load(load) for load in robot.loads]
    if "assumed" in data:
        data["assumed"] = _assumed(robot.assumed, data)
    return data


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
            "sigma": write_vector(profile.sigma, "length"),
            "values": write_vector(profile.values, "force"),
        }
    elif tendon.displacement is None:
        data["tension"] = write(tendon.tension, "force")
    else:
        data["displacement"] = write(tendon.displacement, "length")
    data |= _motor(tendon)
    if tendon.end is not None:
        data["end"] = write(tendon.end, "length")
    if tendon.limits is not None:
        data["limits"] = write_ranges(tendon.limits, tension="force", displacement="length")
    return data | _friction(tendon)


def _friction(tendon: Tendon) -> dict[str, Any]:
    data: dict[str, Any] = {}
    if isinstance(tendon.friction, tuple):
        data["friction"] = [
            {"from": write(start, "length"), "coefficient": value} for start, value in tendon.friction
        ]
    elif tendon.friction:
        data["friction"] = tendon.friction
    if tendon.contacts is not None:
        data["contacts"] = write_vector(tendon.contacts, "length")
    if tendon.play:
        data["play"] = write(tendon.play, "length")
    return data


def _motor(tendon: Tendon) -> dict[str, str]:
    data = {}
    if tendon.compliance != 0.0:
        data["compliance"] = write(tendon.compliance, "compliance")
    if tendon.pretension != 0.0:
        data["pretension"] = write(tendon.pretension, "force")
    if tendon.rest_length is not None:
        data["rest_length"] = write(tendon.rest_length, "length")
    return data


def _routing(routing: Routing, place: str) -> dict[str, Any]:
    if isinstance(routing, Straight):
        return {"kind": "straight", "x": write(routing.x, "length"), "y": write(routing.y, "length")}
    if isinstance(routing, Helix):
        radius, rate, phase = routing.radius, routing.rate, routing.phase
        data = {
            "radius": write(radius, "length"),
            "rate": write(rate, "angle rate"),
            "phase": write(phase, "angle"),
        }
        return {"kind": "helix", **data}
    if isinstance(routing, Polynomial):
        return {"kind": "polynomial", "x": powers(routing.x, "length"), "y": powers(routing.y, "length")}
    if isinstance(routing, PolarPolynomial):
        return {
            "kind": "polar_polynomial",
            "radius": powers(routing.radius, "length"),
            "angle": powers(routing.angle, "angle"),
        }
    if isinstance(routing, Spline):
        points = [write_vector(point, "length") for point in routing.points]
        return {"kind": "spline", "sigma": write_vector(routing.sigma, "length"), "points": points}
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
    return {"from": write(start, "length"), "routing": _routing(routing, f"{place}.parts[{k}].routing")}


def _load(load: Load) -> dict[str, Any]:
    if isinstance(load, Gravity):
        return {"kind": "gravity", "acceleration": write_vector(load.acceleration, "acceleration")}
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
    return {key: write_vector(value, kind) for key, (value, kind) in wrench.items() if value != ZERO}


def _places(load: PointLoad | DistributedLoad, **defaults: float | None) -> dict[str, str]:
    values = {key: getattr(load, key) for key in defaults}
    return {key: write(value, "length") for key, value in values.items() if value != defaults[key]}


def _axes(load: PointLoad | DistributedLoad) -> dict[str, str]:
    return {} if load.axes == "world" else {"axes": load.axes}
