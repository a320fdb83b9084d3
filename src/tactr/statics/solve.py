"""Solve a robot's statics: tensions, rotations, insertions and loads in, shape out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.robot._bores import clashes
from tactr.robot.load import Load
from tactr.robot.robot import Displacements, Numbers, Tensions
from tactr.statics.actuation import (
    differs_in_profile,
    displacements,
    innermost_place,
    rotations,
    tensions,
    translations,
    without_nothing,
)
from tactr.statics.assemble import assemble
from tactr.statics.displacement import DisplacementSolver
from tactr.statics.held import MOST_STEPS, Held
from tactr.statics.pulled_branches import PulledBranches
from tactr.statics.pulls import LARGEST, Pulled
from tactr.statics.rest import RestState, pulls_from
from tactr.statics.shape import Shape
from tactr.statics.stations import station_places

RESIDUAL_SHARE = 0.05  # of the tolerance at the tip may come from the angle by which the base is missed
HELD_SHARE = 0.2  # of the tolerance, at held tensions: what is wrong in a length is wrong in a displacement
LEAST_RESIDUAL, LARGEST_RESIDUAL = 1e-11, 1e-6  # rad: rounding below, carelessness above


def solve(
    robot: Robot,
    *,
    tension: Tensions | None = None,
    rotation: Numbers | None = None,
    translation: Numbers | None = None,
    displacement: Displacements | None = None,
    loads: Sequence[Load] | None = None,
    guess: Shape | None = None,
    tolerance: float = 1e-6,
    stations: int | Sequence[float] | np.ndarray = 101,
) -> Shape:
    """The quasi-static shape of a robot. A result always comes back: look at ``converged`` and ``message``.

    tension: N, by tendon; rotation: rad, translation: m <= 0, by tube; displacement: m, by tendon, what its
    motor pulls instead of a tension (see ``Tendon``; None or NaN: nothing, its tension counts); each a
    mapping from names or a sequence in order, and what is left out stays as the robot has it. loads: replace
    the robot's. guess: a neighbouring shape of the same robot, whose branch is kept, stable or not; without
    one, an unstable equilibrium is exchanged for a stable one where one is found. tolerance: discretisation
    error at the tip, m; a tenth of it may be missing in a displacement. stations: their number, spread evenly
    over the length outside the guide, or s in m, ascending. Raises RobotError for a wrong actuation.
    """
    if loads is not None:
        robot = robot.replace(loads=tuple(loads))
    if any(given is not None for given in (tension, rotation, translation, displacement)):
        robot = robot.with_actuation(
            tension=tension, rotation=rotation, translation=translation, displacement=displacement
        )
    return Prepared(robot, tolerance=tolerance, stations=stations).solve(guess=guess)


def branches(
    robot: Robot,
    *,
    tension: Tensions | None = None,
    rotation: Numbers | None = None,
    translation: Numbers | None = None,
    displacement: Displacements | None = None,
    loads: Sequence[Load] | None = None,
    samples: int | None = None,
    tolerance: float = 1e-6,
    stations: int | Sequence[float] | np.ndarray = 101,
) -> list[Shape]:
    """All equilibria of a robot that a search finds: stable ones first, then by energy; may be empty.

    Searched are all angles of the tubes at their distal ends and, with loads in world axes, all orientations
    of the tip. For two tubes without such loads a sweep finds every equilibrium; for three and four a grid
    of simplices, otherwise low-discrepancy starts, both repeated with more samples while the count of stable
    and unstable equilibria shows that some are missing. Shapes that turn into each other at no cost count as
    one. Under displacements all equilibria are found at some held tensions, and led from there to the
    displacements by Newton's method: what is found are equilibria, but nothing shows whether some are
    missing. samples: points of the first sweep or grid, or starts; None: by the number of unknowns. The rest
    is as in ``solve``. Raises RobotError.
    """
    if loads is not None:
        robot = robot.replace(loads=tuple(loads))
    if any(given is not None for given in (tension, rotation, translation, displacement)):
        robot = robot.with_actuation(
            tension=tension, rotation=rotation, translation=translation, displacement=displacement
        )
    return Prepared(robot, tolerance=tolerance, stations=stations).branches(samples=samples)


class _Actuated(NamedTuple):
    """The robot at an actuation: what it came from, arrays of tension, rotation and translation, what of the
    actuation the base does not have, and displacements, NaN where there is none, or None without any."""

    base: Robot
    arrays: tuple[np.ndarray, np.ndarray, np.ndarray]
    changed: dict[str, Any]
    displacement: np.ndarray | None = None


class Prepared:
    """A robot made ready to be solved many times, as in a control loop; only its actuation changes.

    tolerance (m) and stations as in ``solve``; residual_tolerance (rad) follows: the angle by which the base
    may be missed, a twentieth of the tolerance over the length of the longest tube. Arrays of floats for
    every tendon or tube are the fastest actuation.
    """

    def __init__(
        self, robot: Robot, *, tolerance: float = 1e-6, stations: int | Sequence[float] | np.ndarray = 101
    ) -> None:
        self.robot = robot
        self.tolerance = _positive("tolerance", tolerance)
        self.residual_tolerance = residual_tolerance_of(robot, self.tolerance)
        self.held_tolerance = HELD_SHARE * self.tolerance  # of solves at held tensions, under displacements
        self._core = assemble(robot)
        self._given_stations = stations
        self._stations = station_places(robot, stations)
        self._tension = tensions(robot)
        self._rotation = rotations(robot)
        self._translation = translations(robot)
        profiled = [isinstance(tendon.tension, TensionProfile) for tendon in robot.tendons]
        # a profile is not replaced by a number unseen
        self._least_tension = [math.inf if profile else 0.0 for profile in profiled]
        self._least_rotation = [-math.inf] * len(robot.tubes)
        self._displacement = displacements(robot)
        self._compliance = np.array([tendon.compliance for tendon in robot.tendons], dtype=float)
        stepped = bool(clashes(robot.tubes))  # where they fit is seen by a closer look
        self._least_translation = [
            math.inf if stepped else -innermost_place(robot, tube) for tube in robot.tubes
        ]

    @cached_property
    def _rest(self) -> RestState:
        return RestState(self.robot, self._core, self.held_tolerance, self.residual_tolerance)

    def __repr__(self) -> str:
        return f"<Prepared {self.robot!r}, tolerance {self.tolerance:.1e} m>"

    def solve(
        self,
        *,
        tension: Tensions | None = None,
        rotation: Numbers | None = None,
        translation: Numbers | None = None,
        displacement: Displacements | None = None,
        guess: Shape | None = None,
    ) -> Shape:
        """As ``tactr.solve``, for this robot."""
        actuated = self._actuated(tension, rotation, translation, displacement)
        if isinstance(actuated, Prepared):
            return actuated.solve(guess=guess)
        return self._solved(actuated, guess)

    def branches(
        self,
        *,
        tension: Tensions | None = None,
        rotation: Numbers | None = None,
        translation: Numbers | None = None,
        displacement: Displacements | None = None,
        samples: int | None = None,
    ) -> list[Shape]:
        """As ``tactr.branches``, for this robot."""
        count = _samples(samples)
        actuated = self._actuated(tension, rotation, translation, displacement)
        if isinstance(actuated, Prepared):
            return actuated.branches(samples=samples)
        return self._found(actuated, count)

    def _found(self, actuated: _Actuated, samples: int, near: Shape | None = None) -> list[Shape]:
        """All equilibria that a search finds; samples 0: as many as fit the number of unknowns. near: a shape
        from whose tensions those under displacements are looked for, until a stable one is found."""
        start = perf_counter()
        if actuated.displacement is not None:
            first = self._solved(actuated, None) if near is None else near
            pulls = pulls_from(
                self._rest, actuated.arrays, actuated.displacement, self._compliance, self.tolerance
            )
            if isinstance(pulls, Pulled) or not first.converged:
                return []
            search = PulledBranches(self._held(actuated), pulls, actuated.arrays[0], samples)
            some = search.found(first._solution, until_stable=near is not None)
            elapsed = perf_counter() - start
            return [self._shape(actuated, pulled.solution, elapsed, pulled) for pulled in some]
        found = _core.branches(self._core, *actuated.arrays, self.tolerance, self.residual_tolerance, samples)
        elapsed = perf_counter() - start
        return [self._shape(actuated, solution, elapsed) for solution in found]

    def _actuated(
        self,
        tension: Tensions | None,
        rotation: Numbers | None,
        translation: Numbers | None,
        displacement: Displacements | None = None,
    ) -> Prepared | _Actuated:
        """The actuation as arrays; where it replaces a tension profile, another Prepared there."""
        plain = (
            self._is_plain(tension, self._tension, self._least_tension, math.inf)
            and self._is_plain(rotation, self._rotation, self._least_rotation, math.inf)
            and self._is_plain(translation, self._translation, self._least_translation, 0.0)
            and self._is_plain_displacement(displacement, tension)
        )
        given = {"tension": tension, "rotation": rotation, "translation": translation}
        base, pulled = self.robot, None
        if not plain:
            base = self.robot.with_actuation(**given, displacement=displacement)
            if any(map(differs_in_profile, self.robot.tendons, base.tendons)):
                return Prepared(base, tolerance=self.tolerance, stations=self._given_stations)
            given = {
                "tension": tensions(base),
                "rotation": rotations(base),
                "translation": translations(base),
            }
            pulled = displacements(base)
        own = {"tension": self._tension, "rotation": self._rotation, "translation": self._translation}
        arrays = {name: own[name] if array is None else np.array(array) for name, array in given.items()}
        changed = {name: array for name, array in arrays.items() if plain and array is not own[name]}
        if plain and displacement is not None:
            changed["displacement"] = pulled = np.array(displacement, dtype=float)
        elif plain and tension is None:
            pulled = self._displacement  # a fresh tension takes over from a displacement
        every = arrays["tension"], arrays["rotation"], arrays["translation"]
        return _Actuated(base, every, changed, without_nothing(pulled))

    def _solved(self, actuated: _Actuated, guess: Shape | None, *, stay: bool = False) -> Shape:
        """From a guess or from cold; stay: on the guess's branch or not at all."""
        start = perf_counter()
        if actuated.displacement is not None:
            pulled = self._pulled(actuated, actuated.displacement, guess, stay)
            return self._shape(actuated, pulled.solution, perf_counter() - start, pulled)
        stays = stay and guess is not None
        solution = _core.solve(
            self._core,
            *actuated.arrays,
            self.tolerance,
            self.residual_tolerance,
            _start(guess),
            stay=stays,
            most_steps=MOST_STEPS,
        )
        return self._shape(actuated, solution, perf_counter() - start)

    def _held(self, actuated: _Actuated) -> Held:
        _, rotation, translation = actuated.arrays
        return Held(self._core, rotation, translation, self.held_tolerance, self.residual_tolerance)

    def _pulled(
        self, actuated: _Actuated, displacement: np.ndarray, guess: Shape | None, stay: bool
    ) -> Pulled:
        """Tensions from displacements, NaN for tendons at their tension: from a guess, then, unless it is to
        stay there, from cold."""
        pulls = pulls_from(self._rest, actuated.arrays, displacement, self._compliance, self.tolerance)
        if isinstance(pulls, Pulled):
            return pulls
        solver = DisplacementSolver(self._held(actuated), pulls, actuated.arrays[0])
        near, found = _start(guess), None
        if near is not None and len(near.tension) == len(displacement):
            found = solver.from_guess(near, stay=stay)
            if found is None and stay:
                return Pulled(pulls, near, np.full(len(pulls.index), LARGEST), 0, 0)
        return solver.from_cold() if found is None else found

    def _shape(
        self, actuated: _Actuated, solution: _core.Solution, elapsed: float, pulled: Pulled | None = None
    ) -> Shape:
        moved = actuated.arrays[2] is not self._translation
        return Shape(
            self._core,
            solution,
            base=actuated.base,
            actuation=actuated.changed,
            tolerance=self.tolerance,
            residual_tolerance=self.residual_tolerance,
            stations=self._given_stations if moved else self._stations,
            solve_time=elapsed,
            pulled=pulled,
            rest=lambda: self._rest,
        )

    def _is_plain_displacement(self, given: object, tension: object) -> bool:
        """As _is_plain; NaN is plain, a tendon with two ways to be pulled is not."""
        if given is None:
            return True
        own = self._tension
        if not (isinstance(given, np.ndarray) and given.dtype == np.float64 and given.shape == own.shape):
            return False
        pulled = ~np.isnan(given)
        fresh = tension if isinstance(tension, np.ndarray) else 0.0 * own
        fits = np.isfinite(given) & (fresh == 0.0) & np.isfinite(self._least_tension)
        return bool(fits[pulled].all())

    @staticmethod
    def _is_plain(given: object, own: np.ndarray, least: list[float], most: float) -> bool:
        """Whether an actuation is absent, or an array that needs no closer look: floats, all in bounds."""
        if given is None:
            return True
        if not (isinstance(given, np.ndarray) and given.dtype == np.float64 and given.shape == own.shape):
            return False
        values = given.tolist()  # too few for numpy to pay
        return all(math.isfinite(x) and low <= x <= most for x, low in zip(values, least, strict=True))


def residual_tolerance_of(robot: Robot, tolerance: float) -> float:
    """The angle by which the base may be missed, rad."""
    share = RESIDUAL_SHARE * tolerance / max(tube.length for tube in robot.tubes)
    return min(max(share, LEAST_RESIDUAL), LARGEST_RESIDUAL)


def _start(guess: Shape | None) -> _core.Solution | None:
    return guess._solution if guess is not None and guess.converged else None


def _samples(samples: int | None) -> int:
    if samples is None:
        return 0
    if isinstance(samples, bool) or not isinstance(samples, int | np.integer) or samples < 1:
        raise RobotError("samples", f"{samples!r}", "a whole number above 0, or None", value=samples)
    return int(samples)


def _positive(field: str, number: float) -> float:
    if not (isinstance(number, int | float) and math.isfinite(number) and number > 0.0):
        raise RobotError(field, f"{number!r}", "a number above 0", value=number)
    return float(number)
