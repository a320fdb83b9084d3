"""What a batch found: arrays, the item first."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tactr.errors import RobotError
from tactr.statics.solve import Prepared
from tactr.statics.status import Status

if TYPE_CHECKING:
    from tactr.batch.items import Items
    from tactr.robot import Robot
    from tactr.statics.derivatives import Jacobian
    from tactr.statics.shape import Shape
    from tactr.statics.stations import Stations

INVALID = "invalid"
NAMES = (*(status.value for status in Status), INVALID)
"""What the numbers in ``Batch.status`` mean."""
CODE = {name: code for code, name in enumerate(NAMES)}


@dataclass(frozen=True, repr=False, eq=False)
class Batch:
    """Results of ``solve_batch``: k items first in every array; NaN where an item did not converge.

    status (k,) int8, see ``status_names`` and ``message(i)``. Always there: tip_position (k, 3) m and
    tip_quaternion (k, 4) w, x, y, z of the distal end, world axes; tendon_length (k, tendons) m; tension (k,
    tendons) N, found or given; residual (k,), discretisation_error (k,) m. On request, else None: centreline
    (k, stations, 3) m and s (k, stations) m ("shape"); jacobian, a ``Jacobian`` of arrays (k, 6, tendons or
    tubes) as ``Shape.tip_jacobian``; compliance (k, 6, 6); stable (k,) bool and margin (k,) ("stability", see
    ``Stability``); energy (k,) J of the tubes; strain (k, tubes, 6), the largest |u - u*| (1/m) and |v - v*|
    at the stations, in the tubes' own frames.
    """

    status: np.ndarray
    tip_position: np.ndarray
    tip_quaternion: np.ndarray
    tendon_length: np.ndarray
    tension: np.ndarray
    residual: np.ndarray
    discretisation_error: np.ndarray
    s: np.ndarray | None
    centreline: np.ndarray | None
    jacobian: Jacobian | None
    compliance: np.ndarray | None
    stable: np.ndarray | None
    margin: np.ndarray | None
    energy: np.ndarray | None
    strain: np.ndarray | None
    tolerance: float
    _items: Items
    _stations: Stations
    _invalid: dict[int, RobotError]

    def __len__(self) -> int:
        return len(self.status)

    @property
    def converged(self) -> np.ndarray:
        """Which items have a shape, (k,) bool; it may be unstable: see ``status``."""
        return (self.status == CODE[Status.CONVERGED.value]) | (self.status == CODE[Status.UNSTABLE.value])

    @property
    def status_names(self) -> np.ndarray:
        """The statuses in words, (k,): those of ``Status``, and "invalid"."""
        return np.array(NAMES)[self.status]

    def robot(self, i: int) -> Robot:
        """The robot of item i at its actuation. Raises RobotError if it is invalid."""
        k = self._index(i)
        return self._items.actuated(k, self._items.design(k))

    def shape(self, i: int) -> Shape:
        """The whole Shape of item i, solved again by itself. Raises RobotError if it is invalid."""
        return Prepared(self.robot(i), tolerance=self.tolerance, stations=self._stations).solve()

    def message(self, i: int) -> str:
        """What happened to item i; for a failure its cause and remedy. Solves it again."""
        k = self._index(i)
        return str(self._invalid[k]) if k in self._invalid else self.shape(k).message

    def __repr__(self) -> str:
        counted = Counter(self.status_names.tolist())
        told = ", ".join(f"{number} {name}" for name, number in counted.most_common())
        return f"<Batch of {self._items.base.name or 'robot'}, {len(self)} items: {told or 'empty'}>"

    def _index(self, i: int) -> int:
        if not -len(self) <= i < len(self):
            raise IndexError(f"item {i} of {len(self)}")
        return int(i) % len(self)
