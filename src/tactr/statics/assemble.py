"""From a robot to the flat arrays that the kernel takes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from tactr import _core
from tactr.robot import DistributedLoad, Gravity, PointLoad, Robot, Routing, Tendon, TensionProfile, Tube
from tactr.robot.parts import Part
from tactr.robot.piece import RoutingPiece
from tactr.robot.stretch import QUANTITIES

COEFFICIENTS = 16
TUBE_COEFFICIENTS = 8
TENSION_COEFFICIENTS = 12


def assemble(robot: Robot) -> _core.PreparedRobot:
    """The robot as the kernel sees it."""
    return _core.PreparedRobot(**tables(robot))


def tables(robot: Robot) -> dict[str, np.ndarray]:
    """Tubes, pieces of tubes, tendons, routing, tension profiles and loads as numbers, a row for each."""
    index = {tube.name: i for i, tube in enumerate(robot.tubes)}
    return {
        "tubes": _table([_tube_row(tube) for tube in robot.tubes], 4),
        "pieces": _table(
            [row for tube in robot.tubes for row in _piece_rows(tube)], 2 + QUANTITIES * TUBE_COEFFICIENTS
        ),
        "tendons": _table([_tendon_row(robot, tendon, index) for tendon in robot.tendons], 5),
        "routing": _table(
            [row for tendon in robot.tendons for row in _routing_rows(robot, tendon)], 5 + 2 * COEFFICIENTS
        ),
        "profiles": _table(
            [row for tendon in robot.tendons for row in _profile_rows(tendon)],
            2 + TENSION_COEFFICIENTS,
        ),
        "point_loads": _table(
            [_point_row(robot, load, index) for load in robot.loads if isinstance(load, PointLoad)], 9
        ),
        "distributed_loads": _table(_distributed_rows(robot, index), 10),
    }


def base_tension(tendon: Tendon) -> float:
    """The tension handed to the kernel: a profile carries its newtons itself."""
    return 1.0 if isinstance(tendon.tension, TensionProfile) else tendon.tension


def tendon_end(robot: Robot, tendon: Tendon) -> float:
    """Arc length sigma of the tendon's termination, m."""
    return robot.tube(tendon.tube).length if tendon.end is None else tendon.end


def _table(rows: Sequence[Sequence[float]], columns: int) -> np.ndarray:
    return np.array(rows, dtype=float).reshape(len(rows), columns)


def _tube_row(tube: Tube) -> list[float]:
    return [tube.length, tube.rotation_compliance, tube.linear_density or 0.0, len(tube.stretches)]


def _piece_rows(tube: Tube) -> list[list[float]]:
    rows = []
    for stretch in tube.stretches:
        absent = [0.0] * (QUANTITIES * (TUBE_COEFFICIENTS - len(stretch.powers)))
        rows.append(
            [stretch.start, len(stretch.powers), *(c for row in stretch.powers for c in row), *absent]
        )
    return rows


def _tendon_row(robot: Robot, tendon: Tendon, index: dict[str, int]) -> list[float]:
    pieces = len(_pieces(tendon.routing, tendon_end(robot, tendon)))
    tensions = len(_profile_rows(tendon))
    return [index[tendon.tube], tendon.host == "outermost", tendon_end(robot, tendon), pieces, tensions]


@lru_cache(maxsize=512)
def _pieces(routing: Routing, end: float) -> tuple[RoutingPiece, ...]:
    """Kept, because derivatives and calibrations assemble robots that differ in one number."""
    return routing.pieces(end)


def _routing_rows(robot: Robot, tendon: Tendon) -> list[list[float]]:
    rows = []
    for piece in _pieces(tendon.routing, tendon_end(robot, tendon)):
        a = [*piece.a, *[0.0] * (COEFFICIENTS - len(piece.a))]
        b = [*piece.b, *[0.0] * (COEFFICIENTS - len(piece.b))]
        rows.append([piece.start, piece.end, piece.polar, len(piece.a), len(piece.b), *a, *b])
    return rows


def _profile_rows(tendon: Tendon) -> list[list[float]]:
    if not isinstance(tendon.tension, TensionProfile):
        return []
    sigma, values = tendon.tension.sigma, tendon.tension.values
    rows = [tension_row(-math.inf, values[0])] if sigma[0] > 0.0 else []
    for k in range(len(sigma) - 1):
        slope = (values[k + 1] - values[k]) / (sigma[k + 1] - sigma[k])
        rows.append(tension_row(sigma[k], values[k], slope))
    rows.append(tension_row(sigma[-1], values[-1]))
    return rows


def tension_row(start: float, *coefficients: float) -> list[float]:
    """A polynomial in sigma - start, as the kernel takes it."""
    absent = [0.0] * (TENSION_COEFFICIENTS - len(coefficients))
    return [start, len(coefficients), *coefficients, *absent]


def _point_row(robot: Robot, load: PointLoad, index: dict[str, int]) -> list[float]:
    at = robot.tube(load.tube).length if load.at is None else load.at
    return [index[load.tube], load.axes == "body", at, *load.force, *load.moment]


def _distributed_rows(robot: Robot, index: dict[str, int]) -> list[list[float]]:
    rows = []
    for load in robot.loads:
        if isinstance(load, DistributedLoad):
            rows.append(_distributed_row(robot, load, index))
        elif isinstance(load, Gravity):
            rows.extend(
                _weight_row(load, i, part) for i, tube in enumerate(robot.tubes) for part in tube.parts
            )
    return rows


def _distributed_row(robot: Robot, load: DistributedLoad, index: dict[str, int]) -> list[float]:
    tube = -1 if load.tube is None else index[load.tube]
    reach = math.inf if load.tube is None else robot.tube(load.tube).length  # translations may change
    end = reach if load.end is None else load.end
    return [tube, load.axes == "body", load.start, end, *load.force, *load.moment]


def _weight_row(gravity: Gravity, i: int, part: Part) -> list[float]:
    weight = [(part.stiffness.linear_density or 0.0) * g for g in gravity.acceleration]
    return [i, False, part.start, part.end, *weight, 0.0, 0.0, 0.0]
