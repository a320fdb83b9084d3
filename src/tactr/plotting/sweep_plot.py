"""A picture of a sweep: the tips in projections and slices, coloured by a quantity, and histograms."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import RobotError
from tactr.plotting.palette import tube_colour
from tactr.plotting.shape_plot import empty_figure, saved, ticks
from tactr.studies.derived import Named, derived, named, names
from tactr.studies.summary import holds, spread_rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactr.studies import Sweep

MOST_POINTS = 60_000  # in a picture; more would only cover each other
SIDES = ((0, 2), (1, 2), (0, 1))
COLOURS = "viridis"  # told apart by colour-blind people and in grey
UNSTABLE, EMPTY = "#C8C8C8", "#e3e3e3"
SLICE_SHARE = 0.06  # thickness of a slice in the longest side
HISTOGRAMS = ("stability_margin", "manipulability", "tip_stiffness", "isotropy", "energy", "z")
OUTLIERS = 2.0  # per cent at each end that do not stretch the scale of colours


def plot_sweep(sweep: Sweep, path: str | os.PathLike[str] | None = None, *, colour: str = "z") -> Figure:
    """Draw tips, in mm, and return the matplotlib Figure; saved to `path` where given.

    Above projections, below slices through the middle; unstable shapes grey. Raises RobotError where nothing
    is reached or there is no such quantity, MissingExtra without matplotlib, FileError.
    """
    shown = named(sweep, colour)
    rows = spread_rows(sweep, MOST_POINTS)
    tips = 1e3 * sweep.dataset["tip_position"][rows].values
    good, found = holds(sweep, rows), np.isfinite(tips.sum(axis=1))
    if not good.any():
        raise RobotError("sweep", "no stable shape was found: there is nothing to draw")
    values = derived(sweep, colour, rows) * shown.factor
    figure = empty_figure(13.0, 12.0)
    grid = figure.add_gridspec(3, 3, height_ratios=(1.2, 1.2, 0.8))
    limits = _limits(tips[found])
    scale = np.nanpercentile(values[good], [OUTLIERS, 100.0 - OUTLIERS])
    drawn = []
    for k, side in enumerate(SIDES):
        axes = figure.add_subplot(grid[0, k])
        _points(axes, tips[found & ~good], None, side, None)
        drawn.append(_points(axes, tips[good], values[good], side, scale))
        _frame(axes, side, limits, "all tips")
        _slice(figure.add_subplot(grid[1, k]), tips[good], values[good], side, scale, limits)
    bar = figure.colorbar(drawn[-1], ax=figure.axes, location="right", shrink=0.7, pad=0.02, aspect=40)
    bar.set_label(str(shown))
    for k, name in enumerate(_histograms(sweep, colour)):
        _histogram(figure.add_subplot(grid[2, k]), derived(sweep, name, rows[good]), named(sweep, name))
    figure.suptitle(_title(sweep, rows, good, found))
    return saved(figure, path, dpi=120)


def _limits(tips: np.ndarray) -> np.ndarray:
    low, high = tips.min(axis=0), tips.max(axis=0)
    margin = 0.04 * (high - low).max()
    return np.stack([low - margin, high + margin])


def _points(axes: Any, tips: np.ndarray, values: np.ndarray | None, side: tuple[int, int], scale: Any) -> Any:
    size = float(np.clip(6e4 / max(len(tips), 1), 0.7, 14.0))
    across, up = side
    if values is None:
        return axes.scatter(tips[:, across], tips[:, up], s=size, c=UNSTABLE, lw=0, rasterized=True)
    order = np.argsort(tips[:, 3 - across - up])  # the nearer ones last
    return axes.scatter(
        tips[order, across], tips[order, up], s=size, c=values[order], cmap=COLOURS, lw=0, rasterized=True,
        vmin=scale[0], vmax=scale[1],
    )  # fmt: skip


def _slice(
    axes: Any, tips: np.ndarray, values: np.ndarray, side: tuple[int, int], scale: Any, limits: np.ndarray
) -> None:
    across = 3 - sum(side)
    thickness = SLICE_SHARE * (limits[1] - limits[0]).max()
    middle = 0.0 if across < 2 else float(np.median(tips[:, 2]))
    inside = np.abs(tips[:, across] - middle) <= 0.5 * thickness
    _points(axes, tips[inside], values[inside], side, scale)
    _frame(axes, side, limits, f"slice of {thickness:.3g} mm at {'xyz'[across]} = {middle:.3g} mm")


def _frame(axes: Any, side: tuple[int, int], limits: np.ndarray, title: str) -> None:
    across, up = side
    axes.set(
        xlabel=f"{'xyz'[across]} (mm)", ylabel=f"{'xyz'[up]} (mm)", aspect="equal",
        xlim=limits[:, across], ylim=limits[:, up],
    )  # fmt: skip
    axes.set_title(title, fontsize=10)
    axes.xaxis.set_major_locator(ticks(5))
    axes.yaxis.set_major_locator(ticks(6))
    axes.grid(color=EMPTY, lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _histograms(sweep: Sweep, colour: str) -> list[str]:
    known = names(sweep)
    return [colour, *(name for name in HISTOGRAMS if name in known and name != colour)][:3]


def _histogram(axes: Any, values: np.ndarray, shown: Named) -> None:
    finite = values[np.isfinite(values)] * shown.factor
    low, high = np.percentile(finite, [0.0, 99.0])
    if high - low < 1e-6 * abs(high):  # the same all over
        low, high = low - 0.5 * abs(high), high + 0.5 * abs(high)
    axes.hist(finite, bins=60, range=(low, high), color=tube_colour(0))
    axes.set(xlabel=str(shown), ylabel="stable shapes")
    axes.spines[["top", "right"]].set_visible(False)


def _title(sweep: Sweep, rows: np.ndarray, good: np.ndarray, found: np.ndarray) -> str:
    drawn = f"{sweep.count} configurations"
    if len(rows) < sweep.count:
        drawn = f"{len(rows)} of {drawn} drawn"
    unstable = int((found & ~good).sum())
    grey = f", {unstable} unstable (grey)" if unstable else ""
    none = int((~found).sum())
    return f"{sweep.dataset.attrs['title']}: {drawn}, {int(good.sum())} stable{grey}" + (
        f", {none} without a shape" if none else ""
    )
