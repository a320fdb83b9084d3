"""From base strains to what is left over at the tubes' ends: the initial value problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tactr.reference.algebra import Array, R_d3
from tactr.reference.compatibility import State
from tactr.reference.sections import Section, Sections
from tactr.reference.system import state_rate
from tactr.reference.transitions import BlownUp, Transitions, cross_over, finish

MAX_STEPS = 200
"""Integration steps allowed in one section before a guess is given up as blown up."""
MAX_CURVATURE = 1e3
"""Curvature times length of the robot (rad) at which it is given up too."""


@dataclass(frozen=True)
class Options:
    """How to march: relative tolerance of the integrator, transitions, terms as printed or corrected."""

    rtol: float = 1e-10
    transitions: Transitions = "resultant"
    as_printed: bool = False


@dataclass(frozen=True)
class Scales:
    """Sizes by which unknowns (4 + 2n), left-over wrenches and integration errors are measured.

    A moment that bends the robot by one radian over its length, the force that has this moment at its length
    as lever, for torsion a turn of one radian of each tube; and the strains that these cause.
    """

    length: float
    force: float
    moment: float
    torque: Array
    strains: Array

    @classmethod
    def of(cls, robot: Sections) -> Scales:
        """Return the scales of a robot (from its first section, where all tubes are present)."""
        first, length = robot.sections[0], robot.length
        moment = float(first.K_bt[:, 0, 0].sum()) / length
        force = moment / length
        torque = first.K_bt[:, 2, 2] / length
        return cls(length, force, moment, torque, strain_sizes(first, length, force))


def strain_sizes(section: Section, length: float, force: float) -> Array:
    """Return the sizes of the strains (4 + 2n,): one radian over the length (m), what the force (N) does."""
    axial = force / section.K_se[:, 2, 2]
    shear = force / section.K_se[:, 0, 0].sum()
    bend = np.full(3, 1.0 / length)
    turn = np.full(len(section.tubes) - 1, 1.0 / length)
    return np.concatenate([bend, [shear, shear, axial[0]], turn, axial[1:]])


@dataclass
class Record:
    """States at the stations asked for (sorted, distinct, m), gathered step by step."""

    stations: Array
    found: list[tuple[Section, Array, State]] = field(default_factory=list)

    def add(self, section: Section, after: float, upto: float, at: Callable[[float], Array]) -> None:
        """Keep the states at the stations in (after, upto], given the packed state as a function of s."""
        s = self.stations[(self.stations > after) & (self.stations <= upto)]
        if len(s):
            y = np.concatenate([np.reshape(at(float(place)), (1, -1)) for place in s])
            self.found.append((section, s, State.unpack(y, len(section.tubes))))


def base_state(robot: Sections, strains: Array) -> State:
    """Return the state at s = 0 for base strains (B, 4 + 2n): p = 0, R_1, theta_i by the base rotations."""
    batch, n = len(strains), len(robot.rotations)
    alpha = np.broadcast_to(robot.rotations, (batch, n))
    empty = np.zeros((batch, n))
    at_rest = State(
        np.zeros((batch, 3)),
        R_d3(alpha[:, 0]),
        empty[:, :0],
        empty[:, :0],
        alpha - alpha[:, :1],
        empty,
        empty,
    )
    return at_rest.with_strains(strains)


def march(
    robot: Sections, strains: Array, options: Options, scales: Scales, record: Record | None = None
) -> Array:
    """Return the scaled left-over wrenches (B, 4 + 2n) of a batch of base strains (B, 4 + 2n).

    Raises BlownUp. With a record, the states of the batch at its stations are kept in it.
    """
    state = base_state(robot, strains)
    left_over = []
    with np.errstate(all="ignore"):
        for i, (section, end) in enumerate(zip(robot.sections, robot.ends, strict=True)):
            state = integrate(section, state, options, scales, record)
            torque = scales.torque[list(section.tubes)]
            if i + 1 == len(robot.sections):
                sizes = np.concatenate([[scales.moment] * 2, torque, np.full(2 + len(torque), scales.force)])
                left_over.append(finish(section, end, state, options.transitions) / sizes)
            else:
                state, left = cross_over(section, end, robot.sections[i + 1], state, options.transitions)
                torque = torque[list(end.tubes)]
                left_over.append(
                    left / np.stack([np.full(len(torque), scales.force), torque], axis=1).ravel()
                )
    found = np.concatenate(left_over, axis=1)
    if not np.isfinite(found).all():
        raise BlownUp
    return found


def integrate(
    section: Section, state: State, options: Options, scales: Scales, record: Record | None = None
) -> State:
    """Return the state at the section's end, by SciPy's Dormand-Prince rule of order 8."""
    from scipy.integrate import DOP853

    n = len(section.tubes)
    y = state.pack()
    shape = y.shape

    def rate(s: float, y: Array) -> Array:
        there = State.unpack(y.reshape(shape), n)
        return state_rate(section, s, there, as_printed=options.as_printed).ravel()

    if record is not None and section.start == 0.0:
        record.add(section, -1.0, 0.0, lambda _: y)
    atol: Any = tolerances(section, shape, options, scales)
    limit = np.full(shape, np.inf)
    limit[:, 11 + n : 14 + n] = MAX_CURVATURE / scales.length
    try:
        solver = DOP853(rate, section.start, y.ravel(), section.end, rtol=options.rtol, atol=atol)
        for _ in range(MAX_STEPS):
            start = solver.t
            solver.step()
            if solver.status == "failed" or not (np.abs(solver.y) < limit.ravel()).all():
                break
            if record is not None:
                record.add(section, start, solver.t, solver.dense_output())
            if solver.status == "finished":
                return State.unpack(solver.y.reshape(shape), n)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise BlownUp from error
    raise BlownUp


def tolerances(section: Section, shape: tuple[int, ...], options: Options, scales: Scales) -> Array:
    """Return the absolute tolerance of every number of the packed state."""
    strains = strain_sizes(section, scales.length, scales.force)
    sizes = np.concatenate([np.full(3, scales.length), np.ones(8 + len(section.tubes)), strains])
    return options.rtol * np.broadcast_to(sizes, shape).ravel()
