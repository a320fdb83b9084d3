"""One quasi-static step of friction between tubes: actuation and state in, solution and state out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from tactr import _core
from tactr.errors import RobotError
from tactr.friction.tube_nodes import CELLS, GUIDE, Overlap, overlaps
from tactr.friction.tube_state import TubeContact, TubeFrictionState
from tactr.robot import Robot

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]

# columns of the kernel's nodes
INNER, OUTER, S, ARM, LEVER, RADIUS, SLIDE, TORQUE, TWIST, SLID, AT_END, COLUMNS = range(12)


class Rubbed(NamedTuple):
    """The kernel's robot with the friction torques as loads, its solution there, and the state.

    settled: whether torques and contact forces agree; otherwise neither solution nor state mean anything.
    iterations: equilibria or marches that it took. falls: in how many directions the energy falls at these
    torques; held: in how many of them the places that hold keep the robot from going. heat (tubes,): J that
    friction took, by inner tube. model: what makes the next step fast.
    """

    core: _core.PreparedRobot
    solution: _core.Solution
    state: TubeFrictionState
    settled: bool
    iterations: int
    falls: int
    held: int
    heat: np.ndarray
    model: _core.RubbingModel


class Pair(NamedTuple):
    """Where one tube rubs in what is around it (None: the guide), by names and by number, and which of all
    places these are."""

    inner: str
    outer: str | None
    bodies: tuple[int, int]
    places: slice


class Cut(NamedTuple):
    """All places at one translation: pairs, and the kernel's nodes as nothing has turned yet."""

    pairs: list[Pair]
    nodes: np.ndarray


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
        model: _core.RubbingModel | None = None,
        stay: bool = False,
    ) -> Rubbed:
        """From a state to the next one, at tension, rotation and translation; core: the robot there without
        friction between tubes. Without a state the tubes are put together there, without friction torques.
        model: that came with the guess; without it a step takes much longer."""
        translation = arrays[2]
        pairs, nodes = self._cut(tuple(translation.tolist()))
        if state is not None:
            nodes = _nodes_after(state, translation, pairs, nodes)
        found = _core.friction_step(
            core, *arrays, self.tolerance, self.residual_tolerance, nodes, guess, model, stay=stay
        )
        contacts = []
        if found["settled"]:
            rows = nodes[:, S], *(found[name] for name in ("torque", "twist", "limit", "slides"))
            for pair in pairs:
                here = [row[pair.places] for row in rows]
                contacts.append(TubeContact(pair.inner, pair.outer, *here))
        return Rubbed(
            found["robot"],
            found["solution"],
            TubeFrictionState(tuple(contacts), translation.copy()),
            found["settled"],
            found["iterations"],
            found["falls"],
            _held(nodes, found) if found["falls"] else 0,
            found["heat"],
            found["model"],
        )

    @cached_property
    def _cut(self) -> Callable[[tuple[float, ...]], Cut]:
        """Where tubes rub at a translation; it is mostly that of the step before."""

        @lru_cache(maxsize=2)
        def cut(translation: tuple[float, ...]) -> Cut:
            names = [tube.name for tube in self.robot.tubes]
            pairs, rows, first = [], [np.empty((0, COLUMNS))], 0
            for place in overlaps(self.robot, np.array(translation), self.cells):
                here = slice(first, first + len(place.s))
                bodies = place.inner, place.outer
                outer = None if place.outer == GUIDE else names[place.outer]
                pairs.append(Pair(names[place.inner], outer, bodies, here))
                rows.append(_at_rest(place))
                first = here.stop
            return Cut(pairs, np.concatenate(rows))

        return cut


def _at_rest(place: Overlap) -> np.ndarray:
    """The kernel's nodes, without torques, whatever their angles."""
    rows = np.zeros((len(place.s), COLUMNS))
    rows[:, INNER], rows[:, OUTER], rows[:, S] = place.inner, place.outer, place.s
    rows[:, ARM], rows[:, LEVER], rows[:, RADIUS] = place.arm, place.lever, place.radius
    rows[:, TWIST] = np.nan
    rows[[0, -1], AT_END] = 1.0
    return rows


def _nodes_after(
    state: TubeFrictionState, translation: np.ndarray, pairs: list[Pair], nodes: np.ndarray
) -> np.ndarray:
    """The kernel's nodes with what the state remembers; pairs are found by their names: translations bring
    new neighbours together."""
    nodes = nodes.copy()
    moved = translation - state.translation
    slid = moved.any()
    known = {(contact.inner, contact.outer): contact for contact in state.contacts}
    for pair in pairs:
        inner, outer = pair.bodies
        if slid:
            nodes[pair.places, SLIDE] = moved[inner] - (0.0 if outer == GUIDE else moved[outer])
        contact = known.get((pair.inner, pair.outer))
        if contact is None:
            continue
        if len(contact.s) != pair.places.stop - pair.places.start:
            raise RobotError(
                "state",
                f"{pair.inner!r} rubs at {len(contact.s)} places",
                f"a state of this robot, with {pair.places.stop - pair.places.start} places",
            )
        nodes[pair.places, TORQUE] = contact.torque
        nodes[pair.places, TWIST] = contact.twist
        nodes[pair.places, SLID] = contact.slides
    return nodes


def _held(nodes: np.ndarray, found: dict[str, np.ndarray]) -> int:
    """Places that hold forbid the motions that turn them. The second variation of the energy is negative in
    as many directions fewer as the compliance of these places, d(twist)/d(torque), has negative eigenvalues
    (Haynsworth's inertia formula for the bordered matrix)."""
    holds = (found["slides"] == 0.0) & (found["limit"] > 0.0) & (found["felt"] != 0.0)
    holds &= nodes[:, SLIDE] == 0.0
    compliance = found["compliance"]
    if not holds.any() or compliance.shape[1] != len(nodes):  # not known: they count as none
        return 0
    among = compliance[np.ix_(holds, holds)]
    return int((np.linalg.eigvalsh(0.5 * (among + among.T)) < 0.0).sum())
