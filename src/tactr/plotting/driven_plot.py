"""A picture of a path with friction: the tip over what is actuated, and what friction changes."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import RobotError
from tactr.plotting.palette import MARK_COLOUR, tube_colour
from tactr.plotting.shape_plot import empty_figure, saved, ticks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactr.friction import Driven

MOST_LOOPS = 3
ARROWS = 6  # along a loop
GRID = "#e3e3e3"
SHOWN = {
    "tension": (1.0, "tension of {} (N)"),
    "displacement": (1e3, "displacement of {} (mm)"),
    "rotation": (180.0 / np.pi, "rotation of {} (°)"),
    "translation": (1e3, "translation of {} (mm)"),
}


@dataclass(frozen=True)
class _Driver:
    """An actuator that the path moves: its label, its values (k,) as shown."""

    label: str
    values: np.ndarray


def plot_driven(driven: Driven, path: str | os.PathLike[str] | None = None) -> Figure:
    """Draw the tip over each actuator that moves, three at most, and below how far it is from the tip without
    friction; returns the matplotlib Figure, saved to `path` where given.

    Raises RobotError where nothing moves or there is no shape, MissingExtra without matplotlib, FileError.
    """
    tips, plain = 1e3 * driven.tips, 1e3 * driven.frictionless_tips()
    if not np.isfinite(tips).all(axis=1).any():
        raise RobotError("driven", f"there is no shape to draw: {driven.message}")
    drivers = _drivers(driven)
    if not drivers:
        raise RobotError("driven", "nothing is actuated differently along the path: there is no loop to draw")
    figure = empty_figure(max(4.2 * len(drivers), 6.5), 7.2)
    grid = figure.add_gridspec(2, len(drivers), height_ratios=(1.5, 1.0))
    for k, driver in enumerate(drivers):
        _loop(figure.add_subplot(grid[0, k]), driver, tips, plain)
    _error(figure.add_subplot(grid[1, :]), np.linalg.norm(tips - plain, axis=1))
    entries = figure.axes[0].get_legend_handles_labels()
    figure.legend(*entries, loc="outside lower center", ncols=3, frameon=False, fontsize=11)
    name = driven[0].robot.name or "robot"
    figure.suptitle(f"{name}: {len(driven)} points with friction", x=0.01, ha="left", fontweight="bold")
    return saved(figure, path)


def _drivers(driven: Driven) -> list[_Driver]:
    """The actuators that move, at most so many: those that move while the tip does."""
    robot, found = driven[0].robot, []
    given = [state.given or state.passed for state in driven.states]
    for kind, (factor, label) in SHOWN.items():
        members = robot.tendons if kind in ("tension", "displacement") else robot.tubes
        values = factor * np.array([getattr(each, kind) for each in given]).reshape(len(given), len(members))
        for member, column in zip(members, values.T, strict=True):
            if np.isfinite(column).all() and np.ptp(column) > 1e-9:
                found.append(_Driver(label.format(member.name), column))
    moved = np.linalg.norm(np.diff(driven.tips, axis=0), axis=1)

    def weight(driver: _Driver) -> float:
        share = np.abs(np.diff(driver.values)) / np.ptp(driver.values)
        return float(np.nansum(share * moved))

    most = sorted(found, key=weight, reverse=True)[:MOST_LOOPS]
    return [driver for driver in found if driver in most]


def _loop(axes: Any, driver: _Driver, tips: np.ndarray, plain: np.ndarray) -> None:
    steps = np.abs(np.diff(driver.values))[:, None] * np.abs(np.diff(tips, axis=0))
    axis = int(np.argmax(np.nansum(steps, axis=0)))
    x, y = driver.values, tips[:, axis]
    axes.plot(
        x, plain[:, axis], color=MARK_COLOUR, ls=(0, (4, 3)), lw=1.6, label="without friction", zorder=2
    )
    axes.plot(x, y, color=tube_colour(0), lw=2.6, label="with friction", zorder=3)
    seen = np.flatnonzero(np.isfinite(y))
    axes.plot(x[seen[0]], y[seen[0]], "o", ms=8, color=tube_colour(1), mec="white", zorder=5,
              label="first point")  # fmt: skip
    _arrows(axes, x, y)
    axes.set(xlabel=driver.label, ylabel=f"tip {'xyz'[axis]} (mm)")
    axes.xaxis.label.set_size(12)
    axes.yaxis.label.set_size(12)
    _plain(axes)


def _arrows(axes: Any, x: np.ndarray, y: np.ndarray) -> None:
    """Which way the loop is passed, at places even along the drawn line."""
    spans = np.array([np.ptp(x), np.nanmax(y) - np.nanmin(y)])
    steps = np.stack([np.diff(x), np.diff(y)], axis=1) / np.where(spans > 0.0, spans, 1.0)
    lengths = np.nan_to_num(np.linalg.norm(steps, axis=1))
    way = np.concatenate([[0.0], np.cumsum(lengths)])
    for share in (np.arange(ARROWS) + 0.5) / ARROWS:
        k = min(int(np.searchsorted(way, share * way[-1], side="right")) - 1, len(lengths) - 1)
        if lengths[k] > 0.0:
            part = (share * way[-1] - way[k]) / lengths[k]
            place = (x[k] + part * (x[k + 1] - x[k]), y[k] + part * (y[k + 1] - y[k]))
            towards = (x[k + 1] - x[k], y[k + 1] - y[k])
            ahead = (place[0] + 1e-3 * towards[0], place[1] + 1e-3 * towards[1])
            style = {"arrowstyle": "-|>", "color": tube_colour(0), "lw": 0.0, "mutation_scale": 20}
            axes.annotate("", ahead, place, arrowprops=style, zorder=4)


def _error(axes: Any, error: np.ndarray) -> None:
    points = np.arange(1, len(error) + 1)
    axes.plot(points, error, color=tube_colour(1), lw=2.0, marker="." if len(error) < 60 else "")
    axes.set(xlabel="point of the path", ylabel="distance (mm)", ylim=(0, None))
    axes.set_title("distance of the tip from the frictionless model's", fontsize=11)
    axes.xaxis.label.set_size(12)
    axes.yaxis.label.set_size(12)
    _plain(axes)
    axes.xaxis.get_major_locator().set_params(integer=True)


def _plain(axes: Any) -> None:
    axes.xaxis.set_major_locator(ticks(6))
    axes.yaxis.set_major_locator(ticks(6))
    axes.tick_params(labelsize=11)
    axes.grid(color=GRID, lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
