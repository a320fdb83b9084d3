"""The configurations of a study: a pure function of the study and their numbers."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from tactr.studies.axes import Range, Values
from tactr.studies.unit_samples import unit_samples

if TYPE_CHECKING:
    from tactr.studies.study import Study


def inputs(study: Study, start: int, stop: int) -> np.ndarray:
    """What varies of the configurations start to stop, (stop - start, vary), SI units."""
    numbers = np.arange(start, stop)
    values = np.empty((len(numbers), len(study.vary)))
    table = iter(np.unravel_index(numbers // study.samples_each, study.grid)) if study.grid else iter(())
    for k, axis in enumerate(study.vary):
        if isinstance(axis, Values):
            values[:, k] = np.array(axis.values)[next(table)]
    sampled = [k for k, axis in enumerate(study.vary) if isinstance(axis, Range)]
    if sampled:
        values[:, sampled] = _sampled(study, numbers % study.samples_each)
    return values


def _sampled(study: Study, numbers: np.ndarray) -> np.ndarray:
    """Values of the ranges of the samples of these numbers: ascending, but for starting again at 0."""
    u = _unit(study, numbers)
    low, high = (np.array([getattr(axis, end) for axis in study.ranges]) for end in ("low", "high"))
    values = low + u * (high - low)
    column = {axis.path: k for k, axis in enumerate(study.ranges)}
    for segment in study.segments:
        columns = [column[f"tubes.{study.robot.tubes[i].name}.translation"] for i in segment.tubes]
        values[:, columns] = segment.chain.points(u[:, columns])
    return values


def _unit(study: Study, numbers: np.ndarray) -> np.ndarray:
    samples, dimensions = study.samples, len(study.ranges)
    assert samples is not None
    cuts = [0, *(np.flatnonzero(np.diff(numbers) != 1) + 1), len(numbers)]
    parts = [
        unit_samples(
            samples.method, samples.seed, samples.count, dimensions, int(numbers[a]), int(numbers[b - 1]) + 1
        )
        for a, b in pairwise(cuts)
    ]
    return np.concatenate(parts)
