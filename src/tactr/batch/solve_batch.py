"""Solve many configurations or designs: arrays in, arrays out, on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tactr import _core
from tactr.batch.cuda import cuda_door
from tactr.batch.designs import Design, designs_of, fitting
from tactr.batch.items import Given, Items, items_of
from tactr.batch.pulled import fill_from
from tactr.batch.result import CODE, INVALID, Batch
from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot import _check as check
from tactr.statics.assemble import assemble
from tactr.statics.derivatives import Jacobian
from tactr.statics.held import MOST_STEPS
from tactr.statics.solve import Prepared
from tactr.statics.stations import Stations
from tactr.statics.status import _BY_CODE, KINK, Status

OUTPUTS = ("tip", "shape", "jacobian", "compliance", "stability", "energy", "strain")
ALONG = ("shape", "strain")  # read at stations
ROUNDING = 1e-12  # of a station beyond the end, relative


def solve_batch(
    robot: Robot,
    *,
    tension: Given = None,
    displacement: Given = None,
    rotation: Given = None,
    translation: Given = None,
    parameters: Mapping[str, Any] | None = None,
    outputs: Sequence[str] = ("tip",),
    stations: Stations = 101,
    tolerance: float = 1e-6,
    threads: int | None = None,
    device: str = "cpu",
) -> Batch:
    """Solves k configurations of a robot from cold, each as ``tactr.solve`` would, on all cores.

    tension: N, displacement: m, rotation: rad, translation: m, as in ``tactr.solve``; each an array (k,
    tendons or tubes), or a mapping from names to (k,) arrays or numbers, the rest as the robot has it.
    parameters: paths as in ``Shape.sensitivity``, such as "tubes.outer.length", to (k,) arrays or numbers in
    the units of the description: a design study. outputs: of "tip" (always there), "shape", "jacobian",
    "compliance", "stability", "energy", "strain"; see ``Batch``. stations: as in ``tactr.solve``, for "shape"
    and "strain". threads: None for as many as there are cores; results do not depend on it. device: "cuda"
    for a graphics processor, with a warning and on the CPU where there is none.

    Nothing is raised for an item that fails or is invalid: see ``Batch.status``. Items pulled by
    displacements go one by one through the solver behind ``tactr.solve``, on one core. Raises RobotError for
    wrong names, shapes or settings.
    """
    items = items_of(
        robot,
        parameters,
        tension=tension,
        displacement=displacement,
        rotation=rotation,
        translation=translation,
    )
    asked = _outputs(outputs)
    accuracy = check.real("tolerance", tolerance, "m", above=0)
    door = None if check.choice("device", device, ("cpu", "cuda")) == "cpu" else cuda_door()
    job = _Job(items, asked, stations, accuracy)
    return job.run(_threads(threads), door)


class _Job:
    """One batch on its way: designs, rows of actuation, and what is wrong with which item."""

    def __init__(self, items: Items, outputs: tuple[str, ...], stations: Stations, tolerance: float) -> None:
        self.items, self.outputs, self.stations, self.tolerance = items, outputs, stations, tolerance
        self.designs, self.index = designs_of(items, tolerance)
        self.invalid: dict[int, RobotError] = {}
        self.sound = np.array([isinstance(design, Design) for design in self.designs])[self.index]
        for i in np.flatnonzero(~self.sound):
            error = self.designs[self.index[i]]
            assert isinstance(error, RobotError)
            self.invalid[int(i)] = error
        self.usable = [design for design in self.designs if isinstance(design, Design)]

    def run(self, threads: int, door: int | None) -> Batch:
        rows = {field: self._rows(field) for field in ("tension", "rotation", "translation")}
        places, too_short = self._stations(rows["translation"])
        plain = self._plain(rows) & ~too_short
        found = self._solved(rows, places, ~plain, threads, door)
        status = _statuses(found)
        tension = np.where(plain[:, None], rows["tension"] * self._scale(), np.nan)
        found["tension"] = tension
        for i in np.flatnonzero(self.sound & ~plain):
            status[i] = self._alone(int(i), found, places, bool(too_short[i]))
        for i in self.invalid:
            status[i] = CODE[INVALID]
        return self._batch(found, status, places)

    def _of_designs(self, field: str, width: int) -> np.ndarray:
        """A row for every item, NaN where its design is wrong."""
        table = np.full((len(self.designs), width), np.nan)
        for k, design in enumerate(self.designs):
            if isinstance(design, Design):
                table[k] = getattr(design, field)
        return table[self.index]

    def _rows(self, field: str) -> np.ndarray:
        parts = self.items.base.tendons if field in ("tension", "displacement") else self.items.base.tubes
        rows = self._of_designs(field, len(parts))
        for j, part in enumerate(parts):
            if part.name in self.items.actuation[field]:
                rows[:, j] = self.items.actuation[field][part.name]
        return rows

    def _scale(self) -> np.ndarray:
        """NaN for tensions that are profiles, which have no single number."""
        profiled = self._of_designs("profiled", len(self.items.base.tendons)) == 1.0
        return np.where(profiled, np.nan, 1.0)

    def _plain(self, rows: dict[str, np.ndarray]) -> np.ndarray:
        """Which items the kernel can take as they are, (k,)."""
        tendons = self.items.base.tendons
        tension, translation = rows["tension"], rows["translation"]
        least = self._of_designs("least_translation", len(self.items.base.tubes))
        good = self.sound & np.isfinite(rows["rotation"]).all(axis=1)
        good &= (np.isfinite(tension) & (tension >= 0.0)).all(axis=1)
        good &= (np.isfinite(translation) & (translation >= least) & (translation <= 0.0)).all(axis=1)
        good &= fitting(self.designs, self.index, translation)
        pulled = self._of_designs("displacement", len(tendons))
        profiled = self._of_designs("profiled", len(tendons)) == 1.0
        for j, tendon in enumerate(tendons):
            if tendon.name in self.items.actuation["tension"]:
                pulled[:, j] = np.nan
                good &= ~profiled[:, j]
            if tendon.name in self.items.actuation["displacement"]:
                pulled[:, j] = np.where(
                    np.isnan(self.items.actuation["displacement"][tendon.name]), pulled[:, j], 0.0
                )
        return good & np.isnan(pulled).all(axis=1)

    def _stations(self, translation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """s (1 or k, stations) and which items are too short for them, (k,)."""
        none_short = np.zeros(self.items.count, dtype=bool)
        if not set(ALONG) & set(self.outputs) or not self.usable:
            return np.zeros((1, 1)), none_short
        reach = np.max(translation + self._of_designs("length", translation.shape[1]), axis=1)
        reach = np.where(np.isfinite(reach), reach, 0.0)
        if isinstance(self.stations, int | np.integer):
            if isinstance(self.stations, bool) or self.stations < 2:
                raise RobotError("stations", f"{self.stations} stations", "at least 2", value=self.stations)
            return np.linspace(np.zeros(len(reach)), reach, int(self.stations), axis=1), none_short
        expected = "arc lengths in m, ascending, from 0 on"
        try:
            s = np.array(self.stations, dtype=float)
        except (TypeError, ValueError):
            raise RobotError("stations", check.show(self.stations), expected, value=self.stations) from None
        if s.ndim != 1 or s.size == 0 or not np.isfinite(s).all() or (np.diff(s) < 0).any() or s[0] < 0.0:
            raise RobotError("stations", check.show(self.stations), expected, value=self.stations)
        return np.minimum(s, reach[:, None]), s[-1] > reach * (1.0 + ROUNDING)

    def _solved(
        self,
        rows: dict[str, np.ndarray],
        places: np.ndarray,
        skip: np.ndarray,
        threads: int,
        door: int | None,
    ) -> dict[str, np.ndarray]:
        stand_in = self.usable[0].core if self.usable else assemble(self.items.base)
        cores = [design.core if isinstance(design, Design) else stand_in for design in self.designs]
        residual = self._of_designs("residual_tolerance", 1)[:, 0]
        return _core.solve_batch(
            cores if len(cores) == 1 else [cores[k] for k in self.index],
            np.ascontiguousarray(rows["tension"]),
            np.ascontiguousarray(rows["rotation"]),
            np.ascontiguousarray(rows["translation"]),
            np.ascontiguousarray(residual),
            np.ascontiguousarray(skip, dtype=np.uint8),
            np.ascontiguousarray(places),
            self.tolerance,
            MOST_STEPS,
            [name for name in self.outputs if name != "tip"],
            threads,
            "widest" if door is None else "device",
            door or 0,
        )

    def _alone(self, i: int, found: dict[str, np.ndarray], places: np.ndarray, too_short: bool) -> int:
        """Solves one item as ``tactr.solve`` does; its status."""
        design = self.designs[self.index[i]]
        assert isinstance(design, Design)
        try:
            robot = self.items.actuated(i, design.robot)
            if too_short:
                Prepared(robot, stations=self.stations)
            shape = Prepared(robot, tolerance=self.tolerance).solve()
        except RobotError as error:
            self.invalid[i] = error
            return CODE[INVALID]
        fill_from(shape, i, found, places[i] if len(places) == self.items.count else places[0])
        return CODE[shape.status.value]

    def _batch(self, found: dict[str, np.ndarray], status: np.ndarray, places: np.ndarray) -> Batch:
        tendons, tubes = len(self.items.base.tendons), len(self.items.base.tubes)
        jacobian = None
        if "jacobian" in found:
            tension, rotation, translation = np.split(found["jacobian"], [tendons, tendons + tubes], axis=-1)
            pulled = found.get("by_displacement", np.where(np.isnan(tension), np.nan, 0.0))
            jacobian = Jacobian(tension, rotation, translation, pulled)
        return Batch(
            status=status,
            tip_position=found["tip_position"],
            tip_quaternion=found["tip_quaternion"],
            tendon_length=found["tendon_length"],
            tension=found["tension"],
            residual=found["residual"],
            discretisation_error=found["discretisation_error"],
            s=np.array(np.broadcast_to(places, (self.items.count, places.shape[1])))
            if "shape" in found
            else None,
            centreline=found.get("shape"),
            jacobian=jacobian,
            compliance=found.get("compliance"),
            stable=found["stable"].astype(bool) if "stable" in found else None,
            margin=found.get("margin"),
            energy=found.get("energy"),
            strain=found.get("strain"),
            tolerance=self.tolerance,
            _items=self.items,
            _stations=self.stations,
            _invalid=self.invalid,
        )


def _statuses(found: dict[str, np.ndarray]) -> np.ndarray:
    """Codes of a batch from those of the kernel."""
    codes = np.array([CODE[status.value] for status in _BY_CODE], dtype=np.int8)
    status = codes[np.maximum(found["status"], 0)]
    status[found["unstable"] == 1] = CODE[Status.UNSTABLE.value]
    kinked = (status == CODE[Status.NO_SECTION_EQUILIBRIUM.value]) & (found["shortest_tendon"] < KINK)
    status[kinked] = CODE[Status.KINKED.value]
    return status


def _outputs(outputs: Sequence[str]) -> tuple[str, ...]:
    names = (outputs,) if isinstance(outputs, str) else tuple(outputs)
    return tuple(check.choice("outputs", name, OUTPUTS) for name in names)


def _threads(threads: int | None) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise RobotError("threads", check.show(threads), "a whole number above 0, or None", value=threads)
    return int(threads)
