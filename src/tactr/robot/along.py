"""Quantities that vary along a tube."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot._along_fit import fit_along
from tactr.robot.piece import horner, shifted

MOST_POWERS = 8
EDGE = 1e-9
"""How far (m) past its end a quantity still answers: lengths differ by rounding."""

Part = tuple[float, tuple[float, ...]]


@dataclass(frozen=True)
class Along:
    """One quantity along a tube, in SI units, over the tube's own arc length sigma (m) from its proximal end.

    parts: pairs (start in m, coefficients) of polynomials in sigma - start, ascending powers, 1 to 8 each,
    from each start to the next one's; the first start is 0. It may jump where parts meet. end: m, where it
    stops being defined; infinite by default. Raises RobotError.
    """

    parts: tuple[Part, ...]
    end: float = math.inf

    if TYPE_CHECKING:  # any sequence is taken; tuples are stored

        def __init__(
            self, parts: Sequence[tuple[float, Sequence[float] | np.ndarray]], end: float = math.inf
        ) -> None: ...

    def __post_init__(self) -> None:
        with check.owned("Along"):
            expected = "pairs (start in m, coefficients)"
            entries = check.row("parts", self.parts, expected)
            if not entries:
                raise RobotError("parts", "there are none", expected, value=self.parts)
            parts = tuple(_part(f"parts[{k}]", entry, expected) for k, entry in enumerate(entries))
            check.starts("parts", [start for start, _ in parts])
            end = self.end
            if end != math.inf:
                end = check.real("end", end, "m", above=parts[-1][0])
            check.store(self, parts=parts, end=end)

    @classmethod
    def steps(cls, sigma: Sequence[float], values: Sequence[float]) -> Along:
        """Constant ``values`` from each ``sigma`` (m) on; the first is 0. Raises RobotError."""
        places, heights = _samples(sigma, values, fewest=1)
        return cls([(place, (height,)) for place, height in zip(places, heights, strict=True)])

    @classmethod
    def linear(cls, sigma: Sequence[float] | np.ndarray, values: Sequence[float] | np.ndarray) -> Along:
        """Straight between ``values`` at ``sigma`` (m, from 0 on), defined to the last. Raises RobotError."""
        places, heights = _samples(sigma, values, fewest=2)
        slopes = np.diff(heights) / np.diff(places)
        parts = [
            (place, (height, float(k))) for place, height, k in zip(places, heights, slopes, strict=False)
        ]
        return cls(parts, places[-1])

    @classmethod
    def spline(cls, sigma: Sequence[float] | np.ndarray, values: Sequence[float] | np.ndarray) -> Along:
        """A cubic spline (not-a-knot) through ``values`` at ``sigma`` (m, from 0 on), defined to the last.

        Raises RobotError.
        """
        from scipy.interpolate import CubicSpline

        places, heights = _samples(sigma, values, fewest=2)
        with np.errstate(all="ignore"):
            coefficients = CubicSpline(places, heights).c[::-1].T
        if not np.all(np.isfinite(coefficients)):
            raise RobotError("sigma", "its places are too close for a spline", "places further apart")
        return cls(list(zip(places, coefficients, strict=False)), places[-1])

    @classmethod
    def function(
        cls, function: Callable[[float], float], length: float, *, breaks: Sequence[float] = ()
    ) -> Along:
        """A Python ``function`` of sigma (m), fitted on 0 to ``length`` (m) and not called again.

        The fit is off by at most 1e-9 of the function's largest value, and has at most 256 parts. breaks:
        places in m of its jumps and kinks. Raises RobotError where it fails, is not a finite number, or is
        too rough.
        """
        (fitted,) = fit_along(lambda sigma: (function(sigma),), 1, length, breaks=breaks)
        return cls(fitted, check.real("length", length, "m", above=0))

    def __call__(self, sigma: float | Sequence[float] | np.ndarray) -> np.ndarray:
        """Values (...) at ``sigma`` (...) in m; at a jump the value after it. RobotError outside [0, end]."""
        places = np.asarray(sigma, dtype=float)
        if not np.all((places >= -EDGE) & (places <= self.end + EDGE)):
            raise RobotError(
                "sigma", f"{check.show(sigma)} is outside", f"0 to {check.show(self.end, 'm')}", value=sigma
            )
        starts = [start for start, _ in self.parts]
        index = np.clip(np.searchsorted(starts, places, side="right") - 1, 0, len(starts) - 1)
        values = np.empty(places.shape)
        for k in np.unique(index):
            here = index == k
            values[here] = horner(self.parts[k][1], places[here] - starts[k])[0]
        return values

    def powers_at(self, start: float) -> tuple[float, ...]:
        """Coefficients, in powers of sigma - ``start`` (m), of the part that holds from ``start`` on."""
        begin, coefficients = [part for part in self.parts if part[0] <= start][-1]
        return shifted(coefficients, start - begin) if start > begin else coefficients

    def least(self, start: float, end: float) -> float:
        """The least value between ``start`` and ``end`` (m), to rounding."""
        ends = [*(part[0] for part in self.parts[1:]), math.inf]
        spans = [
            (max(start, part[0]), min(last, end), part) for part, last in zip(self.parts, ends, strict=True)
        ]
        return min(_least(part, first, last) for first, last, part in spans if first < last)


def _least(part: Part, first: float, last: float) -> float:
    start, powers = part
    if len(powers) == 1:
        return powers[0]
    low, high = first - start, last - start
    slope = np.polynomial.polynomial.polyder(powers)[::-1]
    turns = [root.real for root in np.roots(slope) if low < root.real < high]
    return float(np.min(horner(powers, np.array([low, high, *turns]))[0]))


def _part(place: str, entry: object, expected: str) -> Part:
    pair = check.row(place, entry, expected)
    if len(pair) != 2:
        raise RobotError(place, f"{check.show(entry)} is not a pair", expected, value=entry)
    start = check.real(f"{place}[0]", pair[0], "m", least=0)
    return start, check.numbers(f"{place}[1]", pair[1], fewest=1, most=MOST_POWERS)


def _samples(sigma: object, values: object, *, fewest: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    places = check.numbers("sigma", sigma, "m", fewest=fewest)
    check.starts("sigma", places)
    return places, check.numbers("values", values, fewest=len(places), most=len(places))
