"""Profiles of all tendons of a robot, and how they go back into the kernel."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from tactr import _core
from tactr.friction.profile import Curve, Profile


@dataclass(frozen=True, eq=False)
class GivenProfiles:
    """by_tendon: None where a tendon has no tension or no friction."""

    by_tendon: tuple[Profile | None, ...]

    def rows(self, index: tuple[int, ...]) -> list:
        """Edges and coefficients of log tension of these tendons, None without, as the kernel takes them."""
        profiles = [self.by_tendon[j] for j in index]
        return [None if p is None else (p.log.edges, p.log.coefficients) for p in profiles]


@dataclass(frozen=True, eq=False)
class FoundProfiles:
    """Those of an equilibrium that the kernel found, made when they are looked at. index: tendon of every
    channel; tendons: how many there are."""

    found: _core.FrictionSettled
    index: tuple[int, ...]
    tendons: int

    @cached_property
    def by_tendon(self) -> tuple[Profile | None, ...]:
        """As of ``GivenProfiles``."""
        profiles: list[Profile | None] = [None] * self.tendons
        for j, row in zip(self.index, self.found.profiles, strict=True):
            profiles[j] = None if row is None else Profile(Curve(row[0], row[1]), row[2], row[3])
        return tuple(profiles)

    def rows(self, index: tuple[int, ...]) -> list | _core.FrictionSettled:
        """As of ``GivenProfiles``, or the equilibrium."""
        return self.found if index == self.index else GivenProfiles(self.by_tendon).rows(index)

    def __reduce__(self) -> tuple[type[GivenProfiles], tuple[tuple[Profile | None, ...]]]:
        """What the kernel holds is not for files: a copy holds what it means."""
        return GivenProfiles, (self.by_tendon,)


Profiles = GivenProfiles | FoundProfiles
