"""Routings put together from others, with kinks where they meet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.piece import RoutingPiece
from tactr.robot.routing import Routing

JOINT = 1e-9
"""Largest step (m) of the path where two routings meet."""


@dataclass(frozen=True)
class Piecewise(Routing):
    """Routings one after another: ``parts`` are pairs (start in m, routing), each from its start to the next
    one's.

    The first start is 0. Every routing is evaluated at the same sigma, counted from the tube's proximal end,
    not from its own start. Where two meet the path must agree within 1e-9 m; its direction may jump. Raises
    RobotError.
    """

    parts: tuple[tuple[float, Routing], ...]

    if TYPE_CHECKING:  # any sequence is taken; tuples are stored

        def __init__(self, parts: Sequence[tuple[float, Routing]]) -> None: ...

    def __post_init__(self) -> None:
        with check.owned("Piecewise"):
            expected = "pairs (start in m, routing)"
            entries = check.row("parts", self.parts, expected)
            if not entries:
                raise RobotError("parts", "there are none", expected, value=self.parts)
            parts = tuple(_pair(f"parts[{k}]", entry, expected) for k, entry in enumerate(entries))
            _check_starts([start for start, _ in parts])
            check.store(self, parts=parts)
            for k, (start, end, routing) in enumerate(self._spans()):
                _check_domain(f"parts[{k}]", routing, start, start if end == math.inf else end)
            for k in range(1, len(parts)):
                _check_joint(f"parts[{k}]", parts[k - 1][1], *parts[k])

    @property
    def domain(self) -> tuple[float, float]:
        start, routing = self.parts[0]
        first = -math.inf if routing.domain[0] == -math.inf else start
        return first, self.parts[-1][1].domain[1]

    def pieces(self, length: float, *, start: float = 0.0) -> tuple[RoutingPiece, ...]:
        begin, end = self._span(length, start)
        return tuple(
            piece
            for first, last, routing in self._spans(begin)
            if max(first, begin) < min(last, end)
            for piece in routing.pieces(min(last, end), start=max(first, begin))
        )

    def evaluate(self, sigma: float | Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        places = self._sigma(sigma)
        starts = [start for start, _ in self.parts]
        index = np.clip(np.searchsorted(starts, places, side="right") - 1, 0, len(starts) - 1)
        xy = np.empty((*places.shape, 2))
        slope = np.empty_like(xy)
        for k in np.unique(index):
            here = index == k
            xy[here], slope[here] = self.parts[k][1].evaluate(places[here])
        return xy, slope

    def _spans(self, begin: float = 0.0) -> list[tuple[float, float, Routing]]:
        """Start, end and routing of every part; the first reaches back to ``begin``."""
        starts = [min(begin, 0.0), *(start for start, _ in self.parts[1:]), math.inf]
        return [(starts[k], starts[k + 1], routing) for k, (_, routing) in enumerate(self.parts)]


def _pair(place: str, entry: object, expected: str) -> tuple[float, Routing]:
    parts = check.row(place, entry, expected)
    if len(parts) != 2 or not isinstance(parts[1], Routing):
        raise RobotError(place, f"{check.show(entry)} is not such a pair", expected, value=entry)
    return check.real(f"{place}[0]", parts[0], "m", least=0), parts[1]


def _check_starts(starts: list[float]) -> None:
    if starts[0] != 0:
        raise RobotError(
            "parts[0]",
            f"the first routing starts at {check.show(starts[0], 'm')}",
            "a first routing that starts at 0",
            value=starts[0],
        )
    check.increasing("parts", starts, "m")


def _check_domain(place: str, routing: Routing, start: float, end: float) -> None:
    if not routing.covers(start, end):
        first, last = routing.domain
        raise RobotError(
            place,
            f"its {type(routing).__name__} is defined from {check.show(first, 'm')} "
            f"to {check.show(last, 'm')} but used from {check.show(start, 'm')} to {check.show(end, 'm')}",
            "a routing defined wherever it is used (sigma counts from the tube's proximal end)",
            value=routing,
        )


def _check_joint(place: str, before: Routing, start: float, after: Routing) -> None:
    left, right = before.r(start), after.r(start)
    step = math.hypot(right[0] - left[0], right[1] - left[1])
    if not step <= JOINT:
        raise RobotError(
            place,
            f"the path jumps by {check.show(step, 'm')} at sigma = {check.show(start, 'm')}, "
            f"from {_place(left)} to {_place(right)}",
            f"routings that meet within {JOINT:g} m (all count sigma from the tube's proximal end)",
            value=step,
        )


def _place(r: tuple[float, float]) -> str:
    return f"({r[0]:.9g}, {r[1]:.9g}) m"
