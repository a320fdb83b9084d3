"""`solve`: a robot in, its shape by the published model out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tactr.errors import NotConverged
from tactr.reference.algebra import Array
from tactr.reference.compatibility import State, tube_strains
from tactr.reference.constitutive import elastic
from tactr.reference.cutting import cut
from tactr.reference.march import Options, Record, Scales, base_state, march
from tactr.reference.sections import Section, Sections
from tactr.reference.shooting import Missed, Shot, shoot, shoot_from_rest
from tactr.reference.transitions import Transitions
from tactr.robot import Robot


@dataclass(frozen=True)
class ReferenceTube:
    """One tube at the stations where it is present (k of them), everything in its own frame.

    s (k,) m; frames R_i (k, 3, 3); u (k, 3) 1/m; v (k, 3); elastic force n (k, 3) N and moment m (k, 3) N m.
    At a breakpoint: the values just before it.
    """

    name: str
    s: Array
    frames: Array
    u: Array
    v: Array
    n: Array
    m: Array


@dataclass(frozen=True)
class ReferenceShape:
    """Shape by the published model. World frame, SI units.

    tip (3,); s (k,); centreline (k, 3); frames (k, 3, 3) of the outermost tube present; tubes outermost
    first; u_base, v_base (n, 3): strains of all tubes at s = 0, which can start another solve; residual: the
    largest scaled wrench left over at a tube's end.
    """

    tip: Array
    s: Array
    centreline: Array
    frames: Array
    tubes: tuple[ReferenceTube, ...]
    u_base: Array
    v_base: Array
    residual: float
    iterations: int


def solve(
    robot: Robot,
    *,
    stations: int | Sequence[float] | Array = 11,
    guess: tuple[Array, Array] | None = None,
    transitions: Transitions = "resultant",
    as_printed: bool = False,
    rtol: float = 1e-10,
    tolerance: float = 1e-9,
) -> ReferenceShape:
    """Solve the published model for a `tactr.Robot` whose tubes all start at s = 0, by shooting.

    stations: arc lengths in m, or how many equally spaced ones from 0 to the tip. guess: strains (u, v), each
    (n, 3) in the tubes' own frames, at s = 0; without it (or where it does not converge) tensions, rest
    curvatures and loads are raised together from zero. transitions: "resultant", or "published" (see
    `tactr.reference.transitions`). as_printed: terms of `DIFFERENCES` as printed. rtol: of the integrator.
    tolerance: of the scaled left-over wrenches.

    Raises RobotError for a translated tube, ValueError for stations off the robot, NotConverged.
    """
    sections = cut(robot)
    s = stations_of(stations, sections.length)
    options = Options(rtol=rtol, transitions=transitions, as_printed=as_printed)
    shot = find(sections, guess, options, tolerance)
    record = Record(np.unique([0.0, *s, sections.length]))
    march(sections, shot.strains[None], options, Scales.of(sections), record)
    return shape_of(robot, sections, s, record, shot)


def stations_of(stations: int | Sequence[float] | Array, length: float) -> Array:
    """Return the stations as arc lengths (m) on the robot."""
    if isinstance(stations, int):
        return np.linspace(0.0, length, stations)
    s = np.asarray(stations, dtype=float)
    if s.ndim != 1 or not len(s) or not ((s >= 0.0) & (s <= length + 1e-12)).all():
        raise ValueError(f"stations must be arc lengths from 0 to {length} m, got {stations!r}")
    return np.minimum(s, length)


def find(sections: Sections, guess: tuple[Array, Array] | None, options: Options, tolerance: float) -> Shot:
    """Return the converged shot, from the guess if there is one and it leads there, else from rest."""
    if guess is not None:
        try:
            return shoot(sections, base_strains(*guess), options, tolerance)
        except Missed:
            pass
    try:
        return shoot_from_rest(sections, options, tolerance)
    except Missed as error:
        left = (
            "the march does not reach the tip"
            if error.best is None
            else f"residual {error.best.residual:.1e}"
        )
        raise NotConverged(
            f"shooting did not converge ({left}); give base strains near the solution as guess=(u, v)"
        ) from error


def base_strains(u: Array, v: Array) -> Array:
    """Return the base strains (4 + 2n) from every tube's strains (n, 3) in its own frame."""
    u, v = np.asarray(u, dtype=float), np.asarray(v, dtype=float)
    return np.concatenate([u[0], v[0] - [0.0, 0.0, 1.0], u[1:, 2], v[1:, 2] / v[0, 2] - 1.0])


def shape_of(robot: Robot, sections: Sections, s: Array, record: Record, shot: Shot) -> ReferenceShape:
    """Return the shape at the stations s from what was recorded at them, the base and the tip."""
    p = np.concatenate([state.p for _, _, state in record.found])
    R_1 = np.concatenate([state.R_1 for _, _, state in record.found])
    at = np.searchsorted(record.stations, s)
    base = tube_strains(base_state(sections, shot.strains[None]))
    return ReferenceShape(
        tip=p[-1],
        s=s,
        centreline=p[at],
        frames=R_1[at],
        tubes=tuple(tube_of(tube.name, i, s, record) for i, tube in enumerate(robot.tubes)),
        u_base=base.u[0],
        v_base=base.v[0],
        residual=shot.residual,
        iterations=shot.iterations,
    )


def tube_of(name: str, index: int, stations: Array, record: Record) -> ReferenceTube:
    """Return one tube at those of the stations that it reaches."""
    parts = [
        tube_at(section, s, state, section.tubes.index(index))
        for section, s, state in record.found
        if index in section.tubes
    ]
    s, *rest = (np.concatenate(part) for part in zip(*parts, strict=True))
    at = np.searchsorted(s, stations[stations <= s[-1]])
    return ReferenceTube(name, s[at], *(values[at] for values in rest))


def tube_at(section: Section, s: Array, state: State, i: int) -> tuple[Array, ...]:
    """Return s, frames, u, v, n, m of the section's tube i at some stations."""
    k = tube_strains(state)
    n, m = elastic(section, k)
    return s, state.R_1 @ k.R[:, i], k.u[:, i], k.v[:, i], n[:, i], m[:, i]
