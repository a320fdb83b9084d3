"""Rest shapes: what a tube looks like when nothing acts on it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._along_fit import TOLERANCE, Parts, fit_along
from tactr.robot.along import Along

if TYPE_CHECKING:
    from tactr.robot._centreline import Found

REPRODUCED = 1e-7
"""Largest distance of a rest shape from the centreline that it was made from, relative to the length."""

Quantity = float | Along
Quantities = tuple[Quantity, Quantity, Quantity]
Points = Sequence[Sequence[float]] | np.ndarray


@dataclass(frozen=True)
class RestShape:
    """Rest strains of a tube, in its own material frame, over its own arc length sigma.

    u: rest curvature and twist u* in 1/m; v: rest shear and stretch v*, (0, 0, 1) for none, v_z above 0. Each
    component is a number or an Along. Without load the tube's centreline and frame are p' = R v*, R' = R
    [u*]. Raises RobotError.
    """

    u: Quantities = (0.0, 0.0, 0.0)
    v: Quantities = (0.0, 0.0, 1.0)

    if TYPE_CHECKING:  # any sequence is taken; tuples are stored

        def __init__(
            self,
            u: Sequence[Quantity] | np.ndarray = (0.0, 0.0, 0.0),
            v: Sequence[Quantity] | np.ndarray = (0.0, 0.0, 1.0),
        ) -> None: ...

    def __post_init__(self) -> None:
        with check.owned("RestShape"):
            check.store(self, u=_components("u", self.u, "1/m"), v=_components("v", self.v, ""))
            stretch = self.v[2]
            if not isinstance(stretch, Along):
                check.real("v[2]", stretch, above=0)

    @property
    def end(self) -> float:
        """Where the first of the components stops being defined, m; infinite where none does."""
        return min((q.end for q in (*self.u, *self.v) if isinstance(q, Along)), default=math.inf)

    @classmethod
    def helix(cls, radius: float, pitch: float, *, start: float = 0.0) -> RestShape:
        """A helix of ``radius`` and ``pitch`` (rise of one turn; negative is left-handed; 0: a circle), in m.

        u* = (k, 0, t) with curvature k = r / (r^2 + c^2), torsion t = c / (r^2 + c^2), c = pitch / (2 pi),
        exact and constant: the material frame turns with the curve, x along its binormal and -y along its
        normal, so that a straight tendon keeps its side of the coil. start: m, the tube is straight before
        it. Raises RobotError. Source: do Carmo, Differential Geometry of Curves and Surfaces, section 1.5.
        """
        with check.owned("RestShape.helix"):
            radius = check.real("radius", radius, "m", above=0)
            rise = check.real("pitch", pitch, "m") / (2 * math.pi)
            begin = check.real("start", start, "m", least=0)
        square = radius**2 + rise**2
        u = (radius / square, 0.0, rise / square)
        return (
            cls(u) if begin == 0 else cls(tuple(Along.steps((0.0, begin), (0.0, c)) if c else c for c in u))
        )

    @classmethod
    def from_centreline(
        cls,
        position: Callable[[float], Sequence[float] | np.ndarray],
        length: float,
        *,
        frame: Callable[[float], Sequence[Sequence[float]] | np.ndarray] | None = None,
        breaks: Sequence[float] = (),
        start: float = 0.0,
    ) -> RestShape:
        """The rest shape whose centreline is ``position`` (s -> p*, m), s from 0 to ``length`` (m).

        frame: s -> R* (3 x 3, columns d1, d2, d3 in the axes of p*), the material frame; then u* = (R*^T R*')
        as a vector and v* = R*^T p*'. Without it, the frame that turns least (d3 along p*', no twist), and
        v* = (0, 0, |p*'|). s is the material's arc length: |p*'| other than 1 is a rest stretch. breaks:
        places in m where p*'' or R*' jumps. start: m, where on the tube it begins; straight before. The fit
        of u* and v* is off by at most 1e-9 of their sizes; that its centreline keeps within 1e-7 of the
        length of p* is checked. Raises RobotError. Source: the procedure of Moradkhani et al. 2025 (ExoNav
        II): u*, v* from p*, R*.
        """
        from tactr.robot._centreline import of_functions

        with check.owned("RestShape.from_centreline"):
            return cls._fitted(of_functions(position, length, frame, breaks), start)

    @classmethod
    def from_points(
        cls,
        points: Points,
        *,
        sigma: Sequence[float] | np.ndarray | None = None,
        frames: Sequence[Points] | np.ndarray | None = None,
        smoothing: float = 0.0,
        start: float = 0.0,
    ) -> RestShape:
        """The rest shape through ``points`` (n, 3) in m, at least 4, by a quintic spline (cubic below 6).

        Its length is the spline's own, and v* = (0, 0, 1), unless ``sigma`` (n,) in m gives the arc length of
        every point, from 0 on. frames: (n, 3, 3), R* at every point, joined by a rotation spline; needs
        ``sigma``; without them the frame turns least. smoothing: m, the root mean square distance that the
        spline may keep from measured points (only without ``sigma``). start, tolerances, errors as in
        from_centreline.
        """
        from tactr.robot._points import of_points

        with check.owned("RestShape.from_points"):
            return cls._fitted(of_points(points, sigma, frames, smoothing), start)

    @classmethod
    def _fitted(cls, found: Found, start: float) -> RestShape:
        begin, length = check.real("start", start, "m", least=0), found.length
        sizes = [1.0 / length] * 3 + [1.0] * 3
        fitted = fit_along(found.strains, 6, length, breaks=found.breaks, start=begin, least_size=sizes)
        rests = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
        u1, u2, u3, v1, v2, v3 = (
            _along(parts, rest, begin, length, TOLERANCE * size)
            for parts, rest, size in zip(fitted, rests, sizes, strict=True)
        )
        shape = cls((u1, u2, u3), (v1, v2, v3))
        places = np.linspace(0.0, length, 33)
        there = np.array([found.position(s) for s in places]) - found.position(0.0)
        here = shape.centreline(begin + places)[0] - np.array([0.0, 0.0, begin])
        miss = float(np.max(np.linalg.norm(here @ found.frame.T - there, axis=1)))
        if not miss <= REPRODUCED * length:
            raise RobotError(
                "position",
                f"the rest strains found miss it by {check.show(miss, 'm')}",
                "a smoother centreline, kinks of its curvature in breaks",
                value=miss,
            )
        return shape

    def centreline(self, sigma: Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Centreline (n, 3) in m and frames (n, 3, 3) at ascending ``sigma`` (n,), m, from p = 0, R = I at 0.

        What the tube does without load, integrated to about 1e-11 of the length. Raises RobotError.
        """
        from tactr.robot._centreline import integrate

        return integrate(self, np.asarray(sigma, dtype=float))


def _components(field: str, value: object, unit: str) -> Quantities:
    expected = f"three numbers or Alongs{f' in {unit}' if unit else ''}"
    entries = check.row(field, value, expected)
    if len(entries) != 3:
        raise RobotError(field, f"{len(entries)} entries found", expected, value=value)
    x, y, z = (
        entry if isinstance(entry, Along) else check.real(f"{field}[{k}]", entry, unit)
        for k, entry in enumerate(entries)
    )
    return x, y, z


def _along(parts: Parts, rest: float, begin: float, length: float, negligible: float) -> Quantity:
    """A component from the fit of its difference from ``rest``; a number where that is negligible."""
    if all(len(powers) == 1 and abs(powers[0]) <= negligible for _, powers in parts):
        return rest
    before = [(0.0, (rest,))] if begin > 0 else []
    moved = [(start, (powers[0] + rest, *powers[1:])) for start, powers in parts]
    return Along([*before, *moved], begin + length)
