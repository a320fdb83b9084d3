"""Insertions that fit together: tips and proximal ends in order, sampled without rejection."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot, Tube
from tactr.robot import _check as check
from tactr.studies.chain import Chain


@dataclass(frozen=True)
class InsertionOrder:
    """Rules between the translations of neighbouring tubes, the more outer one first; None: no such rule.

    exposed: m, at least by which a tube reaches further out of the guide than the next outer one (0: no tube
    ends behind the next outer one). carriages: m, at least by which its proximal end, where its actuator
    holds it, is behind that of the next outer one. Translations with a range are sampled uniformly over all
    that meet ranges and rules; those without are kept. Raises RobotError.
    """

    _: KW_ONLY
    exposed: float | None = None
    carriages: float | None = None

    def __post_init__(self) -> None:
        if self.exposed is None and self.carriages is None:
            raise RobotError("insertion", "no rule is given", "exposed, carriages, or both, in m")
        for name in ("exposed", "carriages"):
            value = getattr(self, name)
            if value is not None:
                check.store(self, **{name: check.real(name, value, "m")})


@dataclass(frozen=True)
class Segment:
    """Neighbouring tubes whose translations are sampled together: their indices, and the set."""

    tubes: tuple[int, ...]
    chain: Chain


def segments(
    robot: Robot, rules: InsertionOrder, ranges: Mapping[int, tuple[float, float]]
) -> tuple[Segment, ...]:
    """The translations with ranges (m, by index of the tube), cut where a tube keeps its place. Raises
    RobotError where nothing meets all rules."""
    kept = [(tube.translation, tube.translation) for tube in robot.tubes]
    low, high = np.array([ranges.get(i, kept[i]) for i in range(len(kept))]).T
    least, most = _differences(robot, rules)
    for i in range(len(kept) - 1):  # what stays where it is bounds its neighbours
        if i not in ranges and i + 1 not in ranges and not least[i] <= low[i] - low[i + 1] <= most[i]:
            raise _impossible(_broken(robot.tubes[i], robot.tubes[i + 1], rules))
        if i not in ranges:
            low[i + 1], high[i + 1] = _cut(
                i + 1 in ranges, low, high, i + 1, low[i] - most[i], low[i] - least[i]
            )
        elif i + 1 not in ranges:
            low[i], high[i] = _cut(True, low, high, i, low[i + 1] + least[i], low[i + 1] + most[i])
    found = tuple(
        Segment(run, Chain(*(tuple(map(float, part)) for part in (
            low[list(run)], high[list(run)], least[list(run[:-1])], most[list(run[:-1])]
        ))))
        for run in _runs(sorted(ranges))
    )  # fmt: skip
    for segment in found:
        if not segment.chain.volume > 0.0:
            names = ", ".join(repr(robot.tubes[i].name) for i in segment.tubes)
            raise _impossible(f"within the ranges no translations of {names} meet them")
    return found


def _differences(robot: Robot, rules: InsertionOrder) -> tuple[np.ndarray, np.ndarray]:
    """Least and most of translation i - translation i + 1."""
    lengths = np.array([tube.length for tube in robot.tubes])
    count = len(lengths) - 1
    least = np.full(count, -math.inf if rules.carriages is None else rules.carriages)
    most = np.full(count, math.inf) if rules.exposed is None else np.diff(lengths) - rules.exposed
    return least, most


def _broken(outer: Tube, inner: Tube, rules: InsertionOrder) -> str:
    """By two tubes that both stay where they are."""
    exposed, behind = inner.tip - outer.tip, outer.translation - inner.translation
    found = f"{inner.name!r} reaches {check.show(exposed, 'm')} further out than {outer.name!r}"
    wanted = rules.exposed
    if wanted is None or exposed >= wanted:
        found = f"{inner.name!r} starts {check.show(behind, 'm')} behind {outer.name!r}"
        wanted = rules.carriages
    return f"{found}, both stay there, and it must be at least {check.show(wanted, 'm')}"


def _cut(
    moves: bool, low: np.ndarray, high: np.ndarray, i: int, least: float, most: float
) -> tuple[float, float]:
    return (max(low[i], least), min(high[i], most)) if moves else (low[i], high[i])


def _runs(indices: list[int]) -> list[tuple[int, ...]]:
    runs: list[list[int]] = []
    for i in indices:
        if runs and runs[-1][-1] == i - 1:
            runs[-1].append(i)
        else:
            runs.append([i])
    return [tuple(run) for run in runs]


def _impossible(problem: str) -> RobotError:
    return RobotError("insertion", f"the rules cannot be met: {problem}", "wider ranges, or smaller steps")
