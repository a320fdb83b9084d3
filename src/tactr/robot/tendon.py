"""Tendons and their tension."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.routing import Routing

Host = Literal["own", "outermost"]
HOSTS: tuple[Host, ...] = ("own", "outermost")


@dataclass(frozen=True)
class TensionProfile:
    """A tension that varies along the tendon, straight between samples and constant beyond the first and the
    last.

    sigma: m, increasing, the arc length of the tube where the tendon ends; values: N, at least 0, as many as
    sigma. Raises RobotError.
    """

    sigma: tuple[float, ...]
    values: tuple[float, ...]

    if TYPE_CHECKING:  # any sequence or array is taken; tuples are stored

        def __init__(
            self, sigma: Sequence[float] | np.ndarray, values: Sequence[float] | np.ndarray
        ) -> None: ...

    def __post_init__(self) -> None:
        with check.owned("TensionProfile"):
            sigma = check.numbers("sigma", self.sigma, "m", fewest=1)
            check.increasing("sigma", sigma, "m")
            values = check.numbers("values", self.values, "N", fewest=1, least=0)
            if len(values) != len(sigma):
                raise RobotError(
                    "values",
                    f"{len(values)} tensions for {len(sigma)} places",
                    "one tension for each sigma",
                    value=self.values,
                )
            check.store(self, sigma=sigma, values=values)

    def evaluate(self, sigma: float | Sequence[float] | np.ndarray) -> np.ndarray:
        """Tension in N at ``sigma`` (m), in its shape."""
        return np.asarray(np.interp(sigma, self.sigma, self.values))


@dataclass(frozen=True)
class Tendon:
    """One tendon.

    name: by which actuation refers to it. tube: name of the tube where it ends. routing: its path (x, y) over
    that tube's own arc length sigma. host: "own" when it runs in that tube's lumen (the published approach
    B), "outermost" when disks on the outermost tube present guide it (approach A). Each host reads the path
    in its own material frame: where the host changes between tubes turned against each other, the path jumps
    sideways, and the tendon's pull beyond, force and moment, passes to the end of the outer one. tension: N,
    at least 0, or a TensionProfile. end: sigma in m where it is fixed; None for the tube's distal end. Raises
    RobotError.
    """

    name: str
    tube: str
    routing: Routing
    _: KW_ONLY
    host: Host = "own"
    tension: float | TensionProfile = 0.0
    end: float | None = None

    def __post_init__(self) -> None:
        name = check.name("name", self.name)
        with check.owned(f"Tendon {name!r}"):
            check.store(self, name=name, tube=check.name("tube", self.tube), host=_host(self.host))
            _check_routing(self.routing)
            check.store(self, tension=plain_tension(self.tension))
            if self.end is not None:
                check.store(self, end=check.real("end", self.end, "m", above=0))


def _host(value: object) -> str:
    return check.choice("host", value, HOSTS)


def _check_routing(value: object) -> None:
    if isinstance(value, Routing):
        return
    expected = "a routing: Straight, Helix, Polynomial, PolarPolynomial, Spline, Piecewise or Function"
    if isinstance(value, type):
        raise RobotError(
            "routing", f"the class {value.__name__} was given, not an object of it", expected, value=value
        )
    if callable(value):
        expected += "; a Python function goes in as Function(function, length)"
    raise RobotError("routing", f"{check.show(value)} is not a routing", expected, value=value)


def plain_tension(value: object) -> float | TensionProfile:
    """A tension in N, checked."""
    if isinstance(value, TensionProfile):
        return value
    return check.real("tension", value, "N", least=0, hint="a tendon cannot push")
