"""Follows one solution along an actuation path, through snaps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.statics.actuation import without_nothing
from tactr.statics.path import Path, PathPoints, path_points
from tactr.statics.shape import Shape
from tactr.statics.solve import Prepared, _Actuated
from tactr.statics.stability import is_stable_at_tensions

LONGEST_TURN = 0.1  # rad at the free ends in one step: a larger one is taken in smaller steps, or is a snap
FIRST_STEP, GROWTH = 0.25, 1.6
MOST_LOST = 4  # a branch lost so often in a row is given up: the next point is solved from cold


@dataclass(frozen=True, eq=False)
class Snap:
    """A jump to another branch.

    parameter: where on the path, in points (2.5: halfway between the third and the fourth), to the tolerance
    asked for; before: the last shape of the old branch; after: the shape landed on.
    """

    parameter: float
    before: Shape
    after: Shape


@dataclass(frozen=True, repr=False, eq=False)
class Followed:
    """A solution along a path: shapes, one for every point, converged or not; snaps, in their order."""

    shapes: tuple[Shape, ...]
    snaps: tuple[Snap, ...]

    @property
    def converged(self) -> bool:
        """Whether all shapes are."""
        return all(shape.converged for shape in self.shapes)

    @property
    def tips(self) -> np.ndarray:
        """Position of the distal end at every point, (points, 3), m, world axes."""
        return np.array([shape.tip_position for shape in self.shapes])

    def __repr__(self) -> str:
        at = f" at {', '.join(f'{snap.parameter:.4g}' for snap in self.snaps)}" if self.snaps else ""
        good = sum(shape.converged for shape in self.shapes)
        return f"<Followed: {good} of {len(self.shapes)} points converged, {len(self.snaps)} snaps{at}>"


def follow(
    robot: Robot,
    path: Path,
    *,
    start: Shape | None = None,
    tolerance: float = 1e-6,
    snap_tolerance: float = 1e-4,
    stations: int | Sequence[float] | np.ndarray = 101,
) -> Followed:
    """Follows one solution along a path of actuation; a result always comes back.

    path: a sequence of mappings with tension (N), displacement (m), rotation (rad) or translation (m), each
    as in ``solve``; or one mapping from these names to arrays (points, tendons or tubes). In between the
    actuation is linear; what is left out stays as the robot has it; a tendon is pulled by tensions all along
    or by displacements. Displacements count from the rest state at every point: where tubes move, give the
    tendons the rest_length at which their motors stand still (``rest_lengths``). start: a shape near the
    first point, whose branch is taken, otherwise that of a cold solve. The path is walked in adaptive steps
    in which no tube turns by more than 0.1 rad at its end; where the branch ends or loses its stability (as
    it is pulled: held motors can keep what falls over at held tensions), it snaps: to the nearest stable
    shape of less energy, as a slow, damped robot would, or, if there is none, to the nearest stable one.
    Where no shape is found the next point is solved from cold. A jump of less than 0.1 rad is not told from a
    fast motion. snap_tolerance: how closely a snap is located, in points of the path. tolerance, stations: as
    in ``solve``. Raises RobotError.
    """
    if not (isinstance(snap_tolerance, int | float) and 0.0 < snap_tolerance <= FIRST_STEP):
        raise RobotError(
            "snap_tolerance", f"{snap_tolerance!r}", f"a number in (0, {FIRST_STEP}]", value=snap_tolerance
        )
    points = path_points(robot, path)
    prepared = Prepared(points.first, tolerance=tolerance, stations=stations)
    return _Follower(prepared, points, float(snap_tolerance)).run(start)


class _Follower:
    """The walk: arrays of actuation, a row for every point."""

    def __init__(self, prepared: Prepared, points: PathPoints, least_step: float) -> None:
        self._prepared = prepared
        self._base = points.first
        self._rows = points.tension, points.rotation, points.translation
        self._pulls = without_nothing(points.displacement)
        self._count = len(points)
        self._least_step = least_step
        self._step = FIRST_STEP
        self._snaps: list[Snap] = []

    def run(self, start: Shape | None) -> Followed:
        shape = self._solve(0.0, start) if start is not None else None
        if shape is None or not shape.converged:
            shape = self._solve(0.0, None)
        shapes = [shape]
        for k in range(1, self._count):
            shape = self._walk(shape, k - 1.0, float(k))
            shapes.append(shape)
        return Followed(tuple(shapes), tuple(self._snaps))

    def _at(self, t: float) -> _Actuated:
        k = min(math.floor(t), max(self._count - 2, 0))
        part = t - k

        def between(rows: np.ndarray) -> np.ndarray:
            return rows[k] if part == 0.0 else (1.0 - part) * rows[k] + part * rows[k + 1]

        tension, rotation, translation = map(between, self._rows)
        plain = {  # a profile is not replaced by a number, nor a displacement by a tension
            tendon.name: value
            for tendon, value in zip(self._base.tendons, tension, strict=True)
            if tendon.displacement is None and not isinstance(tendon.tension, TensionProfile)
        }
        changed = {"tension": plain, "rotation": rotation, "translation": translation}
        pull = None if self._pulls is None else between(self._pulls)
        if pull is not None:
            changed["displacement"] = pull
        return _Actuated(self._base, (tension, rotation, translation), changed, pull)

    def _solve(self, t: float, guess: Shape | None) -> Shape:
        return self._prepared._solved(self._at(t), guess, stay=guess is not None)

    def _walk(self, shape: Shape, t: float, end: float) -> Shape:
        if not shape.converged:
            return self._solve(end, None)
        lost = 0  # times in a row that the branch was lost
        while t < end:
            step = min(self._step, end - t)
            ahead = end if step >= end - t else t + step
            candidate = self._solve(ahead, shape)
            if self._continues(shape, candidate):
                shape, t, lost = candidate, ahead, 0
                self._step = min(GROWTH * max(step, self._least_step), 1.0)
            elif step > self._least_step:
                self._step = 0.5 * step
            else:
                after = self._land(shape, ahead)
                lost += 1
                if not after.converged or lost == MOST_LOST:
                    return after if ahead == end else self._solve(end, None)
                shape, t, self._step = after, ahead, FIRST_STEP
        return shape

    def _continues(self, shape: Shape, candidate: Shape) -> bool:
        """On the same branch: near, and not unstable where the shape before was stable."""
        if not candidate.converged or self._turn(shape, candidate) > LONGEST_TURN:
            return False
        return self._stable(candidate) or not self._stable(shape)

    def _land(self, shape: Shape, t: float) -> Shape:
        """The stable shape that a shape moves to where its branch is lost. Noted as a snap if it is far."""
        found = self._prepared._found(self._at(t), 0, near=shape)
        stable = [other for other in found if self._stable(other)]
        if not stable:
            after = found[0] if found else self._solve(t, None)
        else:
            lower = [other for other in stable if _energy(other) <= _energy(shape)]
            after = min(lower or stable, key=lambda other: self._turn(shape, other))
            nearest = min(stable, key=lambda other: self._turn(shape, other))
            if self._turn(shape, nearest) <= LONGEST_TURN:
                return nearest
        self._snaps.append(Snap(t, shape, after))
        return after

    @staticmethod
    def _stable(shape: Shape) -> bool:
        if shape._pulled is not None:
            return shape.stable
        return is_stable_at_tensions(shape._prepared, shape._solution)

    @staticmethod
    def _turn(a: Shape, b: Shape) -> float:
        return _core.free_end_distance(a._prepared, a._solution, b._solution)


def _energy(shape: Shape) -> float:
    """Of which a minimum is stable, J: with held motors where these hold displacements."""
    if shape._pulled is None:
        return shape.potential_energy
    return shape._pulled.pulls.energy(shape._prepared, shape._solution)
