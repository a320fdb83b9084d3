"""Tendons, and what pulls them: a tension, or a displacement at the motor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.friction import Friction, FrictionLike, plain_contacts, plain_friction
from tactr.robot.limits import TendonLimits, plain_limits
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
    sideways, and the tendon's pull beyond, force and moment, passes to the end of the outer one. end: sigma
    in m where it is fixed; None for the tube's distal end. limits: how far its actuator goes, if known.
    Raises RobotError.

    It is pulled by a tension (N, at least 0, or a TensionProfile), or by a displacement (m, positive pulls,
    None: none) of its motor, which rides on the proximal end of its tube. Under a displacement d its tension
    T and its length l in the robot obey

        l_rest - l + compliance (T - pretension) = d  where T > 0;  T = 0 (slack) where it exceeds d

    compliance: m/N, at least 0, of tendon and transmission in series. pretension: N, at least 0, at d = 0 in
    the rest state: no loads, every tendon of the robot at its pretension. l_rest: rest_length, m, where that
    is given; otherwise the length in the rest state at the present rotations and translations of the tubes,
    as if the motors were zeroed there. Tubes that turn or move then pull no tendon in an unloaded robot; a
    tendon once tied, whose motor stays where it is, has the rest_length of where it was tied (see
    ``tactr.rest_lengths``), and its tension changes when curved tubes turn or move.

    friction: Coulomb's coefficient between tendon and channel, at least 0, or pieces ``(start, coefficient)``
    over sigma in m. contacts: sigma in m of the disks on which it rubs; None: all along a channel. play: m,
    at least 0, the whole backlash of its motor. Both count in ``tactr.drive`` only, which knows what came
    before: ``tactr.solve`` gives the shape without friction and backlash, and says so.
    """

    name: str
    tube: str
    routing: Routing
    _: KW_ONLY
    host: Host = "own"
    tension: float | TensionProfile = 0.0
    displacement: float | None = None
    compliance: float = 0.0
    pretension: float = 0.0
    rest_length: float | None = None
    end: float | None = None
    limits: TendonLimits | None = None
    friction: Friction = 0.0
    contacts: tuple[float, ...] | None = None
    play: float = 0.0

    if TYPE_CHECKING:  # the constructor takes more forms than the fields store

        def __init__(
            self,
            name: str,
            tube: str,
            routing: Routing,
            *,
            host: Host = "own",
            tension: float | TensionProfile = 0.0,
            displacement: float | None = None,
            compliance: float = 0.0,
            pretension: float = 0.0,
            rest_length: float | None = None,
            end: float | None = None,
            limits: TendonLimits | None = None,
            friction: FrictionLike = 0.0,
            contacts: Sequence[float] | np.ndarray | None = None,
            play: float = 0.0,
        ) -> None: ...

    def __post_init__(self) -> None:
        name = check.name("name", self.name)
        with check.owned(f"Tendon {name!r}"):
            check.store(self, name=name, tube=check.name("tube", self.tube), host=_host(self.host))
            _check_routing(self.routing)
            check.store(self, tension=plain_tension(self.tension))
            check.store(self, displacement=plain_displacement(self.displacement))
            check.store(self, compliance=check.real("compliance", self.compliance, "m/N", least=0))
            check.store(self, pretension=check.real("pretension", self.pretension, "N", least=0))
            if self.rest_length is not None:
                check.store(self, rest_length=check.real("rest_length", self.rest_length, "m", above=0))
            if self.displacement is not None and self.tension != 0.0:
                raise both_given("displacement", self.displacement)
            check.store(self, limits=plain_limits(self.limits, TendonLimits))
            if self.end is not None:
                check.store(self, end=check.real("end", self.end, "m", above=0))
            check.store(self, friction=plain_friction(self.friction), contacts=plain_contacts(self.contacts))
            check.store(self, play=check.real("play", self.play, "m", least=0))


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


def plain_displacement(value: object) -> float | None:
    """A displacement in m, checked; None, also for NaN, where there is none."""
    if value is None or (isinstance(value, float | np.floating) and np.isnan(value)):
        return None
    return check.real("displacement", value, "m")


def both_given(field: str, value: object) -> RobotError:
    """The error for a tendon that is pulled in two ways."""
    return RobotError(
        field, "the tendon has a tension, too", "a tension or a displacement, not both", value=value
    )
