"""From the data of a tube in a robot file to a Tube."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, TypeVar

from tactr.errors import RobotError
from tactr.io.fields import suggestion
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
    TubeLimits,
    VaryingStiffness,
)

T = TypeVar("T")


def under(prefix: str, make: Callable[[], T]) -> T:
    """What ``make`` makes, its errors with ``prefix`` before their field."""
    try:
        return make()
    except RobotError as error:
        raise error.under(prefix) from None


PLAIN = (
    "name",
    "length",
    "translation",
    "rotation",
    "rotation_compliance",
    "translation_compliance",
    "rotation_play",
    "translation_play",
)


def build_tube(data: dict[str, Any]) -> Tube:
    """The tube. Raises RobotError with the field as the file names it."""
    values = {key: data[key] for key in PLAIN if key in data}
    if "sections" in data:
        values["section"] = [
            (piece["from"], under(f"sections[{k}]", lambda piece=piece: _section(piece)))
            for k, piece in enumerate(data["sections"])
        ]
    else:
        values["section"] = _section(data)
    if "material" in data:
        values["material"] = _materials(data["material"])
    if "precurvature" in data:
        values["precurvature"] = _rest(data["precurvature"])
    if "limits" in data:
        values["limits"] = under("limits", lambda: TubeLimits(**data["limits"]))
    if "friction" in data:
        given = data["friction"]
        friction = under("friction", lambda: TubeFriction(**given)) if isinstance(given, dict) else given
        values["friction"] = friction
    try:
        return Tube(**values)
    except RobotError as error:
        if error.field == "section" and "sections" in data:
            raise RobotError("sections", error.problem, error.expected, value=error.value) from None
        raise _in_file(error) from None


def _in_file(error: RobotError) -> RobotError:
    """An error of a Tube with the field as the file names it."""
    found = re.fullmatch(r"(section|material)(?:\[(\d+)\])?(?:\[([01])\])?\.?(.*)", error.field)
    if not found:
        return error
    name, piece, member, rest = found.groups()
    if name == "material":
        key = {"0": "from", "1": "material"}.get(member or "", "")
    else:
        key = "from" if member == "0" else f"stiffness.{rest}" if rest else ""
    if piece is not None:
        name = f"{'sections' if name == 'section' else name}[{piece}]"
    elif name == "section" and key:
        return RobotError(key, error.problem, error.expected, value=error.value)
    return RobotError(f"{name}.{key}".rstrip("."), error.problem, error.expected, value=error.value)


def _section(data: dict[str, Any]) -> Section:
    diameters = {key: data[key] for key in ("outer_diameter", "inner_diameter") if key in data}
    if "stiffness" in data:
        return _stiffness(data["stiffness"], diameters)
    if "diameter" in data:
        return Rod(data["diameter"])
    if "notches" in data:
        return _notches(data["notches"], diameters)
    return Annulus(**diameters)


def _notches(data: dict[str, Any], diameters: dict[str, float]) -> Section:
    values = {key: value for key, value in data.items() if key != "kind"}
    try:
        if data["kind"] == "symmetric":
            return SymmetricNotches(**diameters, **values)
        return AsymmetricNotches(**diameters, **values, staggered=data["kind"] == "staggered")
    except RobotError as error:
        raise (error.under("notches") if error.field in values else error) from None


def _stiffness(data: dict[str, Any], diameters: dict[str, float]) -> Section:
    values = {key: _along(f"stiffness.{key}", data[key]) for key in data.keys() - {"neutral_axis"}}
    axis = _alongs("stiffness.neutral_axis", data.get("neutral_axis", (0.0, 0.0)))
    try:
        varying = any(isinstance(q, Along) for q in (*values.values(), *axis))
        kind = VaryingStiffness if varying else Stiffness
        return kind(**values, **diameters, neutral_axis=axis)
    except RobotError as error:
        inside = error.field.partition("[")[0] in (*values, "neutral_axis")
        raise (error.under("stiffness") if inside else error) from None


def _alongs(field: str, data: tuple[Any, ...]) -> Any:
    return tuple(_along(f"{field}[{k}]", value) for k, value in enumerate(data))


def _along(field: str, data: Any) -> Any:
    """A quantity, as a number or an Along."""
    if not isinstance(data, dict):
        return data
    if "parts" in data:
        pairs = [(part["from"], part["coefficients"]) for part in data["parts"]]
        ends = {"end": data["end"]} if "end" in data else {}
        try:
            return Along(pairs, **ends)
        except RobotError as error:
            named = re.sub(r"^(parts\[\d+\])\[0\]", r"\1.from", error.field)
            named = re.sub(r"^(parts\[\d+\])\[1\]", r"\1.coefficients", named)
            raise RobotError(f"{field}.{named}", error.problem, error.expected, value=error.value) from None
    join = Along.spline if data.get("joined") == "smooth" else Along.linear
    return under(field, lambda: join(data["sigma"], data["values"]))


def _rest(data: Any) -> Any:
    if not isinstance(data, dict):
        return tuple((piece["from"], piece["u"]) for piece in data) if isinstance(data[0], dict) else data
    values = {key: value for key, value in data.items() if key != "kind"}
    if data["kind"] == "strains":
        values = {key: _alongs(f"precurvature.{key}", value) for key, value in values.items()}
    makers = {"helix": RestShape.helix, "points": RestShape.from_points, "strains": RestShape}
    return under("precurvature", lambda: makers[data["kind"]](**values))


def _materials(data: Any) -> Any:
    if not isinstance(data, tuple):
        return _material(data, "material")
    return [
        (piece["from"], _material(piece["material"], f"material[{k}].material"))
        for k, piece in enumerate(data)
    ]


def _material(data: str | dict[str, Any], field: str) -> Material:
    if isinstance(data, dict):
        return under(field, lambda: Material(**data))
    from tactr.materials import PRESETS

    if data not in PRESETS:
        near = suggestion(data, tuple(PRESETS))
        raise RobotError(
            field,
            f'"{data}" is not known{near}',
            f"one of {', '.join(PRESETS)}, or a mapping with E and G or nu",
        )
    return PRESETS[data]
