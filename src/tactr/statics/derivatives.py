"""Exact derivatives of a shape with respect to actuators, loads and the robot's own parameters.

All come from one more march in dual numbers and the implicit function theorem at the base. A small motion
is a column of six: shift of the point (m), then rotation (rad). Axes are "world", or "body": those of the
material frame of the innermost tube at the point.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, cast

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.statics.rates import Rates, actuator_rates, followed_tensions

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.statics.pulls import Pulled
    from tactr.statics.shape import Shape

Axes = Literal["world", "body"]


class Jacobian(NamedTuple):
    """Derivatives of a point's pose, six rows: its shift (m) and rotation (rad). Of k points: k first.

    tension (..., 6, tendons), per N; displacement (..., 6, tendons), per m; rotation (..., 6, tubes), per
    rad; translation (..., 6, tubes), per m. Each with all other actuators held: the motors of tendons pulled
    by displacements (their tensions follow), the tensions of the others. 0 where a tendon is not actuated
    so, and for slack tendons' displacements; where a slack tendon is about to be taut they are the
    derivatives on the slack side. A tendon with a TensionProfile counts per unit of a factor on the whole
    profile.
    """

    tension: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    displacement: np.ndarray


class Derivatives:
    """What a Shape can say of how it changes."""

    if TYPE_CHECKING:
        _prepared: _core.PreparedRobot
        _solution: _core.Solution
        _pulled: Pulled | None
        _driven: bool

        @property
        def robot(self) -> Robot: ...

        @property
        def tip_orientation(self) -> np.ndarray: ...

        def sample(self, stations: Sequence[float]) -> Shape: ...

        def _require_convergence(self) -> None: ...

    def tip_jacobian(self, *, axes: Axes = "world") -> Jacobian:
        """Derivatives of the tip with respect to tensions, rotations, translations and displacements.

        The tip is the distal end of the robot, a material point: it moves with its tube. Where a tube's end
        or a step in its shape meets another breakpoint, the shape has a corner in its translation and the
        derivative is one-sided: where proximal ends meet each other or the guide's exit, for withdrawing.
        Raises NotConverged.
        """
        return self._jacobian((), axes, 0)

    def jacobian(self, s: float | Sequence[float] | np.ndarray, *, axes: Axes = "world") -> Jacobian:
        """The same for the points at s, (k,) m from the guide's exit, or one number.

        They stay at their s where tubes are pushed. Raises NotConverged, RobotError for an s off the robot.
        """
        return self._jacobian(_places(s), axes, 1 if np.ndim(s) == 0 else slice(1, None))

    def compliance(self, s: float | None = None, *, axes: Axes = "world") -> np.ndarray:
        """Motion of the point at s per wrench at it (force in N, then moment in N m), (6, 6), same axes.

        s: m from the guide's exit; None for the tip. The wrench acts on the innermost tube there; all
        actuators are held: rotations, translations, tensions, the motors of tendons pulled by displacements.
        Symmetric where all loads are dead forces and the shape follows from an energy. Raises
        NotConverged, RobotError for an s off the robot.
        """
        self._require_convergence()
        reach = max(tube.tip for tube in self.robot.tubes)
        place = reach if s is None else check.real("s", s, "m", least=0, most=reach)
        if place == 0.0:
            return np.zeros((6, 6))
        places = np.array([place] if place < reach else [])
        matrix, frames = self._compliance(places, place), self._frames_at(places, axes)
        return matrix if frames is None else _block(frames[-1]).T @ matrix @ _block(frames[-1])

    def _compliance(self, places: np.ndarray, place: float) -> np.ndarray:
        pulled, tendons = self._pulled, len(self.robot.tendons)
        follow = pulled is not None
        found = _core.sensitivities(self._prepared, self._solution, places, follow, follow, place, [])
        poses, lengths = np.split(found, [6 * (1 + len(places))])
        held = poses[-6:, -6:]
        if pulled is None:
            return held
        return held + poses[-6:, :tendons] @ followed_tensions(self.robot, pulled, lengths, -lengths[:, -6:])

    def sensitivity(
        self,
        parameters: Sequence[str],
        *,
        s: float | Sequence[float] | np.ndarray | None = None,
        axes: Axes = "world",
    ) -> np.ndarray:
        """Derivatives with respect to numbers of the robot's description, (6, parameters).

        parameters: paths such as "tubes.outer.length", "tubes.outer.material.E",
        "tubes.inner.precurvature.0.1.x", "tendons.pull.routing.radius", "loads.0.force.z",
        "tendons.pull.tension", "tendons.pull.compliance"; each in the unit that it has in the description.
        The motors of tendons pulled by displacements are held: their tensions follow. The mechanics is
        differentiated exactly; from the description to the kernel's tables by differences to 1e-10 (see
        ``tactr.statics.parameters``). s: m from the guide's exit, None for the tip, k places give (k, 6,
        parameters). Raises NotConverged; RobotError for an unknown path, or a shape of ``tactr.drive``.
        """
        self._require_convergence()
        if self._driven:
            raise RobotError(
                "parameters",
                "the tensions along this shape's tendons come from what was before it",
                "a shape of tactr.solve, or differences of tactr.drive",
                value=parameters,
            )
        places = np.array([]) if s is None else _places(s)
        outside, order = self._ordered(places)
        picked = np.zeros((1 + len(places), 6, len(parameters)))
        picked[[0, *(1 + order)]] = Rates(self.robot, parameters).poses(cast("Shape", self), outside)
        turned = _turned(picked, self._frames_at(places, axes))
        if s is None:
            return turned[0]
        return turned[1] if np.ndim(s) == 0 else turned[1:]

    def _ordered(self, places: Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The places beyond the guide's exit in ascending order, m, and where they stand in the given one."""
        s = np.asarray(places, dtype=float)
        reach = max(tube.tip for tube in self.robot.tubes)
        if s.size and not (np.isfinite(s).all() and s.min() >= 0.0 and s.max() <= reach * (1 + 1e-12)):
            worst = s[np.argmax(~((s >= 0) & (s <= reach)))]
            raise RobotError(
                "s", f"{check.show(float(worst), 'm')} is not on the robot", f"0 to {reach:g} m", value=worst
            )
        outside = np.flatnonzero(s > 0.0)
        order = outside[np.argsort(s[outside], kind="stable")]
        return np.minimum(s[order], reach), order

    def _jacobian(self, places: Sequence[float] | np.ndarray, axes: Axes, which: int | slice) -> Jacobian:
        tendons, tubes = len(self.robot.tendons), len(self.robot.tubes)
        self._require_convergence()
        outside, order = self._ordered(places)
        matrix = np.zeros((1 + len(places), 6, 2 * (tendons + tubes)))
        matrix[[0, *(1 + order)]] = actuator_rates(cast("Shape", self), outside)
        moved = _turned(matrix, self._frames_at(places, axes))[which]
        tension, displacement, rotation, translation = np.split(
            moved, np.cumsum([tendons, tendons, tubes]), axis=-1
        )
        return Jacobian(tension, rotation, translation, displacement)

    def _frames_at(self, places: Sequence[float] | np.ndarray, axes: Axes) -> np.ndarray | None:
        """Frames of the innermost tube at the tip, then at the places, (1 + k, 3, 3); None for world axes."""
        if check.choice("axes", axes, ("world", "body")) == "world":
            return None
        frames = [self.tip_orientation]
        for place in np.asarray(places, dtype=float):
            tubes = [tube for tube in self.sample([float(place)]).tubes if len(tube.s)]
            frames.append(tubes[-1].frames[0])
        return np.array(frames)


def _places(s: float | Sequence[float] | np.ndarray) -> np.ndarray:
    return np.atleast_1d(np.asarray(s, dtype=float))


def _block(frame: np.ndarray) -> np.ndarray:
    return np.kron(np.eye(2), frame)


def _turned(matrix: np.ndarray, frames: np.ndarray | None) -> np.ndarray:
    """Rows (k, 6, columns) from world axes to those of the frames (k, 3, 3)."""
    if frames is None:
        return matrix
    halves = matrix.reshape(len(frames), 2, 3, -1)
    return np.einsum("kba,khbc->khac", frames, halves).reshape(matrix.shape)
