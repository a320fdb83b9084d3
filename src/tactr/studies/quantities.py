"""What is kept of every configuration, and how it is called in the store."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.io.path_kinds import kind_of
from tactr.studies.axes import actuator

if TYPE_CHECKING:
    from tactr.batch import Batch
    from tactr.studies.study import Study

SAMPLE = "sample"
NOT_DONE = -1  # status and stability of a configuration that was not solved yet
LABELS = {
    "axis": ("x", "y", "z"),
    "component": ("w", "x", "y", "z"),
    "pose": ("x", "y", "z", "rx", "ry", "rz"),
    "wrench": ("fx", "fy", "fz", "mx", "my", "mz"),
    "strain_component": ("u_x", "u_y", "u_z", "v_x", "v_y", "v_z"),
}


@dataclass(frozen=True)
class Quantity:
    """One array of the store: its dimensions after "sample", its unit, what it is."""

    dims: tuple[str, ...]
    units: str
    text: str


QUANTITIES = {
    "status": Quantity((), "1", "how the solve ended, see status_names; -1: not solved yet"),
    "tip_position": Quantity(("axis",), "m", "position of the tip, world axes"),
    "tip_quaternion": Quantity(("component",), "1", "orientation of the tip, w x y z, world axes"),
    "residual": Quantity((), "1", "largest scaled residual"),
    "discretisation_error": Quantity((), "m", "discretisation error at the tip"),
    "tendon_length": Quantity(("tendon",), "m", "length from the proximal end of its tube"),
    "tension": Quantity(("tendon",), "N", "tension at the motor"),
    "stable": Quantity((), "1", "1: stable, 0: unstable, -1: no shape"),
    "stability_margin": Quantity((), "1", "1: as unloaded, 0: at the limit of snapping or buckling"),
    "jacobian": Quantity(
        ("pose", "actuator"), "m or rad per N, rad or m", "motion of the tip per actuator, world axes"
    ),
    "compliance": Quantity(
        ("pose", "wrench"), "m or rad per N or N m", "motion of the tip per wrench at it, world axes"
    ),
    "energy": Quantity((), "J", "elastic strain energy of all tubes"),
    "centreline": Quantity(("station", "axis"), "m", "centreline at the stations, world axes"),
    "s": Quantity(("station",), "m", "arc length of the stations from the guide's exit"),
    "strain": Quantity(
        ("tube", "strain_component"), "1/m and 1", "largest |u - u*| and |v - v*| along each tube, own frame"
    ),
}


def array_name(path: str) -> str:
    """The array of a number that varies: its path, without what would be a folder."""
    return path.replace("/", "_")


def input_quantity(study: Study, path: str) -> Quantity:
    """What an array of a number that varies is."""
    return Quantity((), kind_of(study.robot, path).si_unit, path)


def labels(study: Study) -> dict[str, tuple[str, ...]]:
    """Names along each dimension that has any."""
    robot = study.robot
    return {
        **LABELS,
        "tube": tuple(tube.name for tube in robot.tubes),
        "tendon": tuple(tendon.name for tendon in robot.tendons),
        "actuator": actuators(study),
    }


def actuators(study: Study) -> tuple[str, ...]:
    """The columns of the Jacobian: every tendon, by its displacement where it is pulled so, then the tubes'
    rotations and translations."""
    robot = study.robot
    pulled = [f"tendons.{t.name}.{_pulled_by(study, j)}" for j, t in enumerate(robot.tendons)]
    moved = [f"tubes.{tube.name}.{field}" for field in ("rotation", "translation") for tube in robot.tubes]
    return (*pulled, *moved)


def _pulled_by(study: Study, tendon: int) -> str:
    for axis in study.vary:
        place = actuator(study.robot, axis.path)
        if place is not None and place in (("tension", tendon), ("displacement", tendon)):
            return place[0]
    return "tension" if study.robot.tendons[tendon].displacement is None else "displacement"


def arrays_of(batch: Batch, study: Study) -> dict[str, np.ndarray]:
    """The arrays of a batch, sample first; those that it does not have are left out."""
    found = {
        "status": batch.status,
        "tip_position": batch.tip_position,
        "tip_quaternion": batch.tip_quaternion,
        "residual": batch.residual,
        "discretisation_error": batch.discretisation_error,
        "energy": batch.energy,
        "compliance": batch.compliance,
        "centreline": batch.centreline,
        "s": batch.s,
        "strain": batch.strain,
        "stability_margin": batch.margin,
    }
    if study.robot.tendons:
        found |= {"tendon_length": batch.tendon_length, "tension": batch.tension}
    if batch.stable is not None:
        found["stable"] = np.where(batch.converged, batch.stable, NOT_DONE).astype(np.int8)
    if batch.jacobian is not None:
        by = {"tension": batch.jacobian.tension, "displacement": batch.jacobian.displacement}
        pulled = [by[_pulled_by(study, j)][..., j] for j in range(len(study.robot.tendons))]
        moved = [batch.jacobian.rotation, batch.jacobian.translation]
        found["jacobian"] = np.concatenate([*(column[..., None] for column in pulled), *moved], axis=-1)
    return {name: found[name] for name in QUANTITIES if found.get(name) is not None}  # pyright: ignore
