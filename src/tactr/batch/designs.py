"""The robots of a batch's items as the kernel sees them, each distinct one once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tactr import _core
from tactr.batch.items import Items
from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.robot._bores import Clash, clashes
from tactr.statics.actuation import displacements, innermost_place, rotations, tensions, translations
from tactr.statics.assemble import assemble
from tactr.statics.solve import residual_tolerance_of


@dataclass(frozen=True, repr=False, eq=False)
class Design:
    """A robot and its own actuation; what of it a batch may change without a closer look."""

    robot: Robot
    core: _core.PreparedRobot
    residual_tolerance: float

    @cached_property
    def tension(self) -> np.ndarray:
        return tensions(self.robot)

    @cached_property
    def rotation(self) -> np.ndarray:
        return rotations(self.robot)

    @cached_property
    def translation(self) -> np.ndarray:
        return translations(self.robot)

    @cached_property
    def displacement(self) -> np.ndarray:
        """(tendons,), NaN where there is none."""
        given = displacements(self.robot)
        return np.full(len(self.robot.tendons), np.nan) if given is None else given

    @cached_property
    def profiled(self) -> np.ndarray:
        """(tendons,): whether it has a tension profile."""
        return np.array([isinstance(t.tension, TensionProfile) for t in self.robot.tendons], dtype=bool)

    @cached_property
    def length(self) -> np.ndarray:
        return np.array([tube.length for tube in self.robot.tubes])

    @cached_property
    def least_translation(self) -> np.ndarray:
        return np.array([-innermost_place(self.robot, tube) for tube in self.robot.tubes])

    @cached_property
    def clashes(self) -> list[Clash]:
        """What stepped tubes must not do; empty where any insertion fits."""
        return clashes(self.robot.tubes)


def design_of(robot: Robot, tolerance: float) -> Design:
    """The robot made ready."""
    return Design(robot, assemble(robot), residual_tolerance_of(robot, tolerance))


def designs_of(items: Items, tolerance: float) -> tuple[list[Design | RobotError], np.ndarray]:
    """Distinct designs, or what is wrong with them, and the (count,) index of every item's."""
    if not items.parameters or items.count == 0:
        return [design_of(items.base, tolerance)], np.zeros(items.count, dtype=int)
    table = np.stack(list(items.parameters.values()), axis=1)
    _, first, index = np.unique(table, axis=0, return_index=True, return_inverse=True)
    return [_design(items, int(i), tolerance) for i in first], index.reshape(-1)


def fitting(designs: list[Design | RobotError], index: np.ndarray, translation: np.ndarray) -> np.ndarray:
    """Which items' tubes fit into each other, (count,); index (count,) as in ``designs_of``, translation
    (count, tubes) m."""
    fits = np.ones(len(index), dtype=bool)
    stepped = {k: d for k, d in enumerate(designs) if isinstance(d, Design) and d.clashes}
    if stepped:
        order = np.argsort(index, kind="stable")
        first = np.searchsorted(index[order], np.arange(len(designs) + 1))
        for k, design in stepped.items():
            rows = order[first[k] : first[k + 1]]
            for clash in design.clashes:
                fits[rows] &= ~clash.meets(translation[rows])
    return fits


def _design(items: Items, i: int, tolerance: float) -> Design | RobotError:
    try:
        return design_of(items.design(i), tolerance)
    except RobotError as error:
        return error
