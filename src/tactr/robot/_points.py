"""Rest strains from sampled points of a centreline, with or without frames."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._centreline import E3, Found, LeastTurning, framed_by_itself, rotation


def of_points(points: Any, sigma: Any, frames: Any, smoothing: Any) -> Found:
    """From samples. Raises RobotError."""
    entries = check.row("points", points, "(x, y, z) in m")
    rows = np.array([check.vector(f"points[{k}]", row, "m") for k, row in enumerate(entries)])
    if len(rows) < 4:
        raise RobotError("points", f"{len(rows)} points found", "at least 4", value=points)
    gaps = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    if not np.all(gaps > 0):
        k = int(np.argmin(gaps)) + 1
        raise RobotError(
            f"points[{k}]", "it is the point before it again", "points that differ", value=points
        )
    smoothing = check.real("smoothing", smoothing, "m", least=0)
    if sigma is None:
        if frames is not None:
            raise RobotError("sigma", "frames are given without it", "the arc length in m of every frame")
        return _through_points(rows, smoothing)
    if smoothing:
        raise RobotError("smoothing", "it is given together with sigma", "one of the two", value=smoothing)
    places = check.numbers("sigma", sigma, "m", fewest=len(rows), most=len(rows))
    check.starts("sigma", places)
    return _at_places(rows, np.array(places), frames)


def _degree(count: int) -> int:
    return 5 if count >= 6 else 3


def _through_points(rows: np.ndarray, smoothing: float) -> Found:
    """A spline over chord length, its arc length by Gauss quadrature on every span."""
    from scipy.interpolate import BSpline, splprep

    chord = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))))
    (t, c, k), _ = splprep(rows.T, u=chord, k=_degree(len(rows)), s=len(rows) * smoothing**2)
    spline = BSpline(t, np.array(c).T, k)
    orders = [spline, spline.derivative(1), spline.derivative(2)]

    def p(place: float, order: int) -> np.ndarray:
        return orders[order](place)

    knots = np.unique(t)
    length = _ArcLength(orders[1], knots)
    frames = LeastTurning(p, tuple(knots))

    def strains(s: float) -> np.ndarray:
        u, _, speed = frames.at(length.place(s))
        return np.array([*(u / speed), 0.0, 0.0, 0.0])

    return Found(
        strains,
        lambda s: spline(length.place(s)),
        float(length.at_knots[-1]),
        tuple(float(s) for s in length.at_knots[1:-1]),
        frames.at(0.0)[1],
    )


class _ArcLength:
    """Arc length of a curve over its parameter, and back by Newton's method."""

    def __init__(self, rate: Any, knots: np.ndarray) -> None:
        self.rate = rate
        self.knots = knots
        self.nodes, self.weights = np.polynomial.legendre.leggauss(24)
        lengths = [self._between(*span) for span in pairwise(knots)]
        self.at_knots = np.concatenate(([0.0], np.cumsum(lengths)))

    def _between(self, first: float, last: float) -> float:
        half = 0.5 * (last - first)
        speeds = np.linalg.norm(self.rate(first + half * (self.nodes + 1)), axis=1)
        return float(half * (self.weights @ speeds))

    def place(self, s: float) -> float:
        """The parameter at arc length ``s`` (m)."""
        k = int(np.clip(np.searchsorted(self.at_knots, s, side="right") - 1, 0, len(self.knots) - 2))
        first, last = self.knots[k], self.knots[k + 1]
        share = (s - self.at_knots[k]) / (self.at_knots[k + 1] - self.at_knots[k])
        t = first + (last - first) * share
        for _ in range(20):
            step = (self.at_knots[k] + self._between(first, t) - s) / np.linalg.norm(self.rate(t))
            t = min(max(t - step, first), last)
            if abs(step) < 1e-14 * self.knots[-1]:
                break
        return float(t)


def _at_places(rows: np.ndarray, places: np.ndarray, frames: Any) -> Found:
    """Splines over the arc length given."""
    from scipy.interpolate import make_interp_spline
    from scipy.spatial.transform import Rotation, RotationSpline

    spline = make_interp_spline(places, rows, k=_degree(len(rows)))
    orders = [spline, spline.derivative(1), spline.derivative(2)]
    if frames is None:
        return framed_by_itself(lambda s, order: orders[order](s), tuple(float(s) for s in places))
    entries = check.row("frames", frames, "a rotation matrix (3 x 3) for every point")
    if len(entries) != len(rows):
        raise RobotError("frames", f"{len(entries)} frames for {len(rows)} points", "one for every point")
    matrices = np.array([rotation(f"frames[{k}]", frame) for k, frame in enumerate(entries)])
    turned = RotationSpline(places, Rotation.from_matrix(matrices))

    def strains(s: float) -> np.ndarray:
        R = turned(s).as_matrix()
        # the spline's angular rate is in the axes that turn
        return np.concatenate((turned(s, 1), R.T @ orders[1](s) - E3))

    inside = tuple(float(s) for s in places[1:-1])
    return Found(strains, spline, float(places[-1]), inside, matrices[0])
