"""The panel beside the scene: what the user sees and moves. It decides nothing: the page does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.plotting.palette import tube_colour
from tactr.robot import Robot
from tactr.statics import Shape
from tactr.viewer.charts import QUANTITIES, curves
from tactr.viewer.controls import Control
from tactr.viewer.settings import Settings
from tactr.viewer.state import HOSTS
from tactr.viewer.status_html import copy_html, errors_html, legend_html, note_html
from tactr.viewer.widths import unknown_diameters

if TYPE_CHECKING:
    from tactr.viewer.page import Page

TITLES = {
    "tension": "Tendons: tension",
    "displacement": "Tendons: displacement",
    "rotation": "Rotation of tubes",
    "insertion": "Insertion: length outside the guide",
    "force": "Force at the tip",
}
SECONDARY = ("force",)
WIDTH = 400
OWN_ROBOT = "(my own)"
BUTTON = (66, 84, 102)

# Arrow keys on a slider would move viser's camera, too: they end at the page's body.
KEYS = (
    '<img src="data:," style="display:none" onerror="if(!window.tactrKeys){window.tactrKeys=1;'
    "document.body.addEventListener('keydown',e=>{if(e.target.closest('[role=slider]'))"
    'e.stopPropagation()})}">'
)


class Panel:
    """Everything in the panel, with handlers that call the page."""

    def __init__(self, server: Any, page: Page, examples: Sequence[str]) -> None:
        self._server, self._page, gui = server, page, server.gui
        gui.set_panel_label("tactr")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(WIDTH)
        gui.add_html(KEYS)
        self.example = gui.add_dropdown("Robot", [OWN_ROBOT, *examples], initial_value=OWN_ROBOT)
        self._about, self._status = gui.add_html(""), gui.add_html("")
        self._errors = gui.add_html("", visible=False)
        tabs = gui.add_tab_group()
        self._moves = tabs.add_tab("Move")
        with tabs.add_tab("Plots"):
            self._add_plots()
        with tabs.add_tab("Show"):
            self._add_settings()
        with tabs.add_tab("Files"):
            self._add_files()
        self._folders: list[Any] = []
        self._on(self.example, page.choose_example)

    def build(self, robot: Robot, controls: Sequence[Control], most_tension: float) -> None:
        """Sliders, switches and curves for a robot."""
        for part in self._folders:
            part.remove()
        self._folders = []
        self._about.content = legend_html(robot, most_tension)
        unknown = unknown_diameters(robot)
        text = f"No diameter is known of {', '.join(unknown)}: drawn as a guess." if unknown else ""
        self._unknown.content = note_html(text)
        with self._moves:
            self._add_controls(controls)
            self._add_switches(robot)
        self._build_chart(robot)

    def _add_controls(self, controls: Sequence[Control]) -> None:
        gui = self._server.gui
        for kind, group in groupby(controls, key=lambda control: control.kind):
            folder = gui.add_folder(TITLES[kind], expand_by_default=kind not in SECONDARY)
            self._folders.append(folder)
            with folder:
                for control in group:
                    slider = gui.add_slider(
                        f"{control.name} ({control.unit})",
                        min=control.low,
                        max=control.high,
                        step=control.step,
                        initial_value=control.shown(control.value),
                    )
                    self._on(slider, lambda value, control=control: self._page.move(control, value))

    def _add_switches(self, robot: Robot) -> None:
        gui = self._server.gui
        if robot.tendons:
            host = gui.add_dropdown(
                "Tendons guided by", list(HOSTS), hint="their own tube, or the outermost tube present"
            )
            self._on(host, self._page.choose_host)
            self._folders.append(host)
        if robot.loads:
            loads = gui.add_checkbox("Loads of the file act", True)
            self._on(loads, self._page.switch_loads)
            self._folders.append(loads)
        self._folders.append(self._button("Reset", self._page.reset))

    def _add_plots(self) -> None:
        gui = self._server.gui
        self._quantity = gui.add_dropdown("Along s", list(QUANTITIES))
        self._on(self._quantity, lambda _: self._page.redraw())
        self._chart: Any = None
        self._chart_place = gui.add_folder(None)

    def _build_chart(self, robot: Robot) -> None:
        if self._chart is not None:
            self._chart.remove()
        lines = [
            {"label": tube.name, "stroke": tube_colour(k), "width": 2 + 2 * (len(robot.tubes) - 1 - k)}
            for k, tube in enumerate(robot.tubes)
        ]
        s = np.array([0.0, 1.0])
        with self._chart_place:
            self._chart = self._server.gui.add_uplot(
                (s, *[0 * s for _ in robot.tubes]),
                ({"label": "s (mm)"}, *lines),
                axes=({"label": "s from the guide (mm)"}, {"size": 60}),
                scales={"x": {"time": False}, "y": {}},
                height=300,
            )

    def _add_settings(self) -> None:
        gui, first = self._server.gui, Settings()
        thickness = gui.add_slider("Thickness ×", min=1.0, max=6.0, step=0.5, initial_value=1.0)
        self._on(thickness, lambda value: self._set(diameter_scale=value))
        self._unknown = gui.add_html("")
        switches = {
            "tendons": "Tendons",
            "disks": "Disks",
            "loads": "Loads",
            "rest": "Rest shape",
            "trace": "Trace of the tip",
            "frames": "Material frames",
            "grid": "Ground and scale",
        }
        for name, label in switches.items():
            box = gui.add_checkbox(label, getattr(first, name))
            self._on(box, lambda value, name=name: self._set(**{name: value}))
        self._button("Clear the trace", self._page.clear_trace)
        self._button("Look at the whole robot", self._page.look)

    def _set(self, **changes: Any) -> None:
        self._page.show_settings(replace(self._page.settings, **changes))

    def _add_files(self) -> None:
        gui, page = self._server.gui, self._page
        with gui.add_folder("In"):
            self._upload("Load a robot file", page.load_upload)
            self._upload("Lay measured points over (CSV)", page.load_points)
            self._misfit = gui.add_html("")
            self._clear_points = self._button("Take the points away", page.clear_points)
            self._clear_points.visible = False
        with gui.add_folder("Out"):
            self._button("Copy as robot file", page.copy_file)
            self._button("Copy as Python", page.copy_python)
            self._button("Picture (PNG)", page.save_png)
            self._button("Robot (GLB)", page.save_glb)
            self._button("Robot (STL)", page.save_stl)
            self._button("Readings so far (CSV)", page.save_csv)
            self.record = self._button("Record a motion", page.toggle_recording)

    def status(self, html: str) -> None:
        """The box with the state and the numbers."""
        self._status.content = html

    def misfit(self, text: str) -> None:
        """What measured points say; empty: there are none."""
        self._misfit.content = note_html(text)
        self._clear_points.visible = bool(text)

    def errors(self, problems: Sequence[str]) -> None:
        """Problems of a file, or none."""
        self._errors.content = errors_html(problems) if problems else ""
        self._errors.visible = bool(problems)

    def curves(self, shape: Shape) -> None:
        """The chart of a shape."""
        self._chart.data = curves(shape, self._quantity.value)

    def show_text(self, title: str, text: str, client: Any) -> None:
        """A window with a text to copy."""
        gui = client.gui
        with gui.add_modal(title) as modal:
            gui.add_html(copy_html(text))
            gui.add_button("Close").on_click(lambda _: modal.close())

    def _on(self, handle: Any, act: Callable[[Any], None]) -> None:
        """Calls act(value) on what a user does, in that order; not on what the page sets."""

        async def changed(event: Any) -> None:
            if event.client_id is not None:
                act(event.target.value)

        handle.on_update(changed)

    def _button(self, label: str, act: Callable[[Any], None]) -> Any:
        """A button that calls act(client) in a thread: what buttons do may take a while."""
        button = self._server.gui.add_button(label, color=BUTTON)
        button.on_click(lambda event: self._page.guarded(lambda: act(event.client), event.client))
        return button

    def _upload(self, label: str, act: Callable[[str, bytes], None]) -> None:
        """A button that takes a file and calls act(name, content)."""
        button = self._server.gui.add_upload_button(label, color=BUTTON, mime_type="*/*")
        button.on_upload(
            lambda event: self._page.guarded(
                lambda: act(event.target.value.name, event.target.value.content), event.client
            )
        )
