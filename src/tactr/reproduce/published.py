"""How much the paper's conditions at tube ends change a tip: they leave out the force of a tendon's kink."""

from __future__ import annotations

import numpy as np

from tactr import reference
from tactr.statics import Shape


def tip_apart(shape: Shape) -> float:
    """Distance (m) from the tip by the published conditions, eq:boundary_n and eq:boundary_m."""
    guess = np.array([tube.u[0] for tube in shape.tubes]), np.array([tube.v[0] for tube in shape.tubes])
    by_print = reference.solve(shape.robot, stations=2, guess=guess, transitions="published")
    return float(np.linalg.norm(by_print.tip - shape.tip_position))


def published_conditions(shape: Shape) -> str:
    """The same as a sentence."""
    apart = 1e3 * tip_apart(shape)
    if apart < 1e-3:
        return (
            "The paper's conditions at tube ends, as printed, give the same tip within 1 um: no tendon's "
            "direction jumps where a tube ends."
        )
    return (
        f"The paper's conditions at tube ends, as printed, put the tip {apart:.2f} mm away: they leave out "
        "the force with which a slanted tendon presses where the curvature jumps. Here that force is kept."
    )
