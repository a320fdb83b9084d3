"""Routings: where a tendon runs in the cross-section, as a function of arc length."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.piece import MOST_COEFFICIENTS, RoutingPiece, evaluate

EDGE = 1e-9
"""How far (m) past the end of its domain a routing still answers: lengths differ by rounding."""


class Routing(ABC):
    """A path (x, y) in m over sigma in m, the arc length of the tube on which the tendon ends, from that
    tube's proximal end; x and y are in the material frame of the tube that hosts the tendon at that
    section.
    """

    @property
    def domain(self) -> tuple[float, float]:
        """First and last sigma (m) where the routing is defined; infinite where it has no end."""
        return -math.inf, math.inf

    @abstractmethod
    def pieces(self, length: float, *, start: float = 0.0) -> tuple[RoutingPiece, ...]:
        """Consecutive polynomial pieces that cover [start, length] (m) exactly. RobotError outside the
        domain.
        """

    @abstractmethod
    def evaluate(self, sigma: float | Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (..., 2) in m and derivative (..., 2) at ``sigma`` (...) in m. At a kink, the derivative
        after it.

        RobotError outside the domain.
        """

    def r(self, sigma: float) -> tuple[float, float]:
        """(x, y) in m at one ``sigma`` in m."""
        xy, _ = self.evaluate(check.real("sigma", sigma, "m"))
        return float(xy[0]), float(xy[1])

    def covers(self, start: float, end: float) -> bool:
        """Whether [start, end] (m) lies in the domain."""
        first, last = self.domain
        return first <= start + EDGE and end <= last + EDGE

    def _span(self, length: float, start: float) -> tuple[float, float]:
        begin = check.real("start", start, "m")
        end = math.inf if length == math.inf else check.real("length", length, "m", above=begin)
        if not self.covers(begin, end):
            raise outside(self, end if self.covers(begin, begin) else begin)
        return begin, end

    def _sigma(self, sigma: object) -> np.ndarray:
        try:
            values = np.asarray(sigma, dtype=float)
        except (TypeError, ValueError):
            raise RobotError(
                "sigma",
                f"{check.show(sigma)} is not a number or an array of numbers",
                "finite numbers in m",
                value=sigma,
            ) from None
        if not np.all(np.isfinite(values)):
            bad = values[~np.isfinite(values)].flat[0]
            raise RobotError(
                "sigma", f"{check.show(bad)} is not a finite number", "finite numbers in m", value=sigma
            )
        for value in (values.min(), values.max()) if values.size else ():
            if not self.covers(value, value):
                raise outside(self, float(value))
        return values


def outside(routing: Routing, sigma: float) -> RobotError:
    """The error for a ``sigma`` that the routing does not reach."""
    first, last = routing.domain
    return RobotError(
        "sigma",
        f"{check.show(sigma, 'm')} is outside the {type(routing).__name__}",
        f"from {check.show(first, 'm')} to {check.show(last, 'm')}",
        value=sigma,
    )


class _OnePiece(Routing):
    """Routings that are one polynomial piece for every sigma."""

    def _piece(self) -> RoutingPiece:
        raise NotImplementedError

    def pieces(self, length: float, *, start: float = 0.0) -> tuple[RoutingPiece, ...]:
        begin, end = self._span(length, start)
        return (self._piece().cut(begin, end),)

    def evaluate(self, sigma: float | Sequence[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return evaluate((self._piece(),), self._sigma(sigma))


@dataclass(frozen=True)
class Straight(_OnePiece):
    """Parallel to the tube at (x, y), in m. Raises RobotError."""

    x: float
    y: float

    def __post_init__(self) -> None:
        with check.owned("Straight"):
            check.store(self, x=check.real("x", self.x, "m"), y=check.real("y", self.y, "m"))

    @classmethod
    def polar(cls, radius: float, angle: float) -> Straight:
        """At ``radius`` (m, at least 0) in the direction ``angle`` (rad, from x towards y)."""
        with check.owned("Straight"):
            radius = check.real("radius", radius, "m", least=0)
            angle = check.real("angle", angle, "rad")
        return cls(radius * math.cos(angle), radius * math.sin(angle))

    def _piece(self) -> RoutingPiece:
        return RoutingPiece(0.0, math.inf, False, (self.x,), (self.y,))


@dataclass(frozen=True)
class Helix(_OnePiece):
    """Around the tube at ``radius`` (m, at least 0) with angle = rate * sigma + phase (rad/m, rad). Positive
    rates are right-handed. Raises RobotError.
    """

    radius: float
    rate: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        with check.owned("Helix"):
            hint = "for the opposite side, add pi to the phase"
            check.store(self, radius=check.real("radius", self.radius, "m", least=0, hint=hint))
            check.store(self, rate=check.real("rate", self.rate, "rad/m"))
            check.store(self, phase=check.real("phase", self.phase, "rad"))

    @classmethod
    def from_pitch(cls, radius: float, pitch: float, phase: float = 0.0) -> Helix:
        """One turn every ``pitch`` (m, not 0; negative is left-handed)."""
        with check.owned("Helix"):
            pitch = check.real("pitch", pitch, "m")
            if not math.isfinite(2 * math.pi / pitch if pitch else math.inf):
                raise RobotError(
                    "pitch",
                    f"{check.show(pitch, 'm')} is no advance per turn",
                    "a pitch in m other than 0, or Straight for none",
                    value=pitch,
                )
        return cls(radius, 2 * math.pi / pitch, phase)

    def _piece(self) -> RoutingPiece:
        return RoutingPiece(0.0, math.inf, True, (self.radius,), (self.phase, self.rate))


@dataclass(frozen=True)
class Polynomial(_OnePiece):
    """x and y as polynomials in sigma (m), ascending powers, 1 to 16 coefficients each: x = x0 + x1 sigma +
    ... in m.

    Raises RobotError.
    """

    x: tuple[float, ...]
    y: tuple[float, ...]

    def __post_init__(self) -> None:
        with check.owned("Polynomial"):
            check.store(self, x=check.numbers("x", self.x, fewest=1, most=MOST_COEFFICIENTS))
            check.store(self, y=check.numbers("y", self.y, fewest=1, most=MOST_COEFFICIENTS))

    def _piece(self) -> RoutingPiece:
        return RoutingPiece(0.0, math.inf, False, self.x, self.y)


@dataclass(frozen=True)
class PolarPolynomial(_OnePiece):
    """radius (m) and angle (rad) as polynomials in sigma (m), ascending powers, 1 to 16 coefficients each.

    A radius below 0 is a point on the opposite side: the path may cross the axis. Raises RobotError."""

    radius: tuple[float, ...]
    angle: tuple[float, ...]

    def __post_init__(self) -> None:
        with check.owned("PolarPolynomial"):
            check.store(self, radius=check.numbers("radius", self.radius, fewest=1, most=MOST_COEFFICIENTS))
            check.store(self, angle=check.numbers("angle", self.angle, fewest=1, most=MOST_COEFFICIENTS))

    def _piece(self) -> RoutingPiece:
        return RoutingPiece(0.0, math.inf, True, self.radius, self.angle)
