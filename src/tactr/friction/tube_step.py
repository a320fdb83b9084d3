"""One quasi-static step of friction between tubes: actuation and state in, solution and state out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.friction.tube_nodes import CELLS, GUIDE, Overlap, overlaps
from tactr.friction.tube_state import TubeContact, TubeFrictionState
from tactr.robot import Robot

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]


class Rubbed(NamedTuple):
    """The kernel's robot with the friction torques as loads, its solution there, and the state.

    settled: whether torques and contact forces agree; otherwise neither solution nor state mean anything.
    iterations: equilibria that it took. held: in how many directions of falling energy the places that hold
    keep the robot from going.
    """

    core: _core.PreparedRobot
    solution: _core.Solution
    state: TubeFrictionState
    settled: bool
    iterations: int
    held: int


@dataclass(frozen=True)
class TubeFrictionStep:
    """Steps of one robot. cells: into how many each overlap of two tubes is cut."""

    robot: Robot
    tolerance: float
    residual_tolerance: float
    cells: int = CELLS

    @property
    def rubs(self) -> bool:
        """Whether any tube has friction."""
        return any(tube.friction is not None and tube.friction.coefficient > 0 for tube in self.robot.tubes)

    def __call__(
        self,
        core: _core.PreparedRobot,
        arrays: Arrays,
        state: TubeFrictionState | None,
        *,
        guess: _core.Solution | None = None,
        stay: bool = False,
    ) -> Rubbed:
        """From a state to the next one, at tension, rotation and translation; core: the robot there without
        friction between tubes. Without a state the tubes are put together there, without friction torques."""
        places = overlaps(self.robot, arrays[2], self.cells)
        names = [tube.name for tube in self.robot.tubes]
        before = [_contact_before(place, names, state) for place in places]
        slides = np.zeros(len(names)) if state is None else arrays[2] - state.translation
        rows = [_rows(place, contact, slides) for place, contact in zip(places, before, strict=True)]
        nodes = np.concatenate([*rows, np.empty((0, 10))])
        found = _core.friction_step(
            core, *arrays, self.tolerance, self.residual_tolerance, nodes, guess, stay=stay
        )
        return Rubbed(
            found["robot"],
            found["solution"],
            TubeFrictionState(_contacts(places, names, nodes, found), np.array(arrays[2])),
            found["settled"],
            found["iterations"],
            _held(nodes, found) if found["settled"] else 0,
        )


def _held(nodes: np.ndarray, found: dict[str, np.ndarray]) -> int:
    """Places that hold forbid the motions that turn them. The second variation of the energy is negative in
    as many directions fewer as the compliance of these places, d(twist)/d(torque), has negative eigenvalues
    (Haynsworth's inertia formula for the bordered matrix)."""
    holds = (found["slides"] == 0.0) & (found["limit"] > 0.0) & (nodes[:, 6] == 0.0)
    compliance = found["compliance"]
    holds &= np.diag(compliance) != 0.0  # some place turns with nothing
    among = compliance[np.ix_(holds, holds)]
    return int((np.linalg.eigvalsh(0.5 * (among + among.T)) < 0.0).sum()) if holds.any() else 0


def _contact_before(place: Overlap, names: list[str], state: TubeFrictionState | None) -> TubeContact | None:
    if state is None:
        return None
    pair = (names[place.inner], None if place.outer == GUIDE else names[place.outer])
    for contact in state.contacts:  # found by names: translations bring new neighbours together
        if (contact.inner, contact.outer) == pair:
            if len(contact.s) != len(place.s):
                raise RobotError(
                    "state",
                    f"{pair[0]!r} rubs at {len(contact.s)} places",
                    f"a state of this robot, with {len(place.s)} places",
                )
            return contact
    return None


def _rows(place: Overlap, before: TubeContact | None, slides: np.ndarray) -> np.ndarray:
    """The kernel's nodes: inner, outer, s, arm, lever, radius, slide, torque, twist, at an end."""
    rows = np.zeros((len(place.s), 10))
    rows[:, 0], rows[:, 1], rows[:, 2] = place.inner, place.outer, place.s
    rows[:, 3], rows[:, 4], rows[:, 5] = place.arm, place.lever, place.radius
    rows[:, 6] = slides[place.inner] - (0.0 if place.outer == GUIDE else slides[place.outer])
    rows[:, 7] = 0.0 if before is None else before.torque
    rows[:, 8] = np.nan if before is None else before.twist
    rows[[0, -1], 9] = 1.0
    return rows


def _contacts(
    places: list[Overlap], names: list[str], nodes: np.ndarray, found: dict[str, np.ndarray]
) -> tuple[TubeContact, ...]:
    contacts, first = [], 0
    for place in places:
        here = slice(first, first + len(place.s))
        first = here.stop
        slides, held = found["slides"][here], nodes[here, 8]
        keeps = (slides == 0.0) & (nodes[here, 6] == 0.0) & np.isfinite(held)  # no drift by rounding
        keeps &= np.diag(found["compliance"])[here] != 0.0  # clamped: turns with its actuator
        contacts.append(
            TubeContact(
                names[place.inner],
                None if place.outer == GUIDE else names[place.outer],
                nodes[here, 2],
                found["torque"][here],
                np.where(keeps, held, found["twist"][here]),
                found["limit"][here],
                slides,
            )
        )
    return tuple(contacts)
