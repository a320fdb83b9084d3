"""Routings through points and from Python functions."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._fit import fit
from tactr.robot.piece import RoutingPiece, clip, evaluate
from tactr.robot.routing import Routing


class _Stored(Routing):
    """Routings whose pieces are worked out once, on a finite domain."""

    _pieces: tuple[RoutingPiece, ...]

    @property
    def domain(self) -> tuple[float, float]:
        return self._pieces[0].start, self._pieces[-1].end

    def pieces(self, length: float, *, start: float = 0.0) -> tuple[RoutingPiece, ...]:
        begin, end = self._span(length, start)
        # a span that passes the domain's ends by rounding is still covered to its last digit
        inside = list(clip(self._pieces, begin, end)) or [self._pieces[-1].cut(begin, end)]
        inside[0] = inside[0].cut(begin, inside[0].end)
        inside[-1] = inside[-1].cut(inside[-1].start, end)
        return tuple(inside)

    def evaluate(self, sigma: float | Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return evaluate(self._pieces, self._sigma(sigma))


@dataclass(frozen=True)
class Spline(_Stored):
    """A cubic spline through ``points`` (x, y) in m at ``sigma`` in m (increasing, at least 2).

    Twice continuously differentiable, with the not-a-knot condition at its ends (a parabola through 3 points,
    a straight line through 2). Defined from the first to the last sigma only. Raises RobotError. Needs SciPy.
    """

    sigma: tuple[float, ...]
    points: tuple[tuple[float, float], ...]
    _pieces: tuple[RoutingPiece, ...] = field(init=False, repr=False, compare=False)

    if TYPE_CHECKING:  # any sequence or array is taken; tuples are stored

        def __init__(
            self, sigma: Sequence[float] | np.ndarray, points: Sequence[Sequence[float]] | np.ndarray
        ) -> None: ...

    def __post_init__(self) -> None:
        with check.owned("Spline"):
            sigma = check.numbers("sigma", self.sigma, "m", fewest=2)
            check.increasing("sigma", sigma, "m")
            entries = check.row("points", self.points, "(x, y) in m for each sigma")
            if len(entries) != len(sigma):
                raise RobotError(
                    "points",
                    f"{len(entries)} points for {len(sigma)} places",
                    "one (x, y) for each sigma",
                    value=self.points,
                )
            points = tuple(_point(f"points[{k}]", entry) for k, entry in enumerate(entries))
            check.store(self, sigma=sigma, points=points, _pieces=_cubics(sigma, points))


def _point(place: str, entry: object) -> tuple[float, float]:
    x, y = check.numbers(place, entry, "m", fewest=2, most=2)
    return x, y


def _cubics(sigma: tuple[float, ...], points: tuple[tuple[float, float], ...]) -> tuple[RoutingPiece, ...]:
    from scipy.interpolate import CubicSpline

    with np.errstate(all="ignore"):
        coefficients = CubicSpline(sigma, points).c[::-1]
    if not np.all(np.isfinite(coefficients)):
        raise RobotError(
            "sigma", "the points lie too close together for a spline", "places further apart", value=sigma
        )
    return tuple(
        RoutingPiece(start, end, False, tuple(coefficients[:, k, 0]), tuple(coefficients[:, k, 1]))
        for k, (start, end) in enumerate(pairwise(sigma))
    )


@dataclass(frozen=True)
class Function(_Stored):
    """A Python function sigma -> (x, y), m to m, on 0 <= sigma <= ``length`` (m), for use from Python only.

    It is called with floats when the routing is built, fitted by up to 256 polynomial pieces within 1e-9 m
    (compared at other points than those fitted), and not called again; a robot file cannot hold it.
    ``breaks``: places in m where the path has kinks. ``error``: largest difference seen, m. Raises RobotError
    when the function fails, returns something else than two finite numbers, or is too rough.
    """

    function: Callable[[float], Iterable[float]]
    length: float
    breaks: tuple[float, ...] = ()
    error: float = field(init=False, repr=False, compare=False)
    _pieces: tuple[RoutingPiece, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        with check.owned("Function"):
            if not callable(self.function):
                raise RobotError(
                    "function",
                    f"{check.show(self.function)} cannot be called",
                    "a function of sigma (m) that returns (x, y) in m",
                    value=self.function,
                )
            length = check.real("length", self.length, "m", above=0)
            breaks = check.numbers("breaks", self.breaks, "m")
            check.increasing("breaks", breaks, "m")
            for k, place in enumerate(breaks):
                check.real(f"breaks[{k}]", place, "m", above=0, below=length)
            pieces, error = fit(_Sampler(self.function), (0.0, *breaks, length))
            check.store(self, length=length, breaks=breaks, error=error, _pieces=pieces)


class _Sampler:
    """Calls the user's function and refuses what is not two finite numbers."""

    def __init__(self, function: Callable[[float], Any]) -> None:
        self.function = function

    def __call__(self, sigma: float) -> tuple[float, float]:
        try:
            value = self.function(sigma)
        except Exception as error:
            raise RobotError(
                "function",
                f"it raised {type(error).__name__}: {error} at sigma = {sigma:.9g} m",
                "(x, y) in m for every sigma",
                value=sigma,
            ) from error
        try:
            x, y = value
            if isinstance(x, str) or isinstance(y, str):
                raise TypeError
            x, y = float(x), float(y)
        except (TypeError, ValueError):
            raise self._refusal(value, sigma) from None
        if not (math.isfinite(x) and math.isfinite(y)):
            raise self._refusal(value, sigma)
        return x, y

    def _refusal(self, value: object, sigma: float) -> RobotError:
        return RobotError(
            "function",
            f"it returned {check.show(value)} at sigma = {sigma:.9g} m",
            "two finite numbers (x, y) in m for every sigma",
            value=value,
        )
