"""A shape as a labelled dataset, and as a netCDF-4 file.

Tubes and tendons have different numbers of stations. They are stored one after the other (the "contiguous
ragged array" of the CF conventions, no filling values): `tube_index` says to which tube each entry of the
dimension `tube_station` belongs.
"""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import FileError, MissingExtra, NotConverged, RobotError
from tactr.io.results_mechanics import add_mechanics, variable

if TYPE_CHECKING:
    import xarray

    from tactr.statics import Shape

_TUBE_FIELDS = {
    "s": ("m", "arc length from the guide's exit"),
    "sigma": ("m", "arc length of the tube"),
    "position": ("m", "centreline, world axes"),
    "psi": ("rad", "angle of the tube's material frame from the twist-free frame"),
    "u": ("1/m", "curvature and twist, tube's own frame"),
    "v": ("1", "shear and stretch, tube's own frame"),
    "n": ("N", "internal force, tube's own frame"),
    "m": ("N m", "internal moment, tube's own frame"),
}


def to_xarray(shape: Shape) -> xarray.Dataset:
    """Everything in a shape as an xarray Dataset with units, SI, world axes unless said otherwise.

    The attributes tell how the solve ended and hold the robot as the text of a robot file. Raises
    NotConverged where there is no shape, MissingExtra without xarray.
    """
    xr = imported("xarray")
    variables: dict[str, Any] = {}
    _add_robot(variables, shape)
    _add_tubes(variables, shape)
    add_mechanics(variables, shape)
    if shape.tendons:
        _add_tendons(variables, shape)
    coordinates = {
        "axis": ("axis", ["x", "y", "z"]),
        "component": ("component", ["w", "x", "y", "z"]),
        "tube": ("tube", [tube.name for tube in shape.robot.tubes]),
    }
    if shape.tendons:
        coordinates["tendon"] = ("tendon", [tendon.name for tendon in shape.robot.tendons])
    return xr.Dataset(variables, coordinates, _attributes(shape))


def save(shape: Shape, path: str | os.PathLike[str]) -> None:
    """Write `to_xarray(shape)` to a netCDF-4 file, which xarray, MATLAB's h5read and any HDF5 reader open.

    Raises FileError where the file cannot be written, NotConverged where there is no shape, MissingExtra
    without the extra netcdf.
    """
    imported("h5netcdf")
    write(to_xarray(shape), path)


def write(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset to a netCDF-4 file. Raises FileError."""
    try:
        dataset.to_netcdf(path, engine="h5netcdf")
    except OSError as error:
        raise FileError(f"cannot be written: {error.strerror or error}", path=path) from None


def imported(module: str) -> Any:
    """A module of the extra netcdf. Raises MissingExtra."""
    from importlib import import_module

    try:
        return import_module(module)
    except ImportError:
        raise MissingExtra(module, "netcdf", "a dataset of results") from None


def _add_robot(variables: dict[str, Any], shape: Shape) -> None:
    points, places = shape.transition_points
    variables["s"] = variable("station", shape.s, "m", "arc length from the guide's exit")
    variables["centreline"] = variable("station axis", shape.centreline, "m", "centreline")
    variables["tip_position"] = variable("axis", shape.tip_position, "m", "position of the tip")
    variables["tip_quaternion"] = variable("component", shape.tip_quaternion, "1", "orientation of the tip")
    variables["transition_s"] = variable(
        "transition", places, "m", "arc length where a tube ends before the robot does"
    )
    variables["transition_point"] = variable(
        "transition axis", points.reshape(-1, 3), "m", "centreline there"
    )


def _add_tubes(variables: dict[str, Any], shape: Shape) -> None:
    counts = [len(tube.s) for tube in shape.tubes]
    index = np.repeat(np.arange(len(counts)), counts)
    variables["tube_index"] = variable("tube_station", index, "1", "tube of each entry, outermost 0")
    for name, (units, text) in _TUBE_FIELDS.items():
        values = np.concatenate([getattr(tube, name) for tube in shape.tubes])
        dims = "tube_station" if values.ndim == 1 else "tube_station axis"
        variables[f"tube_{name}"] = variable(dims, values, units, text)
    frames = np.concatenate([tube.frames for tube in shape.tubes])
    text = "material frame: its columns are the directors d1, d2, d3, world axes"
    variables["tube_frame"] = variable("tube_station axis director", frames, "1", text)


def _add_tendons(variables: dict[str, Any], shape: Shape) -> None:
    tendons = shape.tendons
    index = np.repeat(np.arange(len(tendons)), [len(tendon.s) for tendon in tendons])
    variables["tendon_length"] = variable(
        "tendon", [t.length for t in tendons], "m", "length from the proximal end of its tube"
    )
    variables["tendon_motor_tension"] = variable("tendon", shape.tension, "N", "tension at its motor")
    with suppress(NotConverged):  # no rest state to count from
        text = "pulled by its motor from the rest state, given or that of its tension"
        variables["tendon_displacement"] = variable("tendon", shape.displacement, "m", text)
    for name, values, text in (
        (
            "given",
            [t.displacement is not None for t in tendons],
            "1: pulled by its displacement, 0: by its tension",
        ),
        ("slack", [t.slack for t in tendons], "1: pulled by its displacement, and slack"),
    ):
        variables[f"tendon_{name}"] = variable("tendon", np.array(values, dtype=np.int8), "1", text)
    variables["tendon_index"] = variable("tendon_station", index, "1", "tendon of each entry")
    for name, dims, units, text in (
        ("s", "tendon_station", "m", "arc length from the guide's exit"),
        ("path", "tendon_station axis", "m", "path of the tendon"),
        ("tension", "tendon_station", "N", "tension"),
    ):
        values = np.concatenate([getattr(tendon, name) for tendon in tendons])
        variables[f"tendon_{name}"] = variable(dims, values, units, text)


def _attributes(shape: Shape) -> dict[str, Any]:
    return {
        "title": f"shape of {shape.robot.name or 'a robot'}",
        "source": "tactr",
        "status": shape.status.value,
        "message": shape.message,
        "residual": float(shape.residual),
        "iterations": int(shape.iterations),
        "displacement_error_m": float(shape.displacement_error),
        "discretisation_error_m": float(shape.discretisation_error),
        "solve_time_s": float(shape.solve_time),
        "robot": robot_text(shape),
    }


def robot_text(shape: Shape) -> str:
    """The text of a robot file of a shape's robot, or why there is none."""
    from tactr.io.files import dumps

    try:
        return dumps(shape.robot)
    except RobotError as error:
        return f"# not stored: {error}\n"
