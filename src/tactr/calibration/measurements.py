"""What was measured: actuation and points, a row for each pose of the robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check

ACTUATION = ("displacement", "tension", "rotation", "translation")


@dataclass(frozen=True)
class Remark:
    """Something to know of data or of a result: kind, one of a few words for programs, and text."""

    kind: str
    text: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.text}"


@dataclass(frozen=True, eq=False, repr=False)
class Measurements:
    """Measured poses, n rows in the order of time.

    points: (n, k, 3) m in the sensor's axes, NaN where a point was not seen. places: where on the robot, k
    of them: s in m from the guide's exit, ascending, or None for the tip, the last. displacement (m), tension
    (N), rotation (rad), translation (m): from the names of tendons or tubes to (n,) numbers; what is not
    measured stays as the robot has it. time: (n,) s. group: a text for each row, such as the motion it
    belongs to. lines: (n,) of the rows in their file. remarks: what reading them found. Raises RobotError.
    """

    points: np.ndarray
    _: KW_ONLY
    places: tuple[float | None, ...] = (None,)
    displacement: Mapping[str, np.ndarray] = field(default_factory=dict)
    tension: Mapping[str, np.ndarray] = field(default_factory=dict)
    rotation: Mapping[str, np.ndarray] = field(default_factory=dict)
    translation: Mapping[str, np.ndarray] = field(default_factory=dict)
    time: np.ndarray | None = None
    group: tuple[str, ...] | None = None
    lines: np.ndarray | None = None
    source: str = ""
    remarks: tuple[Remark, ...] = ()

    def __post_init__(self) -> None:
        points = np.asarray(self.points, dtype=float)
        if points.ndim == 2 and len(self.places) == 1:
            points = points[:, None, :]
        if points.ndim != 3 or points.shape[1:] != (len(self.places), 3) or not len(points):
            expected = f"an array (rows, {len(self.places)}, 3) in m, at least one row"
            raise RobotError("points", f"an array {points.shape}", expected)
        if not seen(points).all():
            row = int(np.argmin(seen(points)))
            raise RobotError(f"points[{row}]", "no point of the row was seen", "a row with a measured point")
        check.store(self, points=points, places=_places(self.places))
        for kind in ACTUATION:
            check.store(self, **{kind: _columns(kind, getattr(self, kind), len(points))})
        if self.group is not None and len(self.group) != len(points):
            raise RobotError("group", f"{len(self.group)} texts", f"one for each of the {len(points)} rows")

    @classmethod
    def read(cls, path: str | Path, *, columns: str | Path | Mapping[str, str] | None = None) -> Measurements:
        """From a CSV file (UTF-8; commas, semicolons or tabs). Columns are called by quantity and unit:

        "displacement.NAME [mm]", "tension.NAME [N]", "rotation.NAME [deg]", "translation.NAME [mm]",
        "tip.x [mm]" (and y, z), "at 120 mm.x [mm]" (a point at s = 120 mm), "time [s]", "group". Lines that
        start with # are skipped. columns: for files that call them otherwise, a mapping from such quantities
        to "their column [unit]", or a YAML file that holds one; columns that it does not name are left out.
        Rows with missing numbers are left out, with a remark. Raises FileError with line and column.
        """
        from tactr.calibration.read_csv import read_measurements

        return read_measurements(Path(path), columns)

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        pulled = [f"{len(getattr(self, kind))} {kind}s" for kind in ACTUATION if getattr(self, kind)]
        what = ", ".join([f"{len(self.places)} points" if len(self.places) > 1 else "tips", *pulled])
        return f"<Measurements: {len(self)} rows of {what}{f' from {self.source}' if self.source else ''}>"

    def rows(self, chosen: Sequence[int] | np.ndarray | slice) -> Measurements:
        """Some of the rows: indices, a mask, or a slice."""
        index = np.arange(len(self))[chosen]
        kinds = {kind: {name: v[index] for name, v in getattr(self, kind).items()} for kind in ACTUATION}
        return Measurements(
            self.points[index],
            places=self.places,
            **kinds,
            time=None if self.time is None else self.time[index],
            group=None if self.group is None else tuple(self.group[i] for i in index),
            lines=None if self.lines is None else self.lines[index],
            source=self.source,
            remarks=self.remarks,
        )

    def row_name(self, row: int) -> str:
        """How to speak of a row: by its line in the file where that is known."""
        return f"row {row}" if self.lines is None else f"line {self.lines[row]}"


def seen(points: np.ndarray) -> np.ndarray:
    """Whether any point of a row was seen, (n,), from (n, k, 3) with NaN for what was not."""
    return np.any(np.all(np.isfinite(points), axis=2), axis=1)


def _places(places: Sequence[float | None]) -> tuple[float | None, ...]:
    inside = check.numbers("places", [place for place in places if place is not None], "m", least=0)
    check.increasing("places", inside, "m")
    if list(places) != [*inside, *([None] if None in places else [])]:
        raise RobotError("places", f"{places!r}", "ascending s in m, then None for the tip, at most once")
    if 0.0 in inside:
        raise RobotError("places", "0 m is the guide's exit, which nothing moves", "places above 0 m")
    return tuple(places)


def _columns(kind: str, given: Mapping[str, np.ndarray], rows: int) -> dict[str, np.ndarray]:
    columns = {}
    for name, values in given.items():
        column = np.asarray(values, dtype=float)
        if column.shape != (rows,) or not np.isfinite(column).all():
            found = f"shape {column.shape}" if column.shape != (rows,) else "not all are finite"
            raise RobotError(f"{kind}.{name}", found, f"{rows} finite numbers, one for each row")
        columns[str(name)] = column
    return columns
