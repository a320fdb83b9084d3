"""How a shape changes with numbers of the robot's description, its motors held where they are.

The kernel differentiates at held tensions. Where tendons are pulled by displacements, their tensions follow:
the gaps F = l_rest(p) - l(T, p) + compliance (T - pretension) - d of the taut tendons stay zero, so that

    dT/dp = -(dF/dT)^-1 dF/dp,   d pose/dp = d pose/dp at held tensions + d pose/dT dT/dp

by the implicit function theorem; slack tendons keep their zero tension.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tactr import _core
from tactr.robot import Robot
from tactr.statics._complementary import SINGULAR
from tactr.statics.parameters import actuator_column, place_of, rates_of, value_of

if TYPE_CHECKING:
    from tactr.statics.pulls import Pulled
    from tactr.statics.shape import Shape

MOTOR = ("displacement", "compliance", "pretension", "rest_length")


class Rates:
    """Derivatives with respect to numbers of one robot, at any actuation of it and any of its shapes.

    parameters: paths as in ``Shape.sensitivity``, or tuples of paths that change together, by the same
    number; those of actuators and motors (see MOTOR) stand alone. Raises RobotError for an unknown one.
    """

    def __init__(self, robot: Robot, parameters: Sequence[str | tuple[str, ...]]) -> None:
        self.parameters = tuple((p,) if isinstance(p, str) else p for p in parameters)
        self._robot = robot
        self._tendons = len(robot.tendons)
        self._motors = {
            k: motor for k, paths in enumerate(self.parameters) if (motor := _motor(robot, paths[0]))
        }
        tables = {k: paths for k, paths in enumerate(self.parameters) if k not in self._motors}
        self._columns, self._rates = _columns(robot, tables)
        self._bare: tuple[dict[int, int], list[_core.PreparedRobot]] | None = None
        self._rest: tuple[_core.Solution, np.ndarray] | None = None

    def poses(self, shape: Shape, s: np.ndarray) -> np.ndarray:
        """(1 + k, 6, parameters), world axes: the tip, then the points at s (k,) m, ascending, above 0."""
        pulled = shape._pulled
        found = _core.sensitivities(
            shape._prepared, shape._solution, s, pulled is not None, True, -1.0, self._rates
        )
        rows = 6 * (1 + len(s))
        direct = self._picked(found, self._columns)  # at held tensions
        if pulled is not None:
            direct = direct[:rows] + found[:rows, : self._tendons] @ self._tensions(
                shape, pulled, found, direct
            )
        return direct.reshape(1 + len(s), 6, -1)

    def _tensions(self, shape: Shape, pulled: Pulled, found: np.ndarray, direct: np.ndarray) -> np.ndarray:
        """d tension/dp, (tendons, parameters)."""
        solution = shape._solution
        gap = self._references(shape) - direct[-self._tendons :]
        for k, (field, j) in self._motors.items():
            if field == "displacement":
                gap[j, k] -= 1.0
            elif field == "compliance":
                gap[j, k] += solution.tension[j] - self._robot.tendons[j].pretension
        return followed_tensions(self._robot, pulled, found[-self._tendons :], gap)

    def _references(self, shape: Shape) -> np.ndarray:
        """d(l_rest - compliance pretension)/dp, (tendons, parameters)."""
        tendons, found = self._robot.tendons, np.zeros((self._tendons, len(self.parameters)))
        free = np.array([tendon.rest_length is None for tendon in tendons], dtype=bool)
        if free.any():
            found[free] = self._rest_rates(shape)[free]
        for k, (field, j) in self._motors.items():
            if field == "pretension":
                found[j, k] -= tendons[j].compliance
            elif field == "rest_length" and not free[j]:
                found[j, k] += 1.0
        return found

    def _rest_rates(self, shape: Shape) -> np.ndarray:
        """d(lengths in the rest state)/dp; remembered for the rest state last seen."""
        rest = shape._rest()
        robot = shape.robot
        rest.measured(*(np.array([getattr(t, n) for t in robot.tubes]) for n in ("rotation", "translation")))
        solution = rest.solution
        assert solution is not None
        if self._rest is None or self._rest[0] is not solution:
            columns, rates = self._without_loads()
            found = _core.sensitivities(rest._core, solution, np.array([]), True, True, -1.0, rates)
            lengths = self._picked(found, columns)[6:]
            for k, (field, j) in self._motors.items():
                if field == "pretension":
                    lengths[:, k] = found[6:, j]
            self._rest = solution, lengths
        return self._rest[1]

    def _without_loads(self) -> tuple[dict[int, int], list[_core.PreparedRobot]]:
        """What of the parameters the rest state knows: no loads, no tensions but pretensions."""
        if self._bare is None:
            bare = self._robot.replace(loads=())
            tables = {
                k: [path for path in paths if not path.startswith("loads.")]
                for k, paths in enumerate(self.parameters)
                if self._columns.get(k, 0) >= self._tendons
            }
            self._bare = _columns(bare, {k: paths for k, paths in tables.items() if paths})
        return self._bare

    def _picked(self, found: np.ndarray, columns: dict[int, int]) -> np.ndarray:
        """Columns by parameter, 0 where there is none."""
        picked = np.zeros((len(found), len(self.parameters)))
        picked[:, list(columns)] = found[:, list(columns.values())]
        return picked


def _columns(
    robot: Robot, parameters: Mapping[int, Sequence[str]]
) -> tuple[dict[int, int], list[_core.PreparedRobot]]:
    """The kernel's column for each parameter, and the rates of the tables behind the actuators' columns."""
    columns: dict[int, int] = {}
    rates: list[_core.PreparedRobot] = []
    actuators = len(robot.tendons) + 2 * len(robot.tubes)
    for k, paths in parameters.items():
        held = actuator_column(robot, paths[0])
        columns[k] = actuators + len(rates) if held is None else held
        if held is None:
            rates.append(rates_of(robot, *paths))
    return columns, rates


def followed_tensions(robot: Robot, pulled: Pulled, lengths: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """d tension/dp, (tendons, parameters), from the gaps' rates at held tensions, gap (tendons, parameters).

    lengths (tendons, tendons and more): derivatives of the tendons' lengths with respect to tensions first.
    """
    taut = pulled.pulls.index[pulled.tension > 0.0]
    compliance = np.array([tendon.compliance for tendon in robot.tendons])
    flexibility = (np.diag(compliance) - lengths[:, : len(compliance)])[np.ix_(taut, taut)]
    rates = np.zeros_like(gap)
    rates[taut] = -np.linalg.pinv(flexibility, rcond=SINGULAR) @ gap[taut]
    return rates


def actuator_rates(shape: Shape, s: np.ndarray) -> np.ndarray:
    """(1 + k, 6, 2 tendons + 2 tubes): by tensions, displacements, rotations, translations, motors held.

    0 for the tensions of tendons pulled by displacements, and the displacements of the others.
    """
    tendons = len(shape.robot.tendons)
    whole = np.zeros((1 + len(s), 6, 2 * (tendons + len(shape.robot.tubes))))
    if shape._pulled is None:
        found = _core.sensitivities(shape._prepared, shape._solution, s, False, True, -1.0, [])
        found = found.reshape(1 + len(s), 6, -1)
        whole[..., :tendons], whole[..., 2 * tendons :] = found[..., :tendons], found[..., tendons:]
        return whole
    given = [tendon.displacement is not None for tendon in shape.robot.tendons]
    tubes = [
        f"tubes.{tube.name}.{kind}" for kind in ("rotation", "translation") for tube in shape.robot.tubes
    ]
    pulls = [
        f"tendons.{tendon.name}.{'displacement' if pulled else 'tension'}"
        for tendon, pulled in zip(shape.robot.tendons, given, strict=True)
    ]
    columns = [*(np.arange(tendons) + tendons * np.array(given)), *range(2 * tendons, whole.shape[-1])]
    whole[..., columns] = Rates(shape.robot, pulls + tubes).poses(shape, s)
    return whole


def stands_alone(robot: Robot, path: str) -> bool:
    """Whether a path is an actuator's or a motor's, which the kernel's tables do not hold."""
    return _motor(robot, path) is not None or actuator_column(robot, path) is not None


def _motor(robot: Robot, path: str) -> tuple[str, int] | None:
    """Which of a tendon's numbers that only its motor knows, and of which tendon."""
    place = place_of(robot, path)
    if place is None or place[0] != "tendons" or place[1] not in MOTOR:
        return None
    value_of(robot, path)
    return place[1:]
