"""What the page gives out: texts to copy and files to download."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from tactr.errors import TactrError
from tactr.io import dumps
from tactr.viewer.export import csv_text, glb, stl
from tactr.viewer.motion import Recorder, motion_html
from tactr.viewer.readings import columns
from tactr.viewer.state import State, as_python

if TYPE_CHECKING:
    from collections import deque

    from tactr.statics import Shape
    from tactr.viewer.controls import Control
    from tactr.viewer.panel import Panel
    from tactr.viewer.session import Outcome
    from tactr.viewer.settings import Settings

PICTURE_TIMEOUT = 20.0


class Outputs:
    """The part of the page that gives out; every method takes the client that asked."""

    if TYPE_CHECKING:
        state: State
        settings: Settings
        source: str
        outcome: Outcome | None
        panel: Panel
        rows: deque[np.ndarray]
        controls: list[Control]
        recorder: Recorder
        most_tension: float

    def copy_file(self, client: Any) -> None:
        """The robot as it stands, as a robot file."""
        self.panel.show_text("Robot file", dumps(self.state.actuated), client)

    def copy_python(self, client: Any) -> None:
        """A program that solves the robot as it stands."""
        self.panel.show_text("Python", as_python(self.state, self.source), client)

    def save_png(self, client: Any) -> None:
        """What the client sees, without the panel."""
        import imageio.v3 as imageio

        height, width = client.camera.image_height, client.camera.image_width
        image = client.get_render(height, width, transport_format="png", timeout=PICTURE_TIMEOUT)
        if image.shape[-1] == 4:  # paper, not a hole
            share = image[..., 3:] / 255.0
            image = (image[..., :3] * share + 255.0 * (1.0 - share)).round().astype(np.uint8)
        file = io.BytesIO()
        imageio.imwrite(file, image, extension=".png")
        self._send(client, "png", file.getvalue())

    def save_glb(self, client: Any) -> None:
        """The shape shown, as binary glTF."""
        self._send(client, "glb", glb(self._shape()))

    def save_stl(self, client: Any) -> None:
        """The shape shown, as STL."""
        self._send(client, "stl", stl(self._shape()))

    def save_csv(self, client: Any) -> None:
        """The readings of every state so far."""
        text = csv_text(columns(self.state.robot, self.controls), list(self.rows))
        self._send(client, "csv", text.encode())

    def toggle_recording(self, client: Any) -> None:
        """Start to record, or stop and send the page that plays it."""
        if not self.recorder.running:
            self.recorder.start()
            if self.outcome is not None:
                self.recorder.add(self.outcome)
            self.panel.record.label = "Stop, and save the motion (HTML)"
            return
        frames = self.recorder.stop()
        self.panel.record.label = "Record a motion"
        if not frames:
            raise TactrError("nothing was recorded: there was no shape")
        note = client.add_notification("Writing the motion", f"{len(frames)} frames", loading=True)
        try:
            html = motion_html(frames, self.settings, self.most_tension)
        finally:
            note.remove()
        self._send(client, "html", html.encode())

    def _shape(self) -> Shape:
        if self.outcome is None or self.outcome.shape is None:
            raise TactrError("there is no shape to save")
        return self.outcome.shape

    def _send(self, client: Any, ending: str, content: bytes) -> None:
        name = self.state.robot.name or "robot"
        client.send_file_download(f"{name}.{ending}", content, save_immediately=True)
