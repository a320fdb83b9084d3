"""Solve a stretch of a study's configurations: what every process of a sweep does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tactr.studies.axes import actuator
from tactr.studies.quantities import array_name, arrays_of

if TYPE_CHECKING:
    from tactr.studies.study import Study

Arrays = dict[str, np.ndarray]


def solved(study: Study, start: int, stop: int, threads: int | None = None) -> Arrays:
    """Everything that is kept of the configurations start to stop, sample first. Raises RobotError."""
    from tactr.batch import solve_batch

    values = study.inputs(start, stop)
    actuation: dict[str, Arrays] = {}
    parameters: Arrays = {}
    for k, axis in enumerate(study.vary):
        place = actuator(study.robot, axis.path)
        if place is None:
            parameters[axis.path] = values[:, k]
        else:
            name = axis.path.split(".", 1)[1].rpartition(".")[0]
            actuation.setdefault(place[0], {})[name] = values[:, k]
    batch = solve_batch(
        study.robot,
        **actuation,  # pyright: ignore[reportArgumentType]
        parameters=parameters,
        outputs=study.outputs,
        stations=study.stations,
        tolerance=study.tolerance,
        threads=threads,
    )
    inputs = {array_name(axis.path): values[:, k] for k, axis in enumerate(study.vary)}
    return {**inputs, **arrays_of(batch, study)}
