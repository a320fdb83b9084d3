"""The result of a solve: always there, with a status; its geometry only when it converged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr import _core
from tactr.errors import NotConverged
from tactr.robot import Robot
from tactr.statics.derivatives import Derivatives
from tactr.statics.frames import rotation_matrices, turned_about_z
from tactr.statics.mechanics import Mechanics
from tactr.statics.pulling import Pulling
from tactr.statics.pulls import Pulled
from tactr.statics.rest import RestState
from tactr.statics.stability import Stability, stability_of
from tactr.statics.stations import Stations, station_places
from tactr.statics.status import Status, explain, status_of, told_of_history, told_with_pulls

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False, eq=False)
class TubeShape:
    """One tube along the stations where it is, k of them; s is arc length from the guide's exit.

    name; s, sigma (k,) m; position (k, 3) m and frames (k, 3, 3) (columns d1, d2, d3), world axes; psi (k,)
    rad, angle of the material frame from the twist-free frame; u (k, 3) curvature and twist 1/m, v (k, 3)
    shear and stretch, n (k, 3) internal force N, m (k, 3) internal moment N m, all in the tube's own
    material frame.
    """

    name: str
    s: np.ndarray
    sigma: np.ndarray
    position: np.ndarray
    frames: np.ndarray
    psi: np.ndarray
    u: np.ndarray
    v: np.ndarray
    n: np.ndarray
    m: np.ndarray

    def __repr__(self) -> str:
        return f"<TubeShape {self.name!r}: {len(self.s)} stations>"


@dataclass(frozen=True, repr=False, eq=False)
class TendonShape:
    """One tendon along the stations where it runs outside the guide, k of them.

    name; tube: where it ends; s (k,) m; path (k, 3) m, world axes; tension (k,) N; length: m, of the
    deformed tendon from its tube's proximal end to its termination; displacement: m, what its motor pulls,
    None where it is pulled by a tension (see ``Shape.displacement``); slack: it has a displacement, and no
    tension.
    """

    name: str
    tube: str
    s: np.ndarray
    path: np.ndarray
    tension: np.ndarray
    length: float
    displacement: float | None = None
    slack: bool = False

    def __repr__(self) -> str:
        state = ", slack" if self.slack else ""
        return f"<TendonShape {self.name!r}: length {self.length * 1e3:.3f} mm{state}>"


class Shape(Mechanics, Derivatives, Pulling):
    """The shape of a robot under given actuation, or why there is none.

    Always readable: robot, status, converged, message, residual, residual_tolerance, iterations,
    discretisation_error, tolerance, solve_time, displacement_error. The geometry raises NotConverged unless
    converged. World frame: z along the guide, which the robot leaves at s = 0.
    """

    def __init__(
        self,
        prepared: _core.PreparedRobot,
        solution: _core.Solution,
        *,
        base: Robot,
        actuation: dict[str, Any],
        tolerance: float,
        residual_tolerance: float,
        stations: Stations,
        solve_time: float,
        pulled: Pulled | None = None,
        rest: Callable[[], RestState],
        driven: bool = False,
    ) -> None:
        self.tolerance = tolerance
        self.residual_tolerance = residual_tolerance
        self.solve_time = solve_time
        self._prepared = prepared
        self._solution = solution
        self._base = base
        self._actuation = actuation
        self._stations = stations
        self._pulled = pulled
        self._rest = rest
        self._driven = driven  # with friction and backlash, from what came before

    @cached_property
    def robot(self) -> Robot:
        """The robot at the actuation that was solved."""
        return self._base.with_actuation(**self._actuation) if self._actuation else self._base

    @property
    def status(self) -> Status:
        """How the solve ended."""
        return status_of(self._solution, self._pulled)

    @property
    def converged(self) -> bool:
        """True when every scaled residual, the discretisation error and what is missing in displacements are
        below their tolerances."""
        return self._solution.status == 0 and (self._pulled is None or self._pulled.met)

    @property
    def message(self) -> str:
        """What happened; for a failure its cause and remedy."""
        text = explain(self.status, self._solution, self.tolerance)
        if self._pulled is not None:
            text = told_with_pulls(text, self.status, self._pulled, self._base)
        return f"{text}{told_of_history(self._base, self._driven)}"

    @property
    def residual(self) -> float:
        """Largest scaled residual: base orientation (rad) and the equilibrium of every section (relative)."""
        return max(self._solution.base_residual, self._solution.section_residual)

    @property
    def iterations(self) -> int:
        """Marches with derivatives that the solve took."""
        return self._solution.iterations if self._pulled is None else self._pulled.marches

    @property
    def tip_position(self) -> np.ndarray:
        """Position of the distal end, (3,), m, world axes."""
        self._require_convergence()
        return self._solution.tip_position

    @property
    def tip_quaternion(self) -> np.ndarray:
        """Orientation of the innermost tube that reaches the distal end, (4,) w, x, y, z, world axes."""
        self._require_convergence()
        return self._solution.tip_quaternion

    @property
    def tip_orientation(self) -> np.ndarray:
        """The same as a rotation matrix, (3, 3)."""
        return rotation_matrices(self.tip_quaternion)

    @cached_property
    def stability(self) -> Stability:
        """Whether the shape is stable at its tensions, and how far from the limit of snapping or buckling."""
        self._require_convergence()
        return stability_of(self._prepared, self._solution)

    @cached_property
    def potential_energy(self) -> float:
        """Potential energy, J: of the tubes and the springs that turn them, of every tendon (tension times
        length) and of dead forces.

        Its zero is the robot with unstrained tubes and no tendons, the forces at the guide's exit. Moments
        and loads in body axes have no potential and do not count.
        """
        self._require_convergence()
        return _core.potential_energy(self._prepared, self._solution)

    @cached_property
    def s(self) -> np.ndarray:
        """Arc length of the stations from the guide's exit, (k,), m."""
        return station_places(self.robot, self._stations)

    @property
    def centreline(self) -> np.ndarray:
        """Centreline at the stations, (k, 3), m, world axes."""
        return self._samples["position"]

    @property
    def theta(self) -> np.ndarray:
        """Angle of every tube from the outermost tube present, (tubes, k), rad; 0 where a tube is absent."""
        psi, present = self._samples["psi"][..., 0], self._samples["present"] > 0
        first = np.argmax(present, axis=0)
        return np.where(present, psi - psi[first, np.arange(psi.shape[1])], 0.0)

    @cached_property
    def tubes(self) -> tuple[TubeShape, ...]:
        """Every tube, outermost first."""
        return tuple(self._tube(i) for i in range(len(self.robot.tubes)))

    @cached_property
    def tendons(self) -> tuple[TendonShape, ...]:
        """Every tendon."""
        return tuple(self._tendon(j) for j in range(len(self.robot.tendons)))

    @cached_property
    def transition_points(self) -> tuple[np.ndarray, np.ndarray]:
        """Where a tube ends before the robot does: points (k, 3) in m, world axes, and their s (k,) in m."""
        tips = sorted({tube.tip for tube in self.robot.tubes})[:-1]
        if not tips:
            self._require_convergence()
            return np.empty((0, 3)), np.empty(0)
        return self.sample(tips).centreline, np.array(tips)

    def sample(self, stations: Stations) -> Shape:
        """The same shape at other stations, ascending, m in [0, length]."""
        self._require_convergence()
        return Shape(
            self._prepared,
            self._solution,
            base=self._base,
            actuation=self._actuation,
            tolerance=self.tolerance,
            residual_tolerance=self.residual_tolerance,
            stations=station_places(self.robot, stations),
            solve_time=self.solve_time,
            pulled=self._pulled,
            rest=self._rest,
            driven=self._driven,
        )

    def plot(self, path: str | Path | None = None) -> Figure:
        """A picture: 3D and two projections; saved to path where given."""
        from tactr.plotting import plot_shape

        return plot_shape(self, path)

    def to_xarray(self) -> xarray.Dataset:
        """Everything as a labelled dataset (extra: netcdf)."""
        from tactr.io.results import to_xarray

        return to_xarray(self)

    def save(self, path: str | Path) -> None:
        """Writes the dataset to a netCDF-4 file (extra: netcdf)."""
        from tactr.io.results import save

        save(self, path)

    def __repr__(self) -> str:
        if not self.converged:
            return f"<Shape of {self.robot.name or 'robot'}: {self.status.value}; {self.message}>"
        x, y, z = self.tip_position * 1e3
        return (
            f"<Shape of {self.robot.name or 'robot'}: tip ({x:.3f}, {y:.3f}, {z:.3f}) mm, "
            f"residual {self.residual:.0e}, discretisation {self.discretisation_error:.0e} m>"
        )

    @cached_property
    def _samples(self) -> dict[str, Any]:
        self._require_convergence()
        return _core.sample(self._prepared, self._solution, self.s)

    def _require_convergence(self) -> None:
        if not self.converged:
            raise NotConverged(self.message, shape=self)

    @cached_property
    def _frames(self) -> np.ndarray:
        """Material frames of every tube at every station, (tubes, k, 3, 3)."""
        shared = rotation_matrices(self._samples["quaternion"])
        return turned_about_z(shared, self._samples["psi"][..., 0])

    def _tube(self, i: int) -> TubeShape:
        tube = self.robot.tubes[i]
        data = self._samples
        here = data["present"][i] > 0
        return TubeShape(
            name=tube.name,
            s=self.s[here],
            sigma=self.s[here] - tube.translation,
            position=self.centreline[here],
            frames=self._frames[i][here],
            psi=data["psi"][i, here, 0],
            u=data["u"][i, here],
            v=data["v"][i, here],
            n=data["n"][i, here],
            m=data["m"][i, here],
        )

    def _tendon(self, j: int) -> TendonShape:
        tendon = self.robot.tendons[j]
        records = self._samples["tendon"][j]
        here = np.flatnonzero(records[:, 0] >= 0)
        frames = self._frames[records[here, 0].astype(int), here]
        offset = np.einsum("kab,kb->ka", frames[..., :2], records[here, 1:3])
        return TendonShape(
            name=tendon.name,
            tube=tendon.tube,
            s=self.s[here],
            path=self.centreline[here] + offset,
            tension=records[here, 3],
            length=float(self._solution.tendon_length[j]),
            displacement=tendon.displacement,
            slack=tendon.displacement is not None and bool(self._solution.tension[j] == 0.0),
        )
