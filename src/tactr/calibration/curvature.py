"""Whether standard errors, which take the model for linear, can be trusted (Bates and Watts 1980)."""

from __future__ import annotations

import numpy as np

from tactr.calibration.identify import Knowledge
from tactr.calibration.measurements import Remark
from tactr.calibration.model import Model
from tactr.errors import RobotError

REACH = 2.0  # standard errors, about a 95 % interval
BENT = 0.25  # second over first differences of the predictions: beyond, intervals miss more than they say
SHARE = 0.3  # of a combination, for a number to be named


def rough_intervals(model: Model, values: np.ndarray, known: Knowledge) -> list[Remark]:
    """A remark where predictions bend over the combination of numbers that is known worst. The model ends at
    ``values`` (free,), SI units."""
    good = np.flatnonzero(known.identifiable)
    if not len(good):
        return []
    scales = np.array([free.scale for free in model.frees])[good]
    sizes, vectors = np.linalg.eigh(known.covariance[np.ix_(good, good)] / np.outer(scales, scales))
    step = np.zeros_like(values)
    step[good] = REACH * np.sqrt(max(sizes[-1], 0.0)) * vectors[:, -1] * scales
    if _bent(model, values, step) <= BENT:
        return []
    names = [model.frees[k].name for k, w in zip(good, vectors[:, -1], strict=True) if abs(w) > SHARE]
    text = (
        f"over two standard errors of {', '.join(names)} the model is far from linear: errors and intervals "
        "of these numbers are rough; other poses, priors or less free numbers help"
    )
    return [Remark("rough-intervals", text)]


def _bent(model: Model, values: np.ndarray, step: np.ndarray) -> float:
    """Second differences of all predictions over first ones; infinite where a step leads out of bounds."""
    for end in (values - step, values + step):
        if any(not free.lower <= x <= free.upper for free, x in zip(model.frees, end, strict=True)):
            return np.inf
    try:
        less, more = model.predict(values - step), model.predict(values + step)
    except RobotError:
        return np.inf
    finally:
        here = model.predict(values)
    both = np.isfinite(less) & np.isfinite(more) & np.isfinite(here)
    first = float(np.linalg.norm((more - less)[both]))
    return float(np.linalg.norm((more + less - 2 * here)[both])) / first if first > 0.0 else 0.0
