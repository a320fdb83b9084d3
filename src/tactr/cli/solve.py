"""The command `solve`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tactr.cli.inputs import UsageError, read_assignments, read_length, read_robot, read_vectors

if TYPE_CHECKING:
    from tactr.robot import Robot

PICTURES = (".png", ".pdf", ".svg", ".jpg")


@dataclass(frozen=True)
class Request:
    """What the command line asks for, as it was typed."""

    file: str
    tension: Sequence[str]
    rotation: Sequence[str]
    translation: Sequence[str]
    displacement: Sequence[str]
    force: Sequence[str]
    moment: Sequence[str]
    tolerance: str | None
    json: bool
    save: Path | None
    plot: Path | None


def run_solve(request: Request) -> int:
    """Solve, save, plot and report. Returns the exit code: 2 where the solve did not converge."""
    check_target("save", request.save, (".nc",))
    check_target("plot", request.plot, PICTURES)
    robot = read_robot(request.file).with_actuation(
        tension=read_assignments("tension", request.tension, "force", bare="N"),
        rotation=read_assignments("rotation", request.rotation, "angle"),
        translation=read_assignments("translation", request.translation, "length"),
        displacement=read_assignments("displacement", request.displacement, "length"),
    )
    robot = _loaded(robot, request)
    from tactr.statics import solve

    options: dict[str, Any] = {}
    if request.tolerance is not None:
        options["tolerance"] = read_length("tolerance", request.tolerance)
    shape = solve(robot, **options)
    if shape.converged:
        _write(shape, request)
    return _show(shape, request)


def _loaded(robot: Robot, request: Request) -> Robot:
    """The robot with the forces and moments at the tips of tubes that were typed, beside its own loads."""
    from tactr.robot import PointLoad

    forces = read_vectors("force", request.force, "force", bare="N")
    moments = read_vectors("moment", request.moment, "moment", bare="N m")
    nothing = (0.0, 0.0, 0.0)
    tips = [
        PointLoad(tube, force=forces.get(tube, nothing), moment=moments.get(tube, nothing))
        for tube in dict.fromkeys([*forces, *moments])
    ]
    return robot.replace(loads=(*robot.loads, *tips)) if tips else robot


def check_target(option: str, path: Path | None, endings: tuple[str, ...]) -> None:
    """Refuse a file to write whose ending or folder cannot be. Raises UsageError."""
    if path is None:
        return
    if path.suffix.lower() not in endings:
        raise UsageError(
            f"--{option}: {path} has the ending {path.suffix!r}; expected one of {', '.join(endings)}"
        )
    if not path.parent.is_dir():
        raise UsageError(f"--{option}: there is no folder {path.parent}")


def _write(shape: Any, request: Request) -> None:
    try:
        if request.save is not None:
            shape.save(request.save)
        if request.plot is not None:
            shape.plot(request.plot)
    except OSError as error:
        raise UsageError(
            f"{error.filename or request.save or request.plot}: cannot be written: {error.strerror or error}"
        ) from None


def _show(shape: Any, request: Request) -> int:
    if request.json:
        from tactr.cli.json_report import json_report

        print(json_report(shape))
    elif shape.converged:
        from tactr.cli.report import print_report

        print_report(shape, [path for path in (request.save, request.plot) if path is not None])
    if not shape.converged:
        print(f"tactr: {shape.message}", file=sys.stderr)
        return 2
    return 0
