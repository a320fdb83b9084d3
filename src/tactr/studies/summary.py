"""What all configurations of a sweep say together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import RobotError
from tactr.robot import _check as check
from tactr.statics.status import Status
from tactr.studies.derived import derived, named, names
from tactr.studies.reached import Reached, good_voxel, reached
from tactr.studies.unit_samples import permuted

if TYPE_CHECKING:
    from tactr.studies.result import Sweep

BLOCK = 1 << 18  # rows in memory at a time
MOST_LOOKED_AT = 1 << 17  # rows from which quantiles are taken
SHARES = (0.05, 0.5, 0.95)
OF_INTEREST = (
    "x", "y", "z", "stability_margin", "manipulability", "isotropy", "condition", "tip_stiffness", "energy",
)  # fmt: skip


@dataclass(frozen=True)
class Quantiles:
    """5, 50 and 95 % of a quantity over what is reached, in this unit."""

    low: float
    median: float
    high: float
    unit: str


@dataclass(frozen=True)
class Summary:
    """count: configurations; statuses: how many ended how, by name ("not solved yet" for those to come);
    converged: share of those solved; stable: share of those converged, None where stability was not asked
    for and no solve told; reached: by stable tips, None without any; quantiles: by name."""

    title: str
    count: int
    statuses: dict[str, int]
    converged: float
    stable: float | None
    reached: Reached | None
    quantiles: dict[str, Quantiles]

    def to_dict(self) -> dict[str, Any]:
        """As plain data, SI units but for the quantiles, which say theirs."""
        return asdict(self)

    def __str__(self) -> str:
        from tactr.studies.summary_text import text_of

        return text_of(self)


def summary_of(sweep: Sweep, *, voxel: float | None = None) -> Summary:
    """The summary of a sweep. voxel: m. Raises RobotError."""
    if voxel is not None:
        check.real("voxel", voxel, "m", above=0)
    status = sweep.dataset["status"].values
    counts = np.bincount(status + 1, minlength=len(sweep.status_names) + 1)
    told = dict(zip(("not solved yet", *sweep.status_names), map(int, counts), strict=True))
    solved = sweep.count - told["not solved yet"]
    converged = told[Status.CONVERGED.value] + told[Status.UNSTABLE.value]
    rows = spread_rows(sweep, MOST_LOOKED_AT)
    rows = rows[holds(sweep, rows)]
    return Summary(
        sweep.dataset.attrs["title"],
        sweep.count,
        {name: number for name, number in told.items() if number},
        converged / solved if solved else np.nan,
        _stable_share(sweep, status, converged),
        _reached(sweep, rows, voxel) if len(rows) else None,
        {name: _quantiles(sweep, name, rows) for name in OF_INTEREST if name in names(sweep) and len(rows)},
    )


def holds(sweep: Sweep, rows: slice | np.ndarray = slice(None)) -> np.ndarray:
    """Which rows have a shape where a robot stays: converged and, as far as known, stable."""
    status = sweep.dataset["status"][rows].values
    good = status == sweep.status_names.index(Status.CONVERGED.value)
    return good & (sweep.dataset["stable"][rows].values == 1) if "stable" in sweep.dataset else good


def spread_rows(sweep: Sweep, most: int) -> np.ndarray:
    """At most so many rows, from all over the sweep, ascending; the same ones every time."""
    if sweep.count <= most:
        return np.arange(sweep.count)
    return np.sort(permuted(np.arange(most), sweep.count, 0))


def _stable_share(sweep: Sweep, status: np.ndarray, converged: int) -> float | None:
    if not converged:
        return None
    return int(holds(sweep).sum()) / converged


def _reached(sweep: Sweep, rows: np.ndarray, voxel: float | None) -> Reached:
    edge = voxel or good_voxel(sweep.dataset["tip_position"][rows].values)
    largest = float(np.nanmax(np.abs(sweep.dataset["tip_position"][rows].values)))
    if edge < largest * 2e-6:
        raise RobotError("voxel", check.show(edge, "m"), f"at least {largest * 2e-6:.2g} m", value=voxel)
    return reached(_tips(sweep), edge)


def _tips(sweep: Sweep) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    for start in range(0, sweep.count, BLOCK):
        rows = slice(start, min(start + BLOCK, sweep.count))
        good = holds(sweep, rows)
        yield (
            sweep.dataset["tip_position"][rows].values[good],
            _in_half(sweep, np.arange(sweep.count)[rows])[good],
        )


def _in_half(sweep: Sweep, numbers: np.ndarray) -> np.ndarray:
    """The first half of the samples at every combination of values; of a mere grid, half of it at random."""
    each = sweep.samples_each
    if each > 1:
        return numbers % each < (each + 1) // 2
    return permuted(numbers, sweep.count, 1) < (sweep.count + 1) // 2


def _quantiles(sweep: Sweep, name: str, rows: np.ndarray) -> Quantiles:
    shown = named(sweep, name)
    values = derived(sweep, name, rows) * shown.factor
    with np.errstate(invalid="ignore"):
        low, median, high = np.quantile(values[~np.isnan(values)], SHARES) if len(values) else [np.nan] * 3
    return Quantiles(float(low), float(median), float(high), shown.unit)
