"""The tips of a sweep as a cloud of points in the scene, coloured by any of its quantities."""

from __future__ import annotations

import threading
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.plotting.palette import SCALE, scale_colours
from tactr.studies.derived import Named, derived, named, names
from tactr.studies.summary import holds, spread_rows
from tactr.viewer.viser_units import PER_METRE

if TYPE_CHECKING:
    from tactr.studies import Sweep

FLUID, MOST = 100_000, 1_000_000  # points at first, and at most
FEWEST = 1_000
PARTS = {
    "all": (0.0, 0.0, 0.0),
    "x below 0": (-1.0, 0.0, 0.0),
    "x above 0": (1.0, 0.0, 0.0),
    "y below 0": (0.0, -1.0, 0.0),
    "y above 0": (0.0, 1.0, 0.0),
}
OUTLIERS = 2.0  # per cent at each end that do not stretch the scale of colours


class Cloud:
    """A cloud and what moves it in the panel. Of more configurations than points an even choice is shown."""

    def __init__(self, server: Any, sweep: Sweep) -> None:
        self._server, self._sweep = server, sweep
        self._working = threading.Lock()
        self._node: Any = None
        gui, most = server.gui, min(MOST, sweep.count)
        with gui.add_folder("Configurations of the sweep"):
            self._shown = gui.add_checkbox("Show them", True)
            self._colour = gui.add_dropdown("Coloured by", list(names(sweep)), initial_value=self._first())
            self._legend = gui.add_html("")
            self._part = gui.add_dropdown("Part", list(PARTS), hint="a half lets one look inside")
            self._number = gui.add_slider(
                "Points", min=min(FEWEST, most), max=most, step=1, initial_value=min(FLUID, most),
                hint="of all configurations, an even choice",
            )  # fmt: skip
            self._size = gui.add_slider("Size (mm)", min=0.1, max=3.0, step=0.1, initial_value=0.3)
        self._draw()
        for handle in (self._colour, self._part, self._number):
            handle.on_update(lambda _: self._draw())
        self._shown.on_update(lambda _: self._dress())
        self._size.on_update(lambda _: self._dress())

    def _first(self) -> str:
        return "manipulability" if "manipulability" in names(self._sweep) else "z"

    def _draw(self) -> None:
        """Points and colours anew; of what is asked for meanwhile the last counts."""
        with self._working:
            rows = spread_rows(self._sweep, int(self._number.value))
            rows = rows[holds(self._sweep, rows)]
            tips = self._sweep.dataset["tip_position"][rows].values
            inside = tips @ np.array(PARTS[self._part.value]) >= 0.0
            rows, tips = rows[inside], tips[inside]
            shown = named(self._sweep, self._colour.value)
            values = derived(self._sweep, self._colour.value, rows) * shown.factor
            colours, low, high = coloured(values)
            if self._node is not None:
                self._node.remove()
            self._node = self._server.scene.add_point_cloud(
                "/cloud", PER_METRE * tips, colours, point_size=self._point_size(), point_shape="circle",
                point_shading="flat", precision="float32", visible=self._shown.value,
            )  # fmt: skip
            self._legend.content = legend_html(shown, low, high, len(rows), self._sweep.count)

    def _dress(self) -> None:
        self._node.visible, self._node.point_size = self._shown.value, self._point_size()

    def _point_size(self) -> float:
        return PER_METRE * 1e-3 * self._size.value


def coloured(values: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Colours (k, 3) of values (k,), and the ends of their scale; grey where there is none."""
    finite = values[np.isfinite(values)]
    low, high = np.percentile(finite, [OUTLIERS, 100.0 - OUTLIERS]) if len(finite) else (0.0, 1.0)
    colours = scale_colours(np.nan_to_num((values - low) / ((high - low) or 1.0)))
    colours[np.isnan(values)] = 150
    return colours, float(low), float(high)


def legend_html(shown: Named, low: float, high: float, points: int, count: int) -> str:
    """A bar of the scale with its ends, and how many points there are."""
    ends = f'<span>{low:.3g}</span><span style="float:right">{high:.3g} {escape(shown.unit)}</span>'
    bar = f'<div style="height:10px;background:linear-gradient(to right,{",".join(SCALE)})"></div>'
    text = f"{escape(str(shown))}: {points} stable tips of {count} configurations"
    return f'<div style="font-size:13px;padding:2px 10px 8px" data-cloud="{points}">{text}{bar}{ends}</div>'
