"""What rows must be for their history to tell friction and backlash: errors, and what to know of them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tactr.calibration.hold_out import Folds
from tactr.calibration.measurements import Measurements, Remark
from tactr.calibration.parameters import Free
from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.statics.status import told_of_history

REMEMBERED = re.compile(
    r"(tubes|tendons)\..+?\.(friction(\.\w+)*|contacts\.\d+|play|rotation_play|translation_play"
    r"|translation_compliance)"
)
MOVED_BY = {"play": "displacement", "rotation_play": "rotation", "translation_play": "translation"}


def without_history(robot: Robot, frees: Sequence[Free]) -> list[Remark]:
    """Raise RobotError where a number is free that rows taken one by one cannot tell; what they leave out."""
    for path in (path for free in frees for path in free.paths):
        if REMEMBERED.fullmatch(path):
            found = "it shows where rows are driven along in their order only, and they are taken one by one"
            raise RobotError(path, found, "history=True, on the command line --history", value=path)
    left_out = told_of_history(robot, driven=False).removeprefix("; ")
    return [Remark("no-history", f"rows are taken one by one, {left_out}")] if left_out else []


def with_history(data: Measurements, frees: Sequence[Free], folds: Folds | None) -> list[Remark]:
    """Raise RobotError where rows are no path in time, or do not move what is to be found."""
    if folds is not None:
        found = "rows that are held out would be missing from the path"
        raise RobotError("folds", found, "no folds with history; judge other recordings by errors()")
    _check_order(data)
    for path in (path for free in frees for path in free.paths):
        name, _, word = path.partition(".")[2].rpartition(".")
        kind = MOVED_BY.get(word)
        if kind is not None and name not in getattr(data, kind):
            found = f"backlash acts on a {kind}, which is not measured"
            raise RobotError(path, found, f'a column "{kind}.{name}"', value=path)
    lost = [remark.text for remark in data.remarks if remark.kind == "missing-numbers"]
    text = "the path goes straight across rows that are left out: turning points among them are lost"
    return [Remark("broken-path", text)] if lost else []


def _check_order(data: Measurements) -> None:
    if data.time is None:
        return
    back = np.flatnonzero(~(np.diff(data.time) >= 0.0))
    if len(back):
        i = int(back[0])
        found = f"{data.time[i + 1]:g} s in {data.row_name(i + 1)} after {data.time[i]:g} s before it"
        raise RobotError("time", found, "rows in the order of time", value=data.time)
