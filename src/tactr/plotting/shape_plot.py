"""A picture of a shape: a view in 3D and projections on the x-z and y-z planes."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import FileError, MissingExtra
from tactr.plotting.curves import Drawing, drawing
from tactr.plotting.palette import GUIDE_COLOUR, MARK_COLOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactr.statics import Shape

SMALLEST_SHARE = 0.5
"""A flat shape still gets this share of its largest extent in every direction."""

MOST_IN_A_ROW = 6


def plot_shape(shape: Shape, path: str | os.PathLike[str] | None = None) -> Figure:
    """Draw a shape and return the matplotlib Figure, which notebooks display; saved to `path` where given.

    Lengths in mm, equal scales. Raises NotConverged where there is no shape, MissingExtra without matplotlib,
    FileError where the picture cannot be written.
    """
    content = drawing(shape)
    low, high = _limits(content)
    figure = empty_figure(11, min(max(1.6 + 3.0 * (high - low)[2] / (high - low)[0], 4.4), 6.0))
    grid = figure.add_gridspec(1, 3, width_ratios=(1.5, 1, 1))
    _space(figure.add_subplot(grid[0], projection="3d"), content, low, high)
    views = [_projection(figure, grid[k + 1], content, k, low, high) for k in (0, 1)]
    views[1].sharey(views[0])
    views[1].tick_params(labelleft=False)
    _words(figure, shape, views[0])
    return saved(figure, path)


def empty_figure(width: float, height: float) -> Any:
    """An empty figure of a size in inches. Raises MissingExtra."""
    try:
        from matplotlib.figure import Figure
        from matplotlib.layout_engine import ConstrainedLayoutEngine
    except ImportError:
        raise MissingExtra("matplotlib", "plot", "a picture") from None

    class DisplayedFigure(Figure):
        """A figure outside pyplot's global state that notebooks display by itself."""

        def _repr_png_(self) -> bytes:
            from io import BytesIO

            buffer = BytesIO()
            self.savefig(buffer, format="png")
            return buffer.getvalue()

    return DisplayedFigure(figsize=(width, height), layout=ConstrainedLayoutEngine(wspace=0.13))


def saved(figure: Figure, path: str | os.PathLike[str] | None, *, dpi: int = 150) -> Figure:
    """The figure, written to `path` where given. Raises FileError."""
    if path is not None:
        try:
            figure.savefig(path, dpi=dpi)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise FileError(f"cannot be written: {reason}", path=path) from None
    return figure


def _limits(content: Drawing) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (mm) of what is shown; x and y get the same, large enough extent."""
    points = np.vstack([content.points, [[0.0, 0.0, 0.0]]])
    low, high = points.min(axis=0), points.max(axis=0)
    middle, extent = (low + high) / 2, high - low
    extent[:2] = max(extent[:2].max(), SMALLEST_SHARE * extent.max())
    extent[2] = max(extent[2], SMALLEST_SHARE * extent.max())
    return middle - 0.54 * extent, middle + 0.54 * extent


def _space(axes: Any, content: Drawing, low: np.ndarray, high: np.ndarray) -> None:
    for curve in (*content.tubes, *content.tendons):
        x, y, z = curve.points.T
        axes.plot(x, y, z, color=curve.colour, lw=curve.width, solid_capstyle="butt")
    axes.scatter(*content.marks.T, s=26, c="white", edgecolors=MARK_COLOUR, depthshade=False, zorder=10)
    axes.scatter(*content.ends.T, s=7, c=MARK_COLOUR, depthshade=False, zorder=9)
    axes.plot([0, 0], [0, 0], [low[2], 0], color=GUIDE_COLOUR, lw=9, solid_capstyle="butt")
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.0)
    axes.view_init(elev=18, azim=-52)
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y"), (axes.zaxis, "z")):
        axis.set_major_locator(ticks(5))
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
        axis.set_label_text(f"{name} (mm)")
        axis._axinfo["grid"].update(color="#dddddd", linewidth=0.7)
    axes.zaxis.labelpad = 9


def _projection(figure: Any, cell: Any, content: Drawing, k: int, low: np.ndarray, high: np.ndarray) -> Any:
    axes = figure.add_subplot(cell)
    for order, curve in enumerate((*content.tubes, *content.tendons)):
        axes.plot(
            curve.points[:, k], curve.points[:, 2], color=curve.colour, lw=curve.width, solid_capstyle="butt",
            zorder=2 + order, label=curve.label or "_",
        )  # fmt: skip
    axes.scatter(content.marks[:, k], content.marks[:, 2], s=26, c="white", edgecolors=MARK_COLOUR, zorder=30,
                 label="transition point" if len(content.marks) else "_")  # fmt: skip
    axes.scatter(content.ends[:, k], content.ends[:, 2], s=7, c=MARK_COLOUR, zorder=29)
    axes.plot([0, 0], [low[2], 0], color=GUIDE_COLOUR, lw=9, solid_capstyle="butt", zorder=1, label="guide")
    axes.set(xlim=(low[k], high[k]), ylim=(low[2], high[2]), aspect="equal")
    axes.set_xlabel(f"{'xy'[k]} (mm)")
    axes.set_ylabel("z (mm)" if k == 0 else "")
    axes.xaxis.set_major_locator(ticks(5))
    axes.grid(color="#e3e3e3", lw=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    return axes


def ticks(count: int) -> Any:
    """At most so many ticks, at round numbers."""
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(count, steps=[1, 2, 5, 10])


def _words(figure: Any, shape: Shape, axes: Any) -> None:
    x, y, z = 1e3 * shape.tip_position + 0.0
    figure.suptitle(shape.robot.name or "robot", fontsize=14, fontweight="bold", x=0.01, ha="left")
    figure.text(0.99, 0.985, f"tip ({x:.1f}, {y:.1f}, {z:.1f}) mm", ha="right", va="top", fontsize=11)
    entries = list(zip(*axes.get_legend_handles_labels(), strict=True))
    columns = len(entries) if len(entries) <= MOST_IN_A_ROW else -(-len(entries) // 2)
    # Legends fill their columns first; people read rows.
    entries = [entry for k in range(columns) for entry in entries[k::columns]]
    figure.legend(
        *zip(*entries, strict=True), loc="outside lower center", ncols=columns, frameon=False, fontsize=11
    )
