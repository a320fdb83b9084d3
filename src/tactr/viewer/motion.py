"""A recorded motion as a page of its own that plays without a server."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

from tactr.viewer.camera import FIELD_OF_VIEW, first_look
from tactr.viewer.picture import picture
from tactr.viewer.scene import Scene
from tactr.viewer.server import make_server, stop_server
from tactr.viewer.session import Outcome
from tactr.viewer.settings import Settings
from tactr.viewer.viser_units import PER_METRE

LEAST_STEP = 0.08
"""Shortest time between frames, s."""

LONGEST = 60.0
"""Of a motion, s: a minute is some 20 MB."""


class Recorder:
    """Outcomes with their times, from ``start`` to ``stop``."""

    def __init__(self) -> None:
        self._frames: list[tuple[float, Outcome]] = []
        self._began: float | None = None

    @property
    def running(self) -> bool:
        """Whether outcomes are being kept."""
        return self._began is not None

    def start(self) -> None:
        """Keep outcomes from now on, and forget those before."""
        self._frames, self._began = [], perf_counter()

    def stop(self) -> list[tuple[float, Outcome]]:
        """The frames kept, (s since the start, outcome); the last one until now."""
        frames, began = self._frames, self._began
        self._frames, self._began = [], None
        if frames and began is not None:
            frames = [*frames, (min(perf_counter() - began, LONGEST), frames[-1][1])]
        return frames

    def add(self, outcome: Outcome) -> None:
        """Keep an outcome, the newest of those that come too fast."""
        if self._began is None or outcome.shape is None:
            return
        time = perf_counter() - self._began
        if time > LONGEST:
            return
        if self._frames and time - self._frames[-1][0] < LEAST_STEP:
            self._frames[-1] = self._frames[-1][0], outcome
        else:
            self._frames.append((time if self._frames else 0.0, outcome))


def motion_html(frames: Sequence[tuple[float, Outcome]], settings: Settings, most_tension: float) -> str:
    """A standalone HTML page that plays frames. It is recorded from a server of its own, without a page."""
    stage = make_server()
    try:
        scene = Scene(stage)
        shape = frames[0][1].shape
        assert shape is not None
        scene.build(shape.robot)
        position, look_at = first_look(shape.robot, shape.centreline)
        camera = stage.initial_camera
        camera.position, camera.look_at, camera.fov = PER_METRE * position, PER_METRE * look_at, FIELD_OF_VIEW
        drawn = _show(scene, frames[0][1], settings, most_tension)
        recording = stage.get_scene_serializer()
        before = 0.0
        for time, outcome in frames[1:]:
            recording.insert_sleep(max(time - before, 0.0))
            before = time
            if outcome is not drawn:
                drawn = _show(scene, outcome, settings, most_tension)
        return recording.as_html()
    finally:
        stop_server(stage)


def _show(scene: Scene, outcome: Outcome, settings: Settings, most_tension: float) -> Outcome:
    assert outcome.shape is not None
    drawn = picture(
        outcome.shape,
        diameter_scale=settings.diameter_scale,
        most_tension=most_tension,
        frames=settings.frames,
    )
    scene.update(drawn, settings)
    if not outcome.fresh:
        scene.grey()
    return outcome
