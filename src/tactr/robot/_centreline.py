"""Rest strains from a centreline, and back.

With a frame, u* is the vector of R^T R' and v* = R^T p'. Without one it is the frame that turns least: d3 =
p'/|p'|, d1' = -(d1 . d3') d3 (Bishop, There is more than one way to frame a curve, 1975), hence u* = (-d2 .
d3', d1 . d3', 0) and v* = |p'| e3.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._fit import basis
from tactr.robot.along import EDGE
from tactr.robot.stretch import powers_at, starts_of

if TYPE_CHECKING:
    from tactr.robot.rest import RestShape

DEGREE = 31
AIM, ROUGH = 1e-15, 1e-11
"""Last coefficients of a series, relative: below the first it is not halved, above the second refused."""

MOST_HALVINGS = 64
"""A span is at least this part of the length."""

E3 = np.array([0.0, 0.0, 1.0])
Curve = Callable[[float], np.ndarray]


class Found(NamedTuple):
    """(u*, v* - e3) and p* (m) as functions of s, length (m), where they are not smooth, R* at 0."""

    strains: Curve
    position: Curve
    length: float
    breaks: tuple[float, ...]
    frame: np.ndarray


def of_functions(position: Any, length: float, frame: Any, breaks: Sequence[float]) -> Found:
    """From p*(s) and R*(s). Raises RobotError."""
    length = check.real("length", length, "m", above=0)
    places = check.numbers("breaks", breaks, "m")
    check.increasing("breaks", places, "m")
    for k, place in enumerate(places):
        check.real(f"breaks[{k}]", place, "m", above=0, below=length)
    knots = (0.0, *places, length)
    p = _Smooth("position", lambda s: check.vector("position", position(s), "m"), knots, length)
    if frame is None:
        return framed_by_itself(p, knots)
    R = _Smooth("frame", lambda s: rotation("frame", frame(s)).ravel(), knots, 1.0)

    def strains(s: float) -> np.ndarray:
        turned = R(s).reshape(3, 3)
        return np.concatenate((_vector(turned.T @ R(s, 1).reshape(3, 3)), turned.T @ p(s, 1) - E3))

    return Found(strains, p, length, places, R(0.0).reshape(3, 3))


def rotation(field: str, value: Any) -> np.ndarray:
    """A rotation matrix (3, 3), checked."""
    rows = check.row(field, value, "a rotation matrix (3 x 3)")
    if len(rows) != 3:
        raise RobotError(field, f"{len(rows)} rows found", "a rotation matrix (3 x 3)", value=value)
    matrix = np.array([check.vector(f"{field}[{k}]", row) for k, row in enumerate(rows)])
    if not np.allclose(matrix.T @ matrix, np.eye(3), atol=1e-9) or np.linalg.det(matrix) < 0:
        raise RobotError(
            field, "its columns are no right-handed unit axes", "a rotation matrix, to 1e-9", value=value
        )
    return matrix


def _vector(skew: np.ndarray) -> np.ndarray:
    return 0.5 * np.array([skew[2, 1] - skew[1, 2], skew[0, 2] - skew[2, 0], skew[1, 0] - skew[0, 1]])


class _Smooth:
    """A function with its derivatives, from Chebyshev series of high degree on halved spans.

    Series are kept in Chebyshev form, and cut where rounding begins: second derivatives lose the fewest
    digits.
    """

    def __init__(
        self, field: str, function: Callable[[float], Any], knots: Sequence[float], scale: float
    ) -> None:
        self.starts: list[float] = []
        self.series: list[list[Any]] = []
        shortest = (knots[-1] - knots[0]) / MOST_HALVINGS
        waiting = list(pairwise(knots))[::-1]
        while waiting:
            first, last = waiting.pop()
            series, tail = _series(function, first, last)
            if tail > AIM * scale and last - first > shortest:
                middle = 0.5 * (first + last)
                waiting += [(middle, last), (first, middle)]
                continue
            if tail > ROUGH * scale:
                raise RobotError(
                    field,
                    f"it is too rough near s = {0.5 * (first + last):.6g} m",
                    "a smooth function, with the places where its derivatives jump in breaks=(...)",
                )
            self.starts.append(first)
            self.series.append([series, series.deriv(1), series.deriv(2)])

    def __call__(self, s: float, order: int = 0) -> np.ndarray:
        """The function (width,), or its first or second derivative."""
        k = max(0, bisect.bisect_right(self.starts, s) - 1)
        return self.series[k][order](s)


class _Series:
    """Chebyshev series of several components on one span."""

    def __init__(self, coefficients: np.ndarray, first: float, last: float) -> None:
        self.coefficients = coefficients
        self.first, self.last = first, last

    def deriv(self, order: int) -> _Series:
        scale = 2.0 / (self.last - self.first)
        return _Series(
            np.polynomial.chebyshev.chebder(self.coefficients, order, scl=scale), self.first, self.last
        )

    def __call__(self, s: float) -> np.ndarray:
        x = (2.0 * s - self.first - self.last) / (self.last - self.first)
        return np.asarray(np.polynomial.chebyshev.chebval(x, self.coefficients))


def _series(function: Callable[[float], Any], first: float, last: float) -> tuple[_Series, float]:
    """The series on a span, and the size of its last coefficients."""
    to_chebyshev = basis(DEGREE + 1).to_chebyshev
    edge = math.nextafter(last, first)  # a frame may jump at a break: it is read just before it
    places = first + (last - first) * basis(DEGREE + 1).nodes
    values = np.array([function(min(float(s), edge)) for s in places])
    coefficients = to_chebyshev @ values
    tail = float(np.max(np.abs(coefficients[-3:])))
    size = np.max(np.abs(coefficients), axis=1)
    kept = int(np.max(np.nonzero(size >= 4e-16 * size.max())[0])) + 1
    return _Series(coefficients[:kept], first, last), tail


Derivative = Callable[[float, int], np.ndarray]


class LeastTurning:
    """The frame that turns least along a curve p(t), integrated between ``knots``."""

    def __init__(self, p: Derivative, knots: Sequence[float]) -> None:
        from scipy.integrate import solve_ivp

        self.p = p
        self.knots = knots
        self.d1: list[Any] = []
        tangent = p(knots[0], 1) / np.linalg.norm(p(knots[0], 1))
        axis = np.array([1.0, 0.0, 0.0] if abs(tangent[0]) < 0.9 else [0.0, 1.0, 0.0])
        d1 = axis - tangent * (axis @ tangent)
        d1 /= np.linalg.norm(d1)
        for first, last in pairwise(knots):
            edge = math.nextafter(last, first)  # derivatives are read before the knot
            found = solve_ivp(
                lambda t, d1, edge=edge: self._turn(min(t, edge), d1),
                (first, last),
                d1,
                method="DOP853",
                rtol=1e-12,
                atol=1e-13,
                dense_output=True,
            )
            self.d1.append(found.sol)
            d1 = found.y[:, -1]

    def _tangent(self, t: float) -> tuple[np.ndarray, np.ndarray, float]:
        """d3, its derivative, and the speed."""
        rate, change = self.p(t, 1), self.p(t, 2)
        speed = float(np.linalg.norm(rate))
        d3 = rate / speed
        return d3, (change - d3 * (d3 @ change)) / speed, speed

    def _turn(self, t: float, d1: np.ndarray) -> np.ndarray:
        d3, turn, _ = self._tangent(t)
        return -(d1 @ turn) * d3

    def at(self, t: float) -> tuple[np.ndarray, np.ndarray, float]:
        """u* per unit of t, the frame R* (3, 3), and the speed."""
        d3, turn, speed = self._tangent(t)
        k = min(max(bisect.bisect_right(self.knots, t) - 1, 0), len(self.d1) - 1)
        d1 = self.d1[k](t)
        d1 = d1 - d3 * (d1 @ d3)
        d1 /= np.linalg.norm(d1)
        d2 = np.cross(d3, d1)
        return np.array([-(d2 @ turn), d1 @ turn, 0.0]), np.column_stack((d1, d2, d3)), speed


def framed_by_itself(p: Derivative, knots: Sequence[float]) -> Found:
    if min(float(np.linalg.norm(p(s, 1))) for s in np.linspace(knots[0], knots[-1], 65)) < 1e-3:
        raise RobotError("position", "it stands still somewhere", "a curve with |p*'| near 1")
    frames = LeastTurning(p, knots)

    def strains(s: float) -> np.ndarray:
        u, _, speed = frames.at(s)
        return np.array([*u, 0.0, 0.0, speed - 1.0])

    return Found(strains, lambda s: p(s, 0), knots[-1], tuple(knots[1:-1]), frames.at(0.0)[1])


def integrate(shape: RestShape, sigma: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centreline and frames of a rest shape at ascending ``sigma``. Raises RobotError."""
    from scipy.integrate import solve_ivp

    if sigma.ndim != 1 or not np.all(np.diff(sigma, prepend=0.0) >= 0) or np.any(sigma > shape.end + EDGE):
        raise RobotError(
            "sigma", "it is no ascending list", f"places from 0 to {check.show(shape.end, 'm')}", value=sigma
        )
    quantities = (*shape.u, *shape.v)
    last = float(sigma[-1]) if len(sigma) else 0.0
    ends = [*sorted(starts_of(quantities, last))[1:], last]
    state = np.concatenate((np.zeros(3), np.eye(3).ravel()))
    found, start = [], 0.0
    for end in ends:
        places = sigma[(sigma >= start) & ((sigma < end) | (end == last))]
        powers = powers_at(quantities, start)
        stops = np.unique([start, *np.minimum(places, end), end])
        if len(stops) > 1:
            march = solve_ivp(
                lambda s, y, powers=powers, start=start: _rates(powers, s - start, y),
                (start, end),
                state,
                method="DOP853",
                rtol=1e-12,
                atol=1e-14,
                t_eval=stops,
            )
            found.append(march.y.T[np.searchsorted(stops, np.minimum(places, end))])
            state = march.y[:, -1]
        else:
            found.append(np.tile(state, (len(places), 1)))
        start = end
    states = np.concatenate(found)
    return states[:, :3], states[:, 3:].reshape(-1, 3, 3)


def _rates(powers: np.ndarray, d: float, state: np.ndarray) -> np.ndarray:
    u, v = np.polynomial.polynomial.polyval(d, powers).reshape(2, 3)
    R = state[3:].reshape(3, 3)
    skew = np.array([[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]])
    return np.concatenate((R @ v, (R @ skew).ravel()))
