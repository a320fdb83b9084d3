"""Work of the actuators along a sequence of shapes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tactr.errors import RobotError
from tactr.robot import TensionProfile
from tactr.statics.shape import Shape


@dataclass(frozen=True)
class Work:
    """Work of the actuators along a path of shapes, and what became of it, J.

    tension (tendons,), by shortening them; rotation, translation (tubes,); stored: rise of strain energy,
    load potential and the energy of springs at the tubes from the first shape to the last. In exact
    equilibrium along the whole path total equals stored; a path that snaps gives up imbalance.
    """

    tension: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    stored: float

    @property
    def total(self) -> float:
        """Work of all actuators."""
        return float(self.tension.sum() + self.rotation.sum() + self.translation.sum())

    @property
    def imbalance(self) -> float:
        """What the actuators put in and is not stored: lost in snaps, or the error of too coarse a path."""
        return self.total - self.stored


def work(shapes: Sequence[Shape]) -> Work:
    """Work of the actuators along converged shapes of one robot that follow each other, by the trapezoidal
    rule: its error falls with the square of the steps.

    Only tensions, rotations and translations may change on the way, not the loads. A DistributedLoad without
    a tube keeps its s, so its potential follows no translation. Raises NotConverged; RobotError for a tension
    profile (friction: the work of such a tendon is not its tension at the base times its shortening), for
    fewer than two shapes, for different robots, for loads without a potential.
    """
    _check_path(shapes)

    def along(
        force: Callable[[Shape], np.ndarray], displacement: Callable[[Shape], np.ndarray]
    ) -> np.ndarray:
        forces, places = (np.array([read(shape) for shape in shapes]) for read in (force, displacement))
        return (0.5 * (forces[1:] + forces[:-1]) * np.diff(places, axis=0)).sum(axis=0)

    first, last = shapes[0], shapes[-1]
    return Work(
        tension=along(lambda x: x.actuator_forces.tension, lambda x: -x._solution.tendon_length),
        rotation=along(
            lambda x: x.actuator_forces.torque, lambda x: np.array([t.rotation for t in x.robot.tubes])
        ),
        translation=along(
            lambda x: x.actuator_forces.force, lambda x: np.array([t.translation for t in x.robot.tubes])
        ),
        stored=_stored(last) - _stored(first),
    )


def _stored(shape: Shape) -> float:
    compliance = np.array([tube.rotation_compliance for tube in shape.robot.tubes])
    springs = 0.5 * float(compliance @ shape.actuator_forces.torque**2)
    return shape.energy + shape.load_potential + springs


def _check_path(shapes: Sequence[Shape]) -> None:
    if len(shapes) < 2:
        raise RobotError("shapes", f"{len(shapes)} shapes make no path", "at least two")
    first = shapes[0].robot
    for k, tendon in enumerate(first.tendons):
        if isinstance(tendon.tension, TensionProfile):
            raise RobotError(f"tendons[{k}].tension", "a profile has no one tension", "a number in N")
    for k, shape in enumerate(shapes[1:], start=1):
        other = (
            shape.robot.with_actuation(
                tension=[tendon.tension for tendon in first.tendons],
                rotation=[tube.rotation for tube in first.tubes],
                translation=[tube.translation for tube in first.tubes],
            )
            if _counts(shape) == _counts(shapes[0])
            else None
        )
        if other != first:
            raise RobotError(f"shapes[{k}]", "it is of another robot", "one robot under changing actuation")


def _counts(shape: Shape) -> tuple[int, int]:
    return len(shape.robot.tubes), len(shape.robot.tendons)
