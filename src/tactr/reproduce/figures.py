"""The figures of an experiment, as SVG. Only the model's shapes are drawn: measured ones are not public."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np

from tactr.errors import MissingExtra
from tactr.plotting.palette import GUIDE_COLOUR, mixed, tube_colour
from tactr.reproduce.labels import name_tips
from tactr.reproduce.records import Drawn, Experiment, Graph, Panel, View
from tactr.robot import Robot

WIDTH, LEGEND = 10.0, 0.4  # inches
LEFT, RIGHT, BOTTOM, TOP = 0.75, 0.15, 0.6, 0.4  # around flat views
SPACE_HEIGHT, MOST_HEIGHT = 4.0, 3.8  # of a row with 3D views, and of flat views
PALE = 0.6  # share of white in earlier stages
AXES: dict[View, tuple[int, int]] = {"top": (0, 1), "front": (0, 2), "side": (1, 2)}
ANGLES: dict[View, tuple[float, float]] = {"space": (20.0, -38.0), "isometric": (35.264, -45.0)}
THINNEST, STEP = 2.0, 2.4
FONTS: dict[Any, Any] = {"font.size": 11, "svg.fonttype": "path"}
STATIONS = 81


def figure_of(experiment: Experiment) -> bytes:
    """The figure of an experiment, an SVG file with its text as outlines. Raises MissingExtra."""
    try:
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("matplotlib", "plot", "a report with figures") from None
    rows = experiment.figure
    heights = [_height(row) for row in rows]
    with rc_context({**FONTS, "svg.hashsalt": experiment.key}):
        figure = Figure(figsize=(WIDTH, sum(heights) + LEGEND))
        FigureCanvasAgg(figure)  # measures texts, so that it is known where names fit
        for k, row in enumerate(rows):
            _draw_row(figure, row, LEGEND + sum(heights[k + 1 :]), heights[k])
        _legend(figure, experiment)
        file = BytesIO()
        figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    return file.getvalue()


def _height(row: Sequence[Panel | Graph]) -> float:
    """Inches that a row needs: 3D views are as high as wide, flat ones by the extent of their shapes."""
    if any(isinstance(panel, Panel) and panel.view in ANGLES for panel in row):
        return SPACE_HEIGHT
    width = WIDTH / len(row) - LEFT - RIGHT
    return min(max(width * _aspect(panel, row) for panel in row), MOST_HEIGHT) + TOP + BOTTOM


def _aspect(panel: Panel | Graph, row: Sequence[Panel | Graph]) -> float:
    if isinstance(panel, Graph):
        return 0.8
    low, high = _limits_in(row, panel.view)
    x, y = AXES[panel.view]
    return float((high[y] - low[y]) / (high[x] - low[x]))


def _draw_row(figure: Any, row: Sequence[Panel | Graph], bottom: float, height: float) -> None:
    """Draw a row into its part of the figure, which begins at `bottom` and is `height` high, in inches."""
    width = WIDTH / len(row)
    for k, panel in enumerate(row):
        inner = (k * width + LEFT, bottom + BOTTOM, width - LEFT - RIGHT, height - TOP - BOTTOM)
        if isinstance(panel, Graph):
            _draw_graph(_axes(figure, *inner), panel)
        elif panel.view in ANGLES:
            whole = (k * width, bottom + 0.1, width, height - 0.4)
            _draw_space(_axes(figure, *whole, projection="3d"), panel, *_limits_in(row, panel.view))
        else:
            _draw_plane(_axes(figure, *inner), panel, *_limits_in(row, panel.view))


def _axes(figure: Any, left: float, bottom: float, width: float, height: float, **kind: str) -> Any:
    """Axes at a place in inches."""
    total = figure.get_figheight()
    return figure.add_axes((left / WIDTH, bottom / total, width / WIDTH, height / total), **kind)


def _limits_in(row: Sequence[Panel | Graph], view: View) -> tuple[np.ndarray, np.ndarray]:
    """One scale for the same views in a row, so that they compare."""
    return _limits(
        [each for panel in row if isinstance(panel, Panel) and panel.view == view for each in panel.drawn]
    )


def _limits(drawn: Sequence[Drawn]) -> tuple[np.ndarray, np.ndarray]:
    """Corners (mm) of what is shown, with room around; a flat shape keeps part of its largest extent."""
    points = np.vstack([[[0.0, 0.0, 0.0]], *(1e3 * each.shape.centreline for each in drawn)])
    low, high = points.min(axis=0), points.max(axis=0)
    middle, extent = (low + high) / 2, high - low
    extent = 1.16 * np.maximum(extent, 0.45 * extent.max())
    return middle - extent / 2, middle + extent / 2


def _curves(drawn: Drawn) -> list[tuple[np.ndarray, dict[str, Any]]]:
    """Lines (k, 3) in mm and their style, outermost tube first, then tendons."""
    robot = drawn.shape.robot
    fine = drawn.shape.sample(_stations(robot))
    count, curves = len(robot.tubes), []
    for k, tube in enumerate(fine.tubes):
        width = THINNEST + STEP * (count - 1 - k)
        style = {
            "color": _colour(drawn, k),
            "lw": width * (0.75 if drawn.faded else 1.0),
            "solid_capstyle": "butt",
        }
        curves.append((1e3 * tube.position, style | ({"ls": (0, (3, 1.5))} if drawn.dashed else {})))
    if drawn.tendons:
        curves += [(1e3 * tendon.path, {"color": "#444444", "lw": 0.8}) for tendon in fine.tendons]
    return curves


def _stations(robot: Robot) -> np.ndarray:
    tips = [tube.tip for tube in robot.tubes]
    return np.unique(
        np.concatenate([np.linspace(0.0, max(tips), STATIONS), [tip for tip in tips if tip > 0]])
    )


def _colour(drawn: Drawn, index: int) -> str:
    colour = tube_colour(index + drawn.colour_from)
    return mixed(colour, "#ffffff", PALE) if drawn.faded else colour


def _draw_space(axes: Any, panel: Panel, low: np.ndarray, high: np.ndarray) -> None:
    for each in panel.drawn:
        for points, style in _curves(each):
            axes.plot(*points.T, **style)
    elevation, azimuth = ANGLES[panel.view]
    axes.view_init(elev=elevation, azim=azimuth)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=0.92)
    axes.set_title(panel.title, fontsize=12, fontweight="bold", y=1.02)
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y"), (axes.zaxis, "z")):
        axis.set_major_locator(_ticks(4 if name == "z" else 3))
        axis.labelpad = 0 if name == "z" else -3
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
        axis.set_label_text(f"{name} (mm)")
        axis._axinfo["grid"].update(color="#dddddd", linewidth=0.7)
        axis.set_tick_params(pad=-1, labelsize=9)


def _draw_plane(axes: Any, panel: Panel, low: np.ndarray, high: np.ndarray) -> None:
    x, y = AXES[panel.view]
    order = 2
    for each in panel.drawn:
        for points, style in _curves(each):
            order += 1
            axes.plot(points[:, x], points[:, y], zorder=order, **style)
        if each.label:
            tip = 1e3 * each.shape.tip_position
            colour = _colour(each, len(each.shape.robot.tubes) - 1)
            axes.plot(tip[x], tip[y], "o", ms=6, color=colour, mec="white", mew=0.8, zorder=90)
    axes.set(xlim=(low[x], high[x]), ylim=(low[y], high[y]), aspect="equal")
    axes.set(xlabel=f"{'xyz'[x]} (mm)", ylabel=f"{'xyz'[y]} (mm)")
    axes.set_title(panel.title, fontsize=12, fontweight="bold")
    axes.plot(0, 0, marker="s", ms=7, color=GUIDE_COLOUR, zorder=1)
    _plain(axes)
    _name_tips(axes, panel)


def _name_tips(axes: Any, panel: Panel) -> None:
    x, y = AXES[panel.view]
    named = [(each.label, 1e3 * each.shape.tip_position[[x, y]]) for each in panel.drawn if each.label]
    lines = np.vstack([points[:, [x, y]] for each in panel.drawn for points, _ in _curves(each)])
    name_tips(axes, named, lines)


def _draw_graph(axes: Any, graph: Graph) -> None:
    for line in graph.lines:
        style = {"ls": (0, (4, 3)), "lw": 1.6} if line.dashed else {"lw": 2.0 if line.thin else 4.5}
        axes.plot(line.x, line.y, color=line.colour, label=line.label, **style)
    axes.set(xlabel=graph.x_label, ylabel=graph.y_label)
    axes.set_title(graph.title, fontsize=12, fontweight="bold")
    axes.legend(frameon=False, fontsize=10, handlelength=1.4, labelspacing=0.3)
    _plain(axes)


def _plain(axes: Any) -> None:
    axes.xaxis.set_major_locator(_ticks(5))
    axes.yaxis.set_major_locator(_ticks(6))
    axes.tick_params(labelsize=9.5)
    axes.grid(color="#e3e3e3", lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _ticks(count: int) -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(count, steps=[1, 2, 2.5, 5, 10])


def _legend(figure: Any, experiment: Experiment) -> None:
    from matplotlib.lines import Line2D

    panels = [panel for row in experiment.figure for panel in row if isinstance(panel, Panel)]
    drawn = panels[0].drawn[-1]
    entries = [
        Line2D([], [], color=_colour(drawn, k), lw=5, label=f"{tube.name} tube")
        for k, tube in enumerate(drawn.shape.robot.tubes)
    ]
    if any(each.tendons for panel in panels for each in panel.drawn):
        entries.append(Line2D([], [], color="#444444", lw=1, label="tendon"))
    figure.legend(handles=entries, loc="lower center", ncols=len(entries), frameon=False, fontsize=11)
