"""What tubes exert on each other: along the robot, and at points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np


class GuideReaction(NamedTuple):
    """What the guide exerts across z on the part of the robot outside, about the exit, world axes.

    force (3,) N, moment (3,) N m; both without z, which the actuators hold.
    """

    force: np.ndarray
    moment: np.ndarray


class PointContacts(NamedTuple):
    """Concentrated contact at breakpoints, p of them.

    s (p,) m, force (p, 3) N and moment (p, 3) N m about the centreline, world axes.
    """

    s: np.ndarray
    force: np.ndarray
    moment: np.ndarray


@dataclass(frozen=True, repr=False, eq=False)
class Contact:
    """What a tube exerts on the next tube inside it, at the k stations where the two are neighbours.

    outer, inner: names; the outer exerts ``force`` and ``moment`` on the inner, and the inner the opposite on
    the outer. s (k,) m; force (k, 3) N/m, moment (k, 3) N m/m, per length s, about the centreline, world
    axes; across the axis: tubes do not rub. points: concentrated contact, at the ends of tubes and where rest
    curvature or stiffness change; the first, at s = 0, is what the inner tube and all in it need there and
    behind the exit, whether from the outer tube, the guide or their actuators. A station at a breakpoint
    holds the value before it. Source: the balance of forces and moments of every tube, summed from inside.
    """

    outer: str
    inner: str
    s: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    points: PointContacts

    def __repr__(self) -> str:
        return f"<Contact of {self.outer!r} on {self.inner!r}: {len(self.s)} stations>"


def contacts_of(records: Mapping[str, Any], names: Sequence[str]) -> tuple[Contact, ...]:
    """The kernel's arrays by pairs of neighbours, outermost pair first."""
    along, points = records["along"], records["points"]
    found = []
    for outer in range(len(names)):
        for inner in range(outer + 1, len(names)):
            here, there = along["outer"][inner] == outer, points["outer"][inner] == outer
            if here.any() or there.any():
                spots = PointContacts(
                    points["s"][there], points["force"][inner, there], points["moment"][inner, there]
                )
                s, force, moment = along["s"][here], along["force"][inner, here], along["moment"][inner, here]
                found.append(Contact(names[outer], names[inner], s, force, moment, spots))
    return tuple(found)


def guide_reaction_of(records: Mapping[str, Any]) -> GuideReaction:
    """What holds all tubes at the exit: the first record of the outermost tube."""
    points = records["points"]
    first = int(np.argmax(points["outer"][:, 0] == np.arange(len(points["outer"]))))
    return GuideReaction(points["force"][first, 0], points["moment"][first, 0])
