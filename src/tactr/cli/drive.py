"""The command `drive`."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tactr.cli.inputs import UsageError, read_length, read_robot
from tactr.cli.progress import progress_bar
from tactr.cli.solve import PICTURES, check_target
from tactr.errors import RobotError

if TYPE_CHECKING:
    from tactr.friction import Driven, DriveState

CREPT = 0.3e-3  # m, about the elastic stretch of a tendon: beyond, docs/friction.md says not to trust a loop


@dataclass(frozen=True)
class Request:
    """What the command line asks for, as it was typed."""

    file: str
    path: Path
    tolerance: str | None
    state: Path | None
    save: Path | None
    save_state: Path | None
    plot: Path | None


def run_drive(request: Request) -> int:
    """Drive, save, plot and report. Returns the exit code: 2 where a point was not reached."""
    check_target("save", request.save, (".nc",))
    check_target("save-state", request.save_state, (".json",))
    check_target("plot", request.plot, PICTURES)
    robot = read_robot(request.file)
    from tactr.friction import drive
    from tactr.io.read_path import read_path

    points, lines = read_path(request.path, robot)
    state = None if request.state is None else _read_state(request.state)
    options = {}
    if request.tolerance is not None:
        options["tolerance"] = read_length("tolerance", request.tolerance)
    with progress_bar("driving") as bar:
        driven = drive(robot, points, state=state, progress=bar, **options)
    good = next((k for k, text in enumerate(driven.failed) if text), len(driven))
    if good:
        _show(driven.before(good), request)
    if good == len(driven):
        return 0
    found = f"point {good + 1} (line {lines[good]}) of {len(points)}: {driven.failed[good]}"
    kept = f"the {good} before it are kept" if good else "nothing was found before it"
    print(f"tactr: {found}; {kept}", file=sys.stderr)
    return 2


def _read_state(path: Path) -> DriveState:
    from tactr.friction import DriveState

    try:
        return DriveState.from_dict(json.loads(path.read_text(encoding="utf-8")))
    except OSError as error:
        raise UsageError(f"--state: {path}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:  # of JSON, of its encoding, or of what is in it
        what = error.problem if isinstance(error, RobotError) else str(error)
        raise UsageError(f"--state: {path}: {what}; expected a file that --save-state wrote") from None


def _show(driven: Driven, request: Request) -> None:
    print(_summary(driven))
    try:
        if request.save is not None:
            driven.save(request.save)
        if request.save_state is not None:
            request.save_state.write_text(json.dumps(driven.state.to_dict()) + "\n", encoding="utf-8")
        if request.plot is not None:
            driven.plot(request.plot)
    except OSError as error:
        raise UsageError(f"{error.filename}: cannot be written: {error.strerror or error}") from None
    for path in (request.save, request.save_state, request.plot):
        if path is not None:
            print(f"wrote {path}")


def _summary(driven: Driven) -> str:
    robot = driven[0].robot
    apart = 1e3 * np.linalg.norm(driven.tips - driven.frictionless_tips(), axis=1)
    x, y, z = 1e3 * driven.tips[-1] + 0.0
    heat = 1e3 * float(driven.heat.sum() + driven.tube_heat.sum())
    lines = [
        f"{robot.name or 'robot'}: {len(driven)} points in {sum(driven.steps)} steps",
        f"tip at the end ({x:.3f}, {y:.3f}, {z:.3f}) mm",
        f"friction and backlash move it by up to {np.nanmax(apart):.3g} mm, in mean {np.nanmean(apart):.3g}",
        f"heat of friction {heat:.3g} mJ",
    ]
    for tendon, creep in zip(robot.tendons, driven.creep.max(axis=0), strict=True):
        if creep > CREPT:
            what = f"is dragged through its channel by up to {1e3 * creep:.2g} mm while its own tension stays"
            lines.append(f"warning: tendon {tendon.name} {what}: the loop is not to be trusted there")
    unstable = sum(not driven.stable(k) for k in range(len(driven)))
    if unstable:
        lines.append(f"warning: {unstable} shapes are unstable at these tensions")
    return "\n".join(lines)
