"""The robot cut into sections on which everything is smooth, as plain arrays with the paper's symbols."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from tactr.reference.algebra import I_3, Array
from tactr.reference.paths import Path


@dataclass(frozen=True)
class WorldOrBody:
    """A force and a moment on one tube (index within the section), in world or in that tube's own axes.

    N and N m for a point load, N/m and N for a distributed one.
    """

    tube: int
    force: Array
    moment: Array
    world: bool

    def in_tube(self, R_1: Array, R: Array) -> tuple[Array, Array]:
        """Return force and moment in the tube's frame; R_1 (B, 3, 3), R = R_d3(theta) (B, n, 3, 3)."""
        if not self.world:
            shape = R_1.shape[:-1]
            return np.broadcast_to(self.force, shape), np.broadcast_to(self.moment, shape)
        R_i = R_1 @ R[:, self.tube]
        return self.force @ R_i, self.moment @ R_i

    def scaled(self, factor: float) -> WorldOrBody:
        """Return the load multiplied by factor."""
        return replace(self, force=factor * self.force, moment=factor * self.moment)


@dataclass(frozen=True)
class Section:
    """One section start < s < end with n tubes (outermost first: tube 1 of the paper) and m tendons.

    K_se, K_bt are (n, 3, 3); u_star and v_star (n, 3) and their derivatives are the rest strains in each
    tube's own frame. hosts (m,) is the index of the tube that carries the tendon; tension (m,) holds at
    `start` and tension_rate (m,) is its derivative. rest derivatives are zero for robots (rest strains are
    piecewise constant) and are kept because the paper prints them.
    """

    start: float
    end: float
    tubes: tuple[int, ...]
    K_se: Array
    K_bt: Array
    u_star: Array
    tendons: tuple[int, ...] = ()
    paths: tuple[Path, ...] = ()
    hosts: tuple[int, ...] = ()
    tension: Array = field(default_factory=lambda: np.zeros(0))
    tension_rate: Array = field(default_factory=lambda: np.zeros(0))
    loads: tuple[WorldOrBody, ...] = ()
    v_star: Array = field(default_factory=lambda: I_3.copy())
    du_star: Array = field(default_factory=lambda: np.zeros(3))
    dv_star: Array = field(default_factory=lambda: np.zeros(3))
    sigma_star: Array = field(init=False)
    """v_star - I_3."""
    carriers: Array = field(init=False)
    """(n, m): 1 where the tube hosts the tendon; summing over tendons j = 1..m_i is a product with it."""
    row_size: Array = field(init=False)
    """(4 + 2n,): stiffness that sets the size of A's rows.

    Moments and forces differ by eight powers of ten.
    """

    def __post_init__(self) -> None:
        carriers = np.zeros((len(self.tubes), len(self.hosts)))
        carriers[list(self.hosts), range(len(self.hosts))] = 1.0
        object.__setattr__(self, "carriers", carriers)
        object.__setattr__(self, "sigma_star", self.v_star - I_3)
        by_axis = [self.K_bt[:, [0, 1, 2], [0, 1, 2]], self.K_se[:, [0, 1, 2], [0, 1, 2]]]
        sizes = [size for k in by_axis for size in (k[:, :2].sum(axis=0), k[:, 2])]
        object.__setattr__(self, "row_size", np.concatenate(sizes))

    def tension_at(self, s: float) -> Array:
        """Return the tensions lambda_j at s (m,), N."""
        return self.tension + self.tension_rate * (s - self.start)

    def scaled(self, factor: float) -> Section:
        """Return the section with tensions, rest curvature and loads multiplied by factor."""
        return replace(
            self,
            u_star=factor * self.u_star,
            du_star=factor * self.du_star,
            tension=factor * self.tension,
            tension_rate=factor * self.tension_rate,
            loads=tuple(load.scaled(factor) for load in self.loads),
        )


@dataclass(frozen=True)
class SectionEnd:
    """What happens at a section's end: tubes and tendons (indices within it) that end, point loads.

    anchors: the tubes to which these tendons are fixed; in the paper's approach A not always their hosts.
    """

    tubes: tuple[int, ...] = ()
    tendons: tuple[int, ...] = ()
    anchors: tuple[int, ...] = ()
    loads: tuple[WorldOrBody, ...] = ()

    def scaled(self, factor: float) -> SectionEnd:
        """Return the end with its point loads multiplied by factor."""
        return replace(self, loads=tuple(load.scaled(factor) for load in self.loads))


@dataclass(frozen=True)
class Sections:
    """All sections of a robot from base to tip, what happens at their ends, and the base rotations (rad)."""

    sections: tuple[Section, ...]
    ends: tuple[SectionEnd, ...]
    rotations: Array

    @property
    def length(self) -> float:
        """Arc length of the most distal end, m."""
        return self.sections[-1].end

    def scaled(self, factor: float) -> Sections:
        """Return the robot with all tensions, rest curvatures and loads multiplied by factor."""
        return replace(
            self,
            sections=tuple(section.scaled(factor) for section in self.sections),
            ends=tuple(end.scaled(factor) for end in self.ends),
        )
