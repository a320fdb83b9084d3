"""The command `calibrate`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tactr.cli.inputs import UsageError, read_length, read_robot
from tactr.cli.progress import progress_bar
from tactr.cli.solve import PICTURES, check_target

if TYPE_CHECKING:
    from tactr.calibration import Calibration, Frame, Parameter
    from tactr.robot import Robot

ROBOT_FILES = (".yaml", ".yml", ".toml")


@dataclass(frozen=True)
class Request:
    """What the command line asks for, as it was typed."""

    file: str
    data: Path
    free: Sequence[str]
    common: Sequence[str]
    set: Sequence[str]
    bounds: Sequence[str]
    prior: Sequence[str]
    columns: Path | None
    noise: str | None
    loss: str
    starts: int
    folds: str | None
    history: bool
    json: bool
    save: Path | None
    plot: Path | None


def run_calibrate(request: Request) -> int:
    """Calibrate, save, plot and report. Returns the exit code."""
    check_target("save", request.save, ROBOT_FILES)
    check_target("plot", request.plot, PICTURES)
    robot = read_robot(request.file)
    from tactr.calibration import Measurements, calibrate

    robot, frame, starts = _set(robot, request.set)
    data = Measurements.read(request.data, columns=request.columns)
    parameters = _parameters(request, robot, starts)
    with progress_bar("reading", time_left=False) as bar:  # passes: nobody knows how many

        def show(name: str, row: int, rows: int) -> None:
            if bar is not None:
                bar(row + 1, rows, name)

        result = calibrate(
            robot,
            data,
            parameters=parameters,
            frame=frame,
            noise=None if request.noise is None else read_length("noise", request.noise),
            loss=request.loss,  # pyright: ignore[reportArgumentType]
            starts=request.starts,
            folds=_folds(request.folds),
            history=request.history,
            progress=show,
        )
    _write(result, request)
    return 0


def _parameters(request: Request, robot: Robot, starts: dict[str, float]) -> list[Parameter]:
    from tactr.calibration import Parameter

    parameters = [Parameter(path) for path in request.free]
    parameters += [Parameter(path, common=True) for path in request.common]
    for option in ("bounds", "prior"):
        for path, (first, second) in _pairs(option, robot, getattr(request, option)).items():
            places = [k for k, parameter in enumerate(parameters) if parameter.path == path]
            if not places:
                raise UsageError(
                    f"--{option}: {path!r} is not free; give it to --free or --common, written alike"
                )
            changes: dict[str, Any] = {"prior": (first, second)}
            if option == "bounds":
                changes = {"lower": first, "upper": second}
            parameters[places[0]] = replace(parameters[places[0]], **changes)
    return [
        replace(parameter, start=starts[parameter.path]) if parameter.path in starts else parameter
        for parameter in parameters
    ]


def _set(robot: Robot, words: Sequence[str]) -> tuple[Robot, Frame, dict[str, float]]:
    """The robot and the frame with the numbers that were set, and where zeros start."""
    from tactr.calibration import Frame
    from tactr.calibration.parameters import FRAME, ZERO, known_paths, vector_of
    from tactr.statics.parameters import with_value

    frame: dict[str, list[float]] = {name: [0.0] * 3 for name in ("marker", "position", "rotation")}
    starts: dict[str, float] = {}
    names = [tendon.name for tendon in robot.tendons]
    for word in words:
        path, sign, text = word.rpartition("=")
        if not sign:
            raise UsageError(f'--set: {word!r}; expected PATH=VALUE, such as marker.z="8 mm"')
        path = path.strip()
        fitting = [known for known in known_paths(robot, names) if fnmatchcase(known, path)]
        if not fitting:
            raise UsageError(f"--set: nothing of the robot is called {path!r}")
        for each in fitting:
            value = _value("set", robot, each, text)
            if each in FRAME:
                frame[vector_of(each)]["xyz".index(each[-1])] = value
            elif each.endswith(f".{ZERO}"):
                starts[each] = value
            else:
                robot = with_value(robot, each, value)
    return robot, Frame(**frame), starts  # pyright: ignore[reportArgumentType]


def _pairs(option: str, robot: Robot, words: Sequence[str]) -> dict[str, tuple[float, float]]:
    pairs = {}
    for word in words:
        path, sign, text = word.rpartition("=")
        parts = text.split(",")
        if not sign or len(parts) != 2:
            raise UsageError(
                f'--{option}: {word!r}; expected PATH="A, B", such as tubes.outer.E="40 GPa, 80 GPa"'
            )
        first, second = (_value(option, robot, path.strip(), part) for part in parts)
        pairs[path.strip()] = (first, second)
    return pairs


def _value(option: str, robot: Robot, path: str, text: str) -> float:
    from tactr.io.path_kinds import kind_of
    from tactr.io.units import UnitError, parse_quantity

    try:
        return parse_quantity(text.strip(), kind_of(robot, path))
    except UnitError as error:
        raise UsageError(f"--{option}: {path}: {error}") from None


def _folds(text: str | None) -> Any:
    if text is None or text == "group":
        return text
    if not text.isdigit():
        raise UsageError(f'--folds: {text!r}; expected a number of blocks, such as 5, or "group"')
    return int(text)


def _write(result: Calibration, request: Request) -> None:
    from tactr.io import save

    written = []
    if request.save is not None:
        save(result.robot, request.save)
        written.append(request.save)
    if request.plot is not None:
        result.plot(request.plot)
        written.append(request.plot)
    if request.json:
        import json

        print(json.dumps(result.to_dict(), indent=2, ensure_ascii=False))
        return
    print(result)
    for path in written:
        print(f"wrote {path}")
    if request.save is not None and (settings := _frame_settings(result.frame)):
        print(f"marker and sensor are not in it; to judge other data with it: --set {settings}")


def _frame_settings(frame: Frame) -> str:
    """What --set takes to put marker and sensor where they were found; empty where they are at home."""
    from tactr.calibration.parameters import FRAME, vector_of

    parts = []
    for path in FRAME:
        value = getattr(frame, vector_of(path))["xyz".index(path[-1])]
        factor, unit = (math.degrees(1.0), "deg") if path.startswith("sensor.r") else (1e3, "mm")
        if value:
            parts.append(f'{path}="{value * factor:.6g} {unit}"')
    return " ".join(parts)
