"""What the model says of every measured row, and how that changes with the free numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tactr.calibration.frame import Frame, cross_matrix, rotation_rates
from tactr.calibration.measurements import ACTUATION, Measurements
from tactr.calibration.parameters import FRAME, ZERO, Free, vector_of
from tactr.errors import RobotError
from tactr.robot import Robot, TensionProfile
from tactr.statics.parameters import with_values
from tactr.statics.rates import Rates, stands_alone
from tactr.statics.rest import rest_lengths
from tactr.statics.shape import Shape
from tactr.statics.solve import Prepared

Ticker = Callable[[int], None]


@dataclass(frozen=True)
class Setting:
    """Free numbers made into a robot, its motors' zeros (tendons,) m, and a frame."""

    robot: Robot
    zero: np.ndarray
    frame: Frame


class Model:
    """Predictions for measurements. Shapes found last are where the next search begins, row by row."""

    def __init__(
        self, robot: Robot, frame: Frame, measured: Measurements, frees: Sequence[Free], tolerance: float
    ) -> None:
        self.measured, self.frees, self._given = measured, tuple(frees), robot
        self.robot, self.frame = _pulled(robot, measured), frame
        self.tolerance = tolerance
        self._shapes: list[Shape | None] = [None] * len(measured)
        self._names = [tendon.name for tendon in robot.tendons]

    def setting(self, values: np.ndarray) -> Setting:
        """What these values of the free numbers mean. Raises RobotError."""
        changed, zero, frame = {}, np.zeros(len(self._names)), self.frame
        for free, value in zip(self.frees, values, strict=True):
            for path in free.paths:
                if path in FRAME:
                    frame = _framed(frame, path, float(value))
                elif path.endswith(f".{ZERO}"):
                    zero[self._names.index(path.split(".", 1)[1].rpartition(".")[0])] = value
                else:
                    changed[path] = float(value)
        return Setting(with_values(self.robot, changed), zero, frame)

    def predict(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """Points in the sensor's axes, (n, k, 3) m; NaN in rows without an equilibrium."""
        setting = self.setting(values)
        prepared = Prepared(setting.robot, tolerance=self.tolerance, stations=2)
        points, before = np.full(self.measured.points.shape, np.nan), None
        rows = self._actuation(setting)
        for i in range(len(points)):
            guess = self._shapes[i] or before
            shape = prepared.solve(**{kind: values[i] for kind, values in rows.items()}, guess=guess)
            if tick is not None:
                tick(i)
            if shape.converged:
                self._shapes[i] = before = shape
                points[i] = self._points(shape, setting.frame)
        return points

    def jacobian(self, values: np.ndarray, tick: Ticker | None = None) -> np.ndarray:
        """d points/d values, (n, k, 3, free), at the shapes of the last ``predict``, which was there."""
        setting = self.setting(values)
        columns, paths = self._split()
        rates = Rates(setting.robot, paths)
        inside = np.array([place for place in self.measured.places if place is not None])
        found = np.zeros((*self.measured.points.shape, len(self.frees)))
        for i, shape in enumerate(self._shapes):
            if tick is not None:
                tick(i)
            if shape is None:
                continue
            poses = rates.poses(shape, inside)
            ordered = poses[[*range(1, len(poses)), *([0] if None in self.measured.places else [])]]
            self._gather(found[i], ordered @ columns, shape, setting.frame)
        return found

    def forget(self) -> None:
        """Start the next search of shapes from nothing."""
        self._shapes = [None] * len(self.measured)

    def tensions(self) -> np.ndarray:
        """Of all tendons in the shapes of the last ``predict``, (n, tendons), N; NaN without one."""
        none = np.full(len(self._names), np.nan)
        return np.array([none if shape is None else shape.tension for shape in self._shapes])

    def calibrated(self, values: np.ndarray) -> Robot:
        """The robot at these values: zeros of motors become rest lengths, from where they are tied."""
        setting = self.setting(values)
        robot, moved = self._as_given(setting.robot), np.flatnonzero(setting.zero)
        if len(moved):
            lengths = rest_lengths(robot)
            tendons = list(robot.tendons)
            for j in moved:
                own = tendons[j].rest_length
                rest = lengths[tendons[j].name] if own is None else own
                tendons[j] = replace(tendons[j], rest_length=rest - setting.zero[j])
            robot = robot.replace(tendons=tuple(tendons))
        return robot

    def _as_given(self, robot: Robot) -> Robot:
        """With the actuation that was measured as the robot had it before."""
        data, before = self.measured, self._given
        pulled = {*data.displacement, *data.tension}
        tendons = [
            replace(own, displacement=old.displacement, tension=old.tension) if own.name in pulled else own
            for own, old in zip(robot.tendons, before.tendons, strict=True)
        ]
        tubes = [
            replace(
                own,
                rotation=old.rotation if own.name in data.rotation else own.rotation,
                translation=old.translation if own.name in data.translation else own.translation,
            )
            for own, old in zip(robot.tubes, before.tubes, strict=True)
        ]
        return robot.replace(tendons=tuple(tendons), tubes=tuple(tubes))

    def _actuation(self, setting: Setting) -> dict[str, np.ndarray]:
        """(n, tendons) or (n, tubes) arrays of what was measured, and what the robot has of the rest."""
        found, n = {}, len(self.measured)
        for kind in ACTUATION:
            given = getattr(self.measured, kind)
            members = self.robot.tendons if kind in ("displacement", "tension") else self.robot.tubes
            if not given:
                continue
            own = [getattr(member, kind) for member in members]
            array = np.tile(np.array([np.nan if v is None else v for v in own], dtype=float), (n, 1))
            for j, member in enumerate(members):
                if member.name in given:
                    array[:, j] = given[member.name] + (setting.zero[j] if kind == "displacement" else 0.0)
            found[kind] = array
        return found

    def _points(self, shape: Shape, frame: Frame) -> np.ndarray:
        places = [place for place in self.measured.places if place is not None]
        points = [*(shape.sample(places).centreline if places else ())]
        if None in self.measured.places:
            points.append(shape.tip_position + shape.tip_orientation @ np.array(frame.marker))
        return np.array(points) @ frame.matrix.T + np.array(frame.position)

    def _split(self) -> tuple[np.ndarray, list[tuple[str, ...]]]:
        """Paths of the robot's own numbers, those that move together as one, and which free number each is,
        (paths, free)."""
        groups, owners = [], []
        for k, free in enumerate(self.frees):
            own = [_as_displacement(path) for path in free.paths if path not in FRAME]
            alone = [path for path in own if stands_alone(self.robot, path)]
            together = tuple(path for path in own if path not in alone)
            groups += [*((path,) for path in alone), *([together] if together else [])]
            owners += [k] * (len(groups) - len(owners))
        return np.eye(len(self.frees))[owners].reshape(len(groups), len(self.frees)), groups

    def _gather(self, into: np.ndarray, poses: np.ndarray, shape: Shape, frame: Frame) -> None:
        """Fill (k, 3, free) from the rates (k, 6, free) of the poses in the robot's axes."""
        R, marker = frame.matrix, np.array(frame.marker)
        into[:] = poses[:, :3]
        tip = self.measured.places[-1] is None
        if tip:
            into[-1] -= cross_matrix(shape.tip_orientation @ marker) @ poses[-1, 3:]
        into[:] = R @ into
        robot_points = self._points(shape, frame) - np.array(frame.position)
        turns = rotation_rates(np.array(frame.rotation))
        for k, free in enumerate(self.frees):
            for path in free.paths:
                if path not in FRAME:
                    continue
                axis = "xyz".index(path[-1])
                if path.startswith("marker") and tip:
                    into[-1, :, k] += (R @ shape.tip_orientation)[:, axis]
                elif path.startswith("sensor.r"):
                    into[:, :, k] += np.cross(turns[:, axis], robot_points)
                elif path.startswith("sensor"):
                    into[:, axis, k] += 1.0


def _as_displacement(path: str) -> str:
    """A motor that has pulled more at its zero is one with a larger displacement."""
    return f"{path.rpartition('.')[0]}.displacement" if path.endswith(f".{ZERO}") else path


def _framed(frame: Frame, path: str, value: float) -> Frame:
    name = vector_of(path)
    vector = list(getattr(frame, name))
    vector["xyz".index(path[-1])] = value
    return replace(frame, **{name: tuple(vector)})


def _pulled(robot: Robot, measured: Measurements) -> Robot:
    """The robot at the first row: which tendons have displacements, and which tensions. Raises RobotError."""
    first = {kind: {name: v[0] for name, v in getattr(measured, kind).items()} for kind in ACTUATION}
    both = [name for name in first["displacement"] if name in first["tension"]]
    if both:
        expected = "its displacement or its tension, the other column left out"
        raise RobotError(f"tendons.{both[0]}", "its displacement and its tension are both measured", expected)
    for kind in ("displacement", "tension"):
        for name in first[kind]:
            if isinstance(robot.tendon(name).tension, TensionProfile):
                raise RobotError(f"tendons.{name}", "it has a tension profile", "a tension in N")
    return robot.with_actuation(**{kind: values for kind, values in first.items() if values})
