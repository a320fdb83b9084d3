"""Results of one item that was solved by itself, as under displacements."""

from __future__ import annotations

import numpy as np

from tactr import _core
from tactr.statics.shape import Shape


def fill_from(shape: Shape, i: int, found: dict[str, np.ndarray], s: np.ndarray) -> None:
    """Writes a shape's numbers into row i of a batch's arrays; s (stations,) m."""
    found["residual"][i] = shape.residual
    found["discretisation_error"][i] = shape.discretisation_error
    if not shape.converged:
        return
    found["tip_position"][i] = shape.tip_position
    found["tip_quaternion"][i] = shape.tip_quaternion
    found["tendon_length"][i] = shape._solution.tendon_length
    found["tension"][i] = shape._solution.tension
    if "shape" in found:
        found["shape"][i] = shape.sample(s).centreline
    if "strain" in found:
        found["strain"][i] = _core.strain_maxima(shape._prepared, shape._solution, s)
    if "jacobian" in found:
        jacobian = shape.tip_jacobian()
        found["jacobian"][i] = np.hstack([jacobian.tension, jacobian.rotation, jacobian.translation])
        if "by_displacement" not in found:
            tendons = len(found["tension"][i])
            found["by_displacement"] = np.where(np.isnan(found["jacobian"][..., :tendons]), np.nan, 0.0)
        found["by_displacement"][i] = jacobian.displacement
    if "compliance" in found:
        found["compliance"][i] = shape.compliance()
    if "margin" in found:
        found["margin"][i], found["stable"][i] = shape.stability.margin, shape.stability.stable
    if "energy" in found:
        found["energy"][i] = shape.energy
