"""Stretches: the polynomial form in which a tube reaches the solver."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.robot.along import Along
from tactr.robot.rest import RestShape

if TYPE_CHECKING:
    from tactr.robot.parts import Part
    from tactr.robot.pieces import Pieces, Vector3
    from tactr.robot.section import Stiffness
    from tactr.robot.varying import VaryingStiffness

QUANTITIES = 13
STRETCH = 10  # v*_z - 1 among them


@dataclass(frozen=True)
class Stretch:
    """A tube from sigma = ``start`` (m) to the next stretch: ``powers`` of d = sigma - start, ascending.

    powers[k] holds, for d^k, the coefficients of EI_x, EI_y, GJ (N m^2), EA, GA (N), u*_x, u*_y, u*_z (1/m),
    v*_x, v*_y, v*_z - 1, and the neutral axis x, y (m), in the tube's material frame; 1 to 8 rows, one where
    constant.
    """

    start: float
    powers: tuple[tuple[float, ...], ...]

    @property
    def constant(self) -> bool:
        """Whether nothing varies."""
        return len(self.powers) == 1


def starts_of(quantities: Iterable[float | Along], end: float) -> set[float]:
    """Places below ``end`` (m) where a quantity may jump, 0 among them."""
    inside = (start for q in quantities if isinstance(q, Along) for start, _ in q.parts if start < end)
    return {0.0, *inside}


def powers_at(quantities: Sequence[float | Along], start: float) -> np.ndarray:
    """Coefficients (count, width) in powers of sigma - ``start`` (m), of what holds from there on."""
    columns = [q.powers_at(start) if isinstance(q, Along) else (q,) for q in quantities]
    powers = np.zeros((max(len(column) for column in columns), len(columns)))
    for k, column in enumerate(columns):
        powers[: len(column), k] = column
    return powers


def stretches_of(
    parts: Sequence[Part], precurvature: Pieces[Vector3] | RestShape, length: float
) -> tuple[Stretch, ...]:
    """Stretches between all places where a section, its stiffness or the rest shape may jump."""
    rest = precurvature if isinstance(precurvature, RestShape) else _rest_of(precurvature)
    starts = starts_of((*rest.u, *rest.v), length)
    for part in parts:
        inside = starts_of(_constants(part.stiffness), part.end)
        starts |= {part.start, *(start for start in inside if start > part.start)}
    return tuple(_stretch(start, parts, rest) for start in sorted(starts))


def _rest_of(pieces: Pieces[Vector3]) -> RestShape:
    if len(pieces) == 1:
        return RestShape(pieces[0][1])
    starts = [start for start, _ in pieces]
    x, y, z = (Along.steps(starts, [u[k] for _, u in pieces]) for k in range(3))
    return RestShape((x, y, z))


def _constants(stiffness: Stiffness | VaryingStiffness) -> tuple[float | Along, ...]:
    k = stiffness
    return (k.EI_x, k.EI_y, k.GJ, k.EA, k.GA, *k.neutral_axis)


def _stretch(start: float, parts: Sequence[Part], rest: RestShape) -> Stretch:
    part = [part for part in parts if part.start <= start][-1]
    constants = _constants(part.stiffness)
    powers = powers_at((*constants[:5], *rest.u, *rest.v, *constants[5:]), start)
    powers[0, STRETCH] -= 1.0
    while len(powers) > 1 and not powers[-1].any():
        powers = powers[:-1]
    return Stretch(start, tuple(tuple(float(c) for c in row) for row in powers))
