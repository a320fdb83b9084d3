"""Solve a robot's statics: tensions, rotations, insertions and loads in, shape out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from time import perf_counter

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.robot.load import Load
from tactr.robot.robot import Numbers, Tensions
from tactr.statics.assemble import assemble, base_tension
from tactr.statics.shape import Shape

RESIDUAL_TOLERANCE = 1e-9


def solve(
    robot: Robot,
    *,
    tension: Tensions | None = None,
    rotation: Numbers | None = None,
    translation: Numbers | None = None,
    loads: Sequence[Load] | None = None,
    guess: Shape | None = None,
    tolerance: float = 1e-6,
    stations: int | Sequence[float] | np.ndarray = 101,
) -> Shape:
    """The quasi-static shape of a robot. A result always comes back: look at ``converged`` and ``message``.

    tension: N, by tendon; rotation: rad, translation: m <= 0, by tube; each a mapping from names or a sequence in order,
    and what is left out stays as the robot has it. loads: replace the robot's. guess: a neighbouring shape of the same
    robot, for speed. tolerance: discretisation error at the tip, m. stations: their number, spread evenly over the
    length outside the guide, or s in m, ascending. Raises RobotError for a wrong actuation.
    """
    if loads is not None:
        robot = robot.replace(loads=tuple(loads))
    if tension is not None or rotation is not None or translation is not None:
        robot = robot.with_actuation(tension=tension, rotation=rotation, translation=translation)
    return Prepared(robot, tolerance=tolerance, stations=stations).solve(guess=guess)


class Prepared:
    """A robot made ready to be solved many times, as in a control loop; only its actuation changes.

    tolerance and stations as in ``solve``.
    """

    def __init__(
        self, robot: Robot, *, tolerance: float = 1e-6, stations: int | Sequence[float] | np.ndarray = 101
    ) -> None:
        self.robot = robot
        self.tolerance = _positive("tolerance", tolerance)
        self._core = assemble(robot)
        self._stations = stations
        self._tension = np.array([base_tension(t) for t in robot.tendons], dtype=float)
        self._rotation = np.array([t.rotation for t in robot.tubes], dtype=float)
        self._translation = np.array([t.translation for t in robot.tubes], dtype=float)

    def solve(
        self,
        *,
        tension: Tensions | None = None,
        rotation: Numbers | None = None,
        translation: Numbers | None = None,
        guess: Shape | None = None,
    ) -> Shape:
        """As ``tactr.solve``, for this robot."""
        robot = self.robot
        if tension is not None or rotation is not None or translation is not None:
            robot = robot.with_actuation(tension=tension, rotation=rotation, translation=translation)
        tensions, rotations, translations = self._tension, self._rotation, self._translation
        if tension is not None:
            tensions = np.array([base_tension(t) for t in robot.tendons], dtype=float)
        if rotation is not None:
            rotations = np.array([t.rotation for t in robot.tubes], dtype=float)
        if translation is not None:
            translations = np.array([t.translation for t in robot.tubes], dtype=float)
        start = perf_counter()
        solution = _core.solve(
            self._core, tensions, rotations, translations, self.tolerance, RESIDUAL_TOLERANCE, _start(guess)
        )
        return Shape(
            robot,
            self._core,
            solution,
            tolerance=self.tolerance,
            stations=_stations(robot, self._stations),
            solve_time=perf_counter() - start,
        )


def _start(guess: Shape | None) -> _core.Solution | None:
    return guess._solution if guess is not None and guess.converged else None


def _stations(robot: Robot, stations: int | Sequence[float] | np.ndarray) -> np.ndarray:
    length = max(tube.tip for tube in robot.tubes)
    if isinstance(stations, int):
        if stations < 2:
            raise RobotError("stations", f"{stations} stations", "at least 2", value=stations)
        return np.linspace(0.0, length, stations)
    s = np.ascontiguousarray(stations, dtype=float)
    if s.ndim != 1 or len(s) == 0 or not np.all(np.isfinite(s)) or np.any(np.diff(s) < 0) or s[0] < 0 or s[-1] > length:
        raise RobotError(
            "stations", f"{stations!r}", f"arc lengths in m, ascending, within [0, {length:.6g}]", value=stations
        )
    return s


def _positive(field: str, number: float) -> float:
    if not (isinstance(number, int | float) and math.isfinite(number) and number > 0.0):
        raise RobotError(field, f"{number!r}", "a number above 0", value=number)
    return float(number)
