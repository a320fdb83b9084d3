"""Whether tubes fit into each other: which of their parts must not meet, and whether they do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.robot.parts import Part
from tactr.robot.tube import Tube

ROUNDING = 1e-9
"""Relative slack of a fit: 0.7 mm and 700 um differ in the last digit."""


class Misfit(RobotError):
    """Tubes that do not fit where they are."""


class Clash(NamedTuple):
    """A part of the tube with index ``inner`` that is wider than the bore of a part of the one with index
    ``outer``: it must not come to lie there."""

    outer: int
    around: Part
    inner: int
    part: Part

    def meets(self, translation: np.ndarray) -> np.ndarray:
        """Whether the parts overlap at translations (..., tubes), m: (...) bool."""
        outer, inner = translation[..., self.outer], translation[..., self.inner]
        starts = self.around.start + outer, self.part.start + inner
        ends = self.around.end + outer, self.part.end + inner
        return np.maximum(*starts) < np.minimum(*ends)


def clashes(tubes: Sequence[Tube]) -> list[Clash]:
    """Where translations decide whether tubes fit: none, where no tube is stepped and all fit."""
    return [
        Clash(i, around, j, part)
        for j in range(1, len(tubes))
        for i in range(j - 1, -1, -1)  # the nearest tube around is the one to name
        for around in tubes[i].parts
        for part in tubes[j].parts
        if _too_wide(around, part)
    ]


def check_fit(tubes: Sequence[Tube]) -> None:
    """Raise Misfit unless every tube fits where it is. All are present at the guide's exit."""
    found = clashes(tubes)
    if found:
        translation = np.array([tube.translation for tube in tubes])
        for clash in found:
            if clash.meets(translation):
                raise _misfit(tubes, clash)


def _too_wide(around: Part, part: Part) -> bool:
    bore, width = around.section.inner_diameter, part.section.outer_diameter
    return bore is not None and width is not None and width > bore * (1 + ROUNDING)


def _misfit(tubes: Sequence[Tube], clash: Clash) -> Misfit:
    bore, width = clash.around.section.inner_diameter, clash.part.section.outer_diameter
    outer = f"tubes[{clash.outer}] {tubes[clash.outer].name!r}"
    place = clash.part.field.removeprefix("section").removesuffix("[1]")
    field = f"tubes[{clash.inner}].section{place}.outer_diameter"
    if not place:
        field = f"tubes[{clash.inner}].outer_diameter"
    if bore == 0:
        return Misfit(
            field,
            f"{tubes[clash.inner].name!r} lies inside {outer}, which is solid",
            "the solid rod last: tubes are listed outermost first",
            value=width,
        )
    return Misfit(
        field,
        f"{check.show(width, 'm')} does not fit into the bore {check.show(bore, 'm')} of {outer}",
        f"at most {check.show(bore, 'm')}, tubes listed outermost first",
        value=width,
    )
