"""A picture of a calibration's residuals: over the rows, in space, and how they are distributed."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.plotting.palette import MARK_COLOUR, tube_colour
from tactr.plotting.shape_plot import empty_figure, saved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactr.calibration import Calibration

AXES = "xyz"
SIDES = ((0, 2), (1, 2))


def plot_calibration(result: Calibration, path: str | os.PathLike[str] | None = None) -> Figure:
    """Draw residuals, in mm, and return the matplotlib Figure; saved to `path` where given.

    Raises MissingExtra without matplotlib, FileError where the picture cannot be written.
    """
    figure = empty_figure(11.0, 7.5)
    grid = figure.add_gridspec(2, 3, height_ratios=(1, 1.15))
    _over_rows(figure.add_subplot(grid[0, :2]), result)
    _distribution(figure.add_subplot(grid[0, 2]), result)
    for k, (across, up) in enumerate(SIDES):
        _in_space(figure.add_subplot(grid[1, k]), result, across, up)
    _by_component(figure.add_subplot(grid[1, 2]), result)
    error = result.error * 1e3
    figure.suptitle(
        f"{result.robot.name or 'robot'}: {len(error)} rows, mean error {np.nanmean(error):.2f} mm"
        + (f", held out {result.hold_out.mean * 1e3:.2f} mm" if result.hold_out else "")
    )
    return saved(figure, path)


def _over_rows(axes: Any, result: Calibration) -> None:
    rows = np.arange(len(result.error))
    size = 3.0 if len(rows) > 200 else 7.0
    axes.plot(rows, result.error * 1e3, ".", ms=size, color=tube_colour(0), label="calibrated on all rows")
    if result.hold_out is not None:
        axes.plot(rows, result.hold_out.error * 1e3, ".", ms=size, color=tube_colour(1), label="held out")
        for change in (
            np.flatnonzero(np.diff(result.hold_out.fold)) if len(result.hold_out.folds) < 20 else ()
        ):
            axes.axvline(change + 0.5, color="#BBBBBB", lw=0.8, zorder=0)
    axes.set(xlabel="row", ylabel="error (mm)", ylim=(0, None))
    axes.legend(frameon=False, loc="upper right", markerscale=9.0 / size)


def _distribution(axes: Any, result: Calibration) -> None:
    sets = [(result.error, tube_colour(0))]
    if result.hold_out is not None:
        sets.append((result.hold_out.error, tube_colour(1)))
    for error, colour in sets:
        seen = np.sort(error[np.isfinite(error)]) * 1e3
        axes.plot(seen, np.arange(1, len(seen) + 1) / len(seen) * 100, color=colour)
    axes.set(xlabel="error (mm)", ylabel="rows below (%)", xlim=(0, None), ylim=(0, 100))


def _in_space(axes: Any, result: Calibration, across: int, up: int) -> None:
    measured = result.measurements.points.reshape(-1, 3) * 1e3
    residual = result.residual.reshape(-1, 3) * 1e3
    seen = np.isfinite(residual).all(axis=1)
    predicted = measured + residual
    ends = np.stack([measured[seen], predicted[seen]], axis=1)[:, :, [across, up]]
    from matplotlib.collections import LineCollection

    axes.add_collection(LineCollection(list(ends), colors=tube_colour(1), linewidths=0.7, zorder=3))
    axes.plot(
        *measured[seen][:, [across, up]].T, ".", ms=2.5 if len(measured) > 200 else 5.0, color=MARK_COLOUR
    )
    axes.set(xlabel=f"{AXES[across]} (mm)", ylabel=f"{AXES[up]} (mm)", aspect="equal")
    axes.set_title("measured (points) to predicted (lines)", fontsize="small")
    axes.autoscale_view()


def _by_component(axes: Any, result: Calibration) -> None:
    residual = result.residual.reshape(-1, 3) * 1e3
    seen = residual[np.isfinite(residual).all(axis=1)]
    edge = float(np.quantile(np.abs(seen), 0.995)) or 1.0
    for k, axis in enumerate(AXES):
        axes.hist(
            seen[:, k],
            bins=int(np.clip(np.sqrt(2.0 * len(seen)), 5, 40)),
            range=(-edge, edge),
            histtype="step",
            color=tube_colour(k),
            label=axis,
            lw=1.4,
        )
    axes.set(xlabel="predicted - measured (mm)", ylabel="points")
    axes.yaxis.get_major_locator().set_params(integer=True)
    axes.legend(frameon=False)
