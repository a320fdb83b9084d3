"""Functions of a tube's arc length as polynomial parts, several at a time with the same breakpoints."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._fit import Interpolant, Rough, interpolate

POWERS = 8
TOLERANCE = 1e-9
"""Largest error of a fit, relative to the largest size of each function."""

Parts = list[tuple[float, tuple[float, ...]]]


def fit_along(
    function: Callable[[float], Iterable[float]],
    width: int,
    length: float,
    *,
    breaks: Sequence[float] = (),
    start: float = 0.0,
    least_size: Sequence[float] | None = None,
) -> list[Parts]:
    """Parts of each of the ``width`` components of ``function`` on ``start`` to ``start + length`` (m).

    The function is called with the distance from ``start``; where start is above 0, a part before it is left
    to the caller. least_size: sizes below which a component counts as this large. Raises RobotError.
    """
    length = check.real("length", length, "m", above=0)
    breaks = check.numbers("breaks", breaks, "m")
    check.increasing("breaks", breaks, "m")
    for k, place in enumerate(breaks):
        check.real(f"breaks[{k}]", place, "m", above=0, below=length)
    sample = _Sampler(function, width)
    probes = np.array([sample(s) for s in np.linspace(0.0, length, 129)])
    size = np.maximum(np.abs(probes).max(axis=0), 0.0 if least_size is None else least_size)
    size[size == 0.0] = 1.0
    try:
        pieces = [
            piece
            for span in pairwise((0.0, *breaks, length))
            for piece in _pieces(sample, size, *span, length)
        ]
    except Rough as rough:
        raise RobotError(
            "function",
            f"it is too rough: near sigma = {start + rough.sigma:.6g} m the fit is still off by "
            f"{rough.error:.3g} of its size",
            f"a function smooth enough to fit within {TOLERANCE:g}, jumps and kinks listed in breaks=(...)",
            value=rough.sigma,
        ) from None
    return [
        [(start + piece.start, tuple(float(c * size[q]) for c in piece.powers[q])) for piece in pieces]
        for q in range(width)
    ]


def _pieces(
    sample: _Sampler, size: np.ndarray, first: float, last: float, length: float
) -> list[Interpolant]:
    # a function that jumps at a break is read just before it
    edge = last if last == length else math.nextafter(last, first)
    return interpolate(
        lambda s: sample(min(s, edge)) / size,
        (first, last),
        TOLERANCE,
        count=POWERS,
        negligible=0.1 * TOLERANCE,
    )[0]


class _Sampler:
    """Calls the function and refuses what is not so many finite numbers."""

    def __init__(self, function: Callable[[float], Iterable[float]], width: int) -> None:
        self.function = function
        self.width = width

    def __call__(self, sigma: float) -> np.ndarray:
        try:
            value = tuple(self.function(sigma))
        except RobotError:
            raise
        except Exception as error:
            raise RobotError(
                "function",
                f"it raised {type(error).__name__}: {error} at sigma = {sigma:.9g} m",
                "a function of the arc length in m",
                value=sigma,
            ) from error
        try:
            return np.array(check.numbers("", value, fewest=self.width, most=self.width))
        except RobotError:
            raise RobotError(
                "function",
                f"it returned {check.show(value[0] if self.width == 1 else value)} at sigma = {sigma:.9g} m",
                "a finite number" if self.width == 1 else f"{self.width} finite numbers",
                value=value,
            ) from None
