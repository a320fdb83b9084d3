"""What a robot with friction and backlash remembers: an explicit value, in and out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactr.errors import RobotError
from tactr.friction.actuators import Actuators
from tactr.friction.profile import ORDER, Curve, Profile
from tactr.friction.profiles import GivenProfiles, Profiles
from tactr.friction.tube_state import TubeFrictionState
from tactr.robot import Robot


@dataclass(frozen=True, eq=False, repr=False)
class DriveState:
    """Tensions along the tendons, torques between tubes, and where backlash has left the actuators.

    names of tendons and tubes in the robot's order; along: tensions along the tendons, see ``profiles``;
    given: what the actuators were given last, None at rest; passed: what their plays pass on; rubbing:
    torques and angles where tubes rub, None without or at rest.
    """

    tendons: tuple[str, ...]
    tubes: tuple[str, ...]
    along: Profiles
    given: Actuators | None
    passed: Actuators
    rubbing: TubeFrictionState | None = None

    @property
    def profiles(self) -> tuple[Profile | None, ...]:
        """Tension along every tendon, by tendon, None where it has no tension or no friction."""
        return self.along.by_tendon

    def tension(self, tendon: str, sigma: float | Sequence[float] | np.ndarray) -> np.ndarray:
        """Tension along a tendon with friction at sigma (n,), m; 0 where it is slack. N."""
        profile = self.profiles[self._index(tendon)]
        sigma = np.atleast_1d(np.asarray(sigma, dtype=float))
        return np.zeros(len(sigma)) if profile is None else profile.tension(sigma)

    def stuck(self, tendon: str, sigma: float | Sequence[float] | np.ndarray) -> np.ndarray:
        """Whether the last step left the tendon where it was, at sigma (n,)."""
        profile = self.profiles[self._index(tendon)]
        sigma = np.atleast_1d(np.asarray(sigma, dtype=float))
        if profile is None:
            return np.zeros(len(sigma), dtype=bool)
        return np.array([profile.slides[profile.log.piece(s)] == 0 for s in sigma])

    def fits(self, robot: Robot) -> None:
        """Raise RobotError unless the state is of such a robot."""
        names = tuple(t.name for t in robot.tendons), tuple(t.name for t in robot.tubes)
        if (self.tendons, self.tubes) != names:
            raise RobotError(
                "state",
                f"it is of tendons {', '.join(self.tendons) or 'none'} and tubes {', '.join(self.tubes)}",
                "a state that tactr.drive gave for this robot, or None",
                value=self,
            )

    def to_dict(self) -> dict[str, Any]:
        """Plain lists and numbers, for JSON: ``from_dict`` gives the state back."""
        return {
            "tendons": list(self.tendons),
            "tubes": list(self.tubes),
            "profiles": [None if p is None else _plain(p) for p in self.profiles],
            "given": None if self.given is None else self.given.to_dict(),
            "passed": self.passed.to_dict(),
            "rubbing": None if self.rubbing is None else self.rubbing.to_dict(),
        }

    @staticmethod
    def from_dict(data: dict[str, Any]) -> DriveState:
        """The state that ``to_dict`` wrote. Raises RobotError."""
        try:
            return DriveState(
                tuple(data["tendons"]),
                tuple(data["tubes"]),
                GivenProfiles(tuple(None if p is None else _profile(p) for p in data["profiles"])),
                None if data["given"] is None else Actuators.from_dict(data["given"]),
                Actuators.from_dict(data["passed"]),
                None if data["rubbing"] is None else TubeFrictionState.from_dict(data["rubbing"]),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise RobotError(
                "state", f"it cannot be read: {error}", "what to_dict gave", value=data
            ) from None

    def __repr__(self) -> str:
        pieces = [0 if p is None else len(p.slides) for p in self.profiles]
        return f"<DriveState of tendons {', '.join(self.tendons) or 'none'}: pieces of tension {pieces}>"

    def _index(self, tendon: str) -> int:
        if tendon not in self.tendons:
            raise RobotError(
                "tendon", f"there is no tendon {tendon!r}", ", ".join(self.tendons) or "none", value=tendon
            )
        return self.tendons.index(tendon)


def _plain(profile: Profile) -> dict[str, Any]:
    return {
        "sigma": profile.log.edges.tolist(),
        "log_tension": profile.log.coefficients.tolist(),
        "slides": list(profile.slides),
        "driven": list(profile.driven),
    }


def _profile(data: dict[str, Any]) -> Profile:
    curve = Curve(
        np.array(data["sigma"], dtype=float), np.array(data["log_tension"], dtype=float).reshape(-1, ORDER)
    )
    return Profile(curve, tuple(data["slides"]), tuple(data["driven"]))
