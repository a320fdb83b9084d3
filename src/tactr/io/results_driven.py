"""What ``tactr.drive`` found as a labelled dataset, and as a netCDF-4 file."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.io.results import imported, robot_text, write
from tactr.io.results_mechanics import variable
from tactr.statics.assemble import tendon_end

if TYPE_CHECKING:
    import xarray

    from tactr.friction import Driven

SHARES = np.linspace(0.0, 1.0, 41)


def driven_to_xarray(driven: Driven) -> xarray.Dataset:
    """Tips, shapes, tensions and states along a path as an xarray Dataset with units, SI, world axes.

    NaN where a point has no shape. ``state`` holds each state as JSON, which ``DriveState.from_dict`` takes.
    Raises MissingExtra without xarray.
    """
    xr = imported("xarray")
    robot = driven[0].robot
    variables: dict[str, Any] = {}
    _add_shapes(variables, driven)
    _add_given(variables, driven)
    _add_history(variables, driven)
    coordinates: dict[str, Any] = {
        "axis": ("axis", ["x", "y", "z"]),
        "component": ("component", ["w", "x", "y", "z"]),
        "tube": ("tube", [tube.name for tube in robot.tubes]),
        "share": ("share", SHARES),
    }
    if robot.tendons:
        coordinates["tendon"] = ("tendon", [tendon.name for tendon in robot.tendons])
    attributes = {
        "title": f"{robot.name or 'a robot'} driven along {len(driven)} points",
        "source": "tactr",
        "message": driven.message,
        "robot": robot_text(driven[0]),
    }
    return xr.Dataset(variables, coordinates, attributes)


def save_driven(driven: Driven, path: str | os.PathLike[str]) -> None:
    """Write `driven_to_xarray(driven)` to a netCDF-4 file. Raises FileError, MissingExtra without netcdf."""
    imported("h5netcdf")
    write(driven_to_xarray(driven), path)


def _add_shapes(variables: dict[str, Any], driven: Driven) -> None:
    good = [shape.converged for shape in driven]
    stations = next((len(shape.s) for shape in driven if shape.converged), 0)

    def rows(name: str, *dims: int) -> np.ndarray:
        return np.array([getattr(s, name) if s.converged else np.full(dims, np.nan) for s in driven])

    variables["converged"] = variable("point", np.array([not text for text in driven.failed], np.int8), "1",
                                      "1: shape and friction settled at this point")  # fmt: skip
    variables["has_shape"] = variable("point", np.array(good, np.int8), "1", "1: there is a shape")
    variables["tip_position"] = variable("point axis", driven.tips, "m", "position of the tip")
    variables["tip_quaternion"] = variable(
        "point component", rows("tip_quaternion", 4), "1", "orientation of the tip"
    )
    text = "arc length from the guide's exit"
    variables["s"] = variable("point station", rows("s", stations), "m", text)
    variables["centreline"] = variable("point station axis", rows("centreline", stations, 3), "m", "shape")


def _add_given(variables: dict[str, Any], driven: Driven) -> None:
    for name, dims, units in (
        ("tension", "point tendon", "N"),
        ("displacement", "point tendon", "m"),
        ("rotation", "point tube", "rad"),
        ("translation", "point tube", "m"),
    ):
        if dims.endswith("tendon") and not driven[0].robot.tendons:
            continue
        for which in ("given", "passed"):
            values = [getattr(getattr(state, which) or state.passed, name) for state in driven.states]
            text = f"{name} {'given to' if which == 'given' else 'passed on by'} the actuator"
            variables[f"{which}_{name}"] = variable(dims, values, units, text)


def _add_history(variables: dict[str, Any], driven: Driven) -> None:
    robot = driven[0].robot
    variables["steps"] = variable("point", driven.steps, "1", "steps into which the way was cut")
    states = np.array([json.dumps(state.to_dict()) for state in driven.states], dtype=object)
    variables["state"] = variable("point", states, "1", "what the robot remembers, JSON")
    text = "taken by friction between this tube and the next outer one since the point before"
    variables["tube_heat"] = variable("point tube", driven.tube_heat, "J", text)
    if not robot.tendons:
        return
    text = "taken by friction of the tendon since the point before"
    variables["tendon_heat"] = variable("point tendon", driven.heat, "J", text)
    text = "dragged at most, at a place, from where it last slid itself (docs/friction.md)"
    variables["tendon_creep"] = variable("point tendon", driven.creep, "m", text)
    variables["motor_tension"] = variable("point tendon", driven.tensions, "N", "tension at the motor")
    variables["tendon_tension"] = variable(
        "point tendon share", _along(driven), "N", "tension along the tendon, by the share of its length"
    )


def _along(driven: Driven) -> np.ndarray:
    robot = driven[0].robot
    found = np.repeat(driven.tensions[:, :, None], len(SHARES), axis=2)
    for j, tendon in enumerate(robot.tendons):
        sigma = SHARES * tendon_end(robot, tendon)
        for k, state in enumerate(driven.states):
            if state.profiles[j] is not None and driven[k].converged:
                found[k, j] = state.tension(tendon.name, sigma)
    return found
