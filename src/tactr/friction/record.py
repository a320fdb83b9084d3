"""What a drive has come by; shapes and states of its points are made when they are looked at."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Generic, NamedTuple, TypeVar, overload

import numpy as np

from tactr.friction.driven import Driven
from tactr.friction.state import DriveState
from tactr.statics.shape import Shape

T = TypeVar("T")


class Later(Sequence[T], Generic[T]):
    """Things that are made when they are first looked at."""

    def __init__(self, makers: Sequence[Callable[[], T]]) -> None:
        self._makers, self._made = makers, {}

    @overload
    def __getitem__(self, k: int) -> T: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[T]: ...
    def __getitem__(self, k: int | slice) -> T | Sequence[T]:
        if isinstance(k, slice):
            return tuple(self[i] for i in range(*k.indices(len(self))))
        k = range(len(self))[k]
        if k not in self._made:
            self._made[k] = self._makers[k]()
        return self._made[k]

    def __len__(self) -> int:
        return len(self._makers)

    def __repr__(self) -> str:
        return repr(tuple(self))


class Reached(NamedTuple):
    """A point. failed: why it is not reached; steps: on the way to it; heats, creeps: by channel; tube_heats:
    by tube; held: as of ``Settled``."""

    shape: Callable[[], Shape]
    state: Callable[[], DriveState]
    failed: str
    steps: int
    heats: list[float]
    creeps: list[float]
    tube_heats: np.ndarray
    held: int


def driven_of(points: list[Reached], tendons: int, index: list[int]) -> Driven:
    """The result. tendons: how many; index: tendon of every channel."""
    shapes, states, failed, steps, heats, creeps, tube_heats, held = zip(*points, strict=True)
    heat, creep = np.zeros((2, len(points), tendons))
    heat[:, index], creep[:, index] = heats, creeps
    return Driven(
        Later(shapes), Later(states), failed, steps, heat, creep, np.array(tube_heats), np.array(held)
    )
