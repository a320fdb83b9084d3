"""Whether a shape is stable, and how far from the limit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tactr import _core

NEAR_THE_LIMIT = 0.1  # margin below which a shape may snap on a small change


@dataclass(frozen=True, repr=False, eq=False)
class Stability:
    """Stability of an equilibrium by the second variation of its energy.

    stable: no small change lowers the energy. margin: the smallest scaled determinant along the robot, 1 for
    an unloaded or straight robot and 0 at the limit of snapping or buckling; for an unstable shape 0 or the
    smallest determinant, whichever is less; NaN where it is not ``known``. s (k,) m from the guide's exit,
    ascending, negative inside the guide; determinant (k,): det D(s), 1 at the tip, where D(s) = d(angles of
    the tubes and orientation of the section at s)/d(their values at the free ends). conjugate_points (c,):
    the s where D loses a rank, once for each rank; there are as many as directions in which the energy falls.

    Two directions of buckling that come together, as of a round rod, make the determinant a square: the
    margin is then a square, too. Loads in body axes turn with the robot and moments in world axes do work
    that depends on the way: neither has an energy, so that a conjugate point then means loss of stability
    by divergence only, and flutter is not seen. Without loads a single tube is always stable.
    Source: Morse's index theorem; Ha, Park, Dupont, "Elastic stability of concentric tube robots subject to
    external loads", IEEE Trans. Biomed. Eng. 63 (2016), for concentric tubes.
    """

    stable: bool
    margin: float
    s: np.ndarray
    determinant: np.ndarray
    conjugate_points: np.ndarray

    @property
    def known(self) -> bool:
        """Whether it could be told. Not where a tube is all but crushed: its sections then have no
        equilibrium beside their own; stable is False, margin NaN, and the arrays are empty."""
        return not math.isnan(self.margin)

    @property
    def near_limit(self) -> bool:
        """Stable, with a margin below 0.1."""
        return self.stable and self.margin < NEAR_THE_LIMIT

    def __str__(self) -> str:
        """In words: stable or not, the margin, and a warning where there is reason for one."""
        if not self.known:
            return (
                "stability not known: sections all but crushed have no equilibrium beside their own; lower "
                "the tensions and loads"
            )
        if self.near_limit:
            return (
                f"stable, margin {self.margin:.3g}: near the limit, a small change may make it snap or buckle"
            )
        if self.stable:
            return f"stable, margin {self.margin:.3g}"
        points = len(self.conjugate_points)
        ways = (
            f"{points} direction{'' if points == 1 else 's'} of falling energy" if points else "at the limit"
        )
        return f"unstable ({ways}): a real robot does not stay in this shape, it snaps or buckles"

    def __repr__(self) -> str:
        at = ", ".join(f"{s * 1e3:.2f}" for s in self.conjugate_points)
        points = f", conjugate points at s = {at} mm" if at else ""
        if not self.known:
            return "<Stability: not known>"
        return f"<Stability: {'stable' if self.stable else 'unstable'}, margin {self.margin:.4g}{points}>"


SAMPLES = 8  # of the determinant per step of the kernel


def stability_of(prepared: _core.PreparedRobot, solution: _core.Solution) -> Stability:
    """Stability of a converged solution."""
    try:
        return Stability(*_core.stability(prepared, solution, SAMPLES))
    except RuntimeError:  # the Jacobi field was not found
        return Stability(False, math.nan, *np.empty((3, 0)))


def is_stable_at_tensions(prepared: _core.PreparedRobot, solution: _core.Solution) -> bool:
    """As ``stability_of(...).stable``, in less time."""
    try:
        return bool(_core.stability(prepared, solution, 0)[0])
    except RuntimeError:
        return False
