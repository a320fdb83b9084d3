"""How far actuators can go: for sliders and planners; a solve takes any value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from tactr.errors import RobotError
from tactr.robot import _check as check

Range = tuple[float, float]


@dataclass(frozen=True)
class TubeLimits:
    """Ranges (least, most) of a tube's actuators; None where none is known.

    rotation: rad. translation: m, most at most 0 (z of the proximal end, see ``Tube``). Raises RobotError.
    """

    _: KW_ONLY
    rotation: Range | None = None
    translation: Range | None = None

    if TYPE_CHECKING:  # any pair is taken; tuples are stored

        def __init__(
            self, *, rotation: Sequence[float] | None = None, translation: Sequence[float] | None = None
        ) -> None: ...

    def __post_init__(self) -> None:
        hint = "the proximal end is at the guide's exit or behind it"
        check.store(
            self,
            rotation=_range("rotation", self.rotation, "rad"),
            translation=_range("translation", self.translation, "m", most=0, hint=hint),
        )


@dataclass(frozen=True)
class TendonLimits:
    """Ranges (least, most) of a tendon's actuator; None where none is known.

    tension: N, least at least 0. displacement: m. Raises RobotError.
    """

    _: KW_ONLY
    tension: Range | None = None
    displacement: Range | None = None

    if TYPE_CHECKING:

        def __init__(
            self, *, tension: Sequence[float] | None = None, displacement: Sequence[float] | None = None
        ) -> None: ...

    def __post_init__(self) -> None:
        check.store(
            self,
            tension=_range("tension", self.tension, "N", least=0, hint="a tendon cannot push"),
            displacement=_range("displacement", self.displacement, "m"),
        )


def _range(
    field: str,
    value: object,
    unit: str,
    *,
    least: float | None = None,
    most: float | None = None,
    hint: str = "",
) -> Range | None:
    if value is None:
        return None
    expected = f"(least, most) in {unit}"
    ends = check.row(field, value, expected)
    if len(ends) != 2:
        raise RobotError(field, f"{len(ends)} entries found", expected, value=value)
    low, high = (
        check.real(f"{field}[{k}]", end, unit, least=least, most=most, hint=hint)
        for k, end in enumerate(ends)
    )
    if not low < high:
        raise RobotError(
            field, f"{check.show(low, unit)} is not below {check.show(high, unit)}", expected, value=value
        )
    return low, high


def plain_limits(value: object, kind: type[TubeLimits] | type[TendonLimits]) -> object:
    """Limits of this kind or None, checked."""
    if value is None or isinstance(value, kind):
        return value
    raise RobotError(
        "limits", f"{check.show(value)} is not a {kind.__name__}", f"a {kind.__name__}, or None", value=value
    )
