"""The page: what the user does becomes a state, the newest state is solved and shown."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np

from tactr import examples
from tactr.errors import TactrError
from tactr.io.csv_table import decoded
from tactr.robot import Robot
from tactr.statics import Shape
from tactr.viewer.busy import Busy
from tactr.viewer.camera import FIELD_OF_VIEW, first_look
from tactr.viewer.controls import Control, controls, most_tension
from tactr.viewer.disks import Places, disk_places
from tactr.viewer.latest import LatestWins
from tactr.viewer.measured import misfit, read_points
from tactr.viewer.motion import Recorder
from tactr.viewer.outputs import Outputs
from tactr.viewer.panel import OWN_ROBOT, Panel
from tactr.viewer.picture import picture
from tactr.viewer.readings import row
from tactr.viewer.scene import Scene
from tactr.viewer.session import Outcome, Session
from tactr.viewer.settings import Settings
from tactr.viewer.state import HostChoice, State
from tactr.viewer.status_html import busy_html, status_html
from tactr.viewer.viser_units import PER_METRE
from tactr.viewer.walls import wall_stations, walls

TRACE_LENGTH, LEAST_TRACE_STEP = 600, 5e-5
MOST_ROWS = 10_000
SLOW_PERIOD, PAUSE = 0.1, 0.008  # s between curves while states keep coming; s before them


class Page(Outputs):
    """A robot on a viser server. Handlers of the panel set ``state`` and ``settings``; a worker shows them.

    source: what loads the robot in Python, for "copy as Python".
    """

    def __init__(self, server: Any, robot: Robot, source: str, shape: Shape | None = None) -> None:
        self.server = server
        self.settings = Settings()
        self.outcome: Outcome | None = None
        self._session, self._scene, self.recorder = Session(), Scene(server), Recorder()
        self._trace: deque[np.ndarray] = deque(maxlen=TRACE_LENGTH)
        self.rows: deque[np.ndarray] = deque(maxlen=MOST_ROWS)
        self._began, self._curves_at = perf_counter(), 0.0
        self._points: np.ndarray | None = None
        self._rest: Shape | None = None
        self._disks: tuple[Any, Places] | None = None
        self._showing = threading.RLock()
        self._busy = Busy(lambda: self.panel.status(busy_html()))
        self.worker: LatestWins[tuple[State, Settings]] = LatestWins(self._work, self._failed)
        self.panel = Panel(server, self, examples.names())
        self.load(robot, source, shape)
        server.on_client_connect(lambda client: self._aim(client))

    def load(self, robot: Robot, source: str, shape: Shape | None = None) -> None:
        """Show another robot; shape: a solution of it to start from."""
        with self._showing:
            self.state, self.source = State(robot), source
            self.controls, self.most_tension = controls(robot), most_tension(robot)
            self._session.start(shape)
            self._trace.clear()
            self.rows.clear()
            self.recorder.stop()
            self._rest = self.outcome = self._disks = None
            with self.server.atomic():
                self._scene.build(robot)
                self.panel.build(robot, self.controls, self.most_tension)
                self.panel.record.label = "Record a motion"
                self.panel.example.value = _example_of(source)
                self._work((self.state, self.settings))
        self.look(None)

    # What the user does.

    def move(self, control: Control, value: float) -> None:
        """A slider was moved to a value in the control's unit."""
        if control in self.controls:
            self.state = self.state.with_value(control.key, value / control.factor)
            self.redraw()

    def choose_host(self, host: HostChoice) -> None:
        """Who guides the tendons."""
        self.state = replace(self.state, host=host)
        self.redraw()

    def switch_loads(self, act: bool) -> None:
        """Whether the robot's own loads act."""
        self.state = replace(self.state, loads=act)
        self.redraw()

    def show_settings(self, settings: Settings) -> None:
        """What is shown, and how."""
        self.settings = settings
        self.redraw()

    def redraw(self) -> None:
        """Ask the worker for the present state."""
        self.worker.submit((self.state, self.settings))

    def reset(self, _: Any) -> None:
        """The robot as it was loaded."""
        self.load(self.state.robot, self.source)

    def clear_trace(self, _: Any) -> None:
        """Forget where the tip was."""
        self._trace.clear()
        self.redraw()

    def choose_example(self, name: str) -> None:
        """Load a built-in example."""
        if name != OWN_ROBOT:
            self.panel.errors([])
            threading.Thread(
                target=self.guarded,
                args=(lambda: self.load(examples.load(name), f'tactr.examples.load("{name}")'),),
                daemon=True,
            ).start()

    def load_upload(self, name: str, content: bytes) -> None:
        """Load a robot file that was sent; what is wrong with it is said as on the command line."""
        from tactr.io import load

        name = Path(name.replace("\\", "/")).name or "robot.yaml"
        with TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_bytes(content)
            try:
                robot = load(path)
            except TactrError as error:
                self.panel.errors(
                    str(error).replace(f"{folder}/", "").replace(f"{folder}\\", "").splitlines()
                )
                return
        self.panel.errors([])
        self.load(robot, f"tactr.load({name!r})")

    def load_points(self, name: str, content: bytes) -> None:
        """Lay measured points over the robot."""
        try:
            name = Path(name).name
            self._points = read_points(decoded(content, name), name)
        except TactrError as error:
            self.panel.errors([str(error)])
            return
        self.panel.errors([])
        self.redraw()

    def clear_points(self, _: Any) -> None:
        """Take measured points away."""
        self._points = None
        self.redraw()

    def look(self, client: Any) -> None:
        """Turn the camera so that the whole robot is seen; client: only there."""
        shape = self.outcome.shape if self.outcome else None
        position, look_at = first_look(self.state.robot, None if shape is None else shape.centreline)
        camera = self.server.initial_camera
        camera.position, camera.look_at, camera.fov = PER_METRE * position, PER_METRE * look_at, FIELD_OF_VIEW
        for one in [client] if client else self.server.get_clients().values():
            self._aim(one)

    def _aim(self, client: Any) -> None:
        camera = self.server.initial_camera
        with client.atomic():
            client.camera.position, client.camera.look_at = camera.position, camera.look_at

    def guarded(self, act: Callable[[], None], client: Any = None) -> None:
        """Does something; what goes wrong is said on the page."""
        try:
            act()
        except Exception as error:
            self._failed(error, client)

    def _failed(self, error: Exception, client: Any = None) -> None:
        expected = isinstance(error, TactrError)
        text = str(error) if expected else f"{type(error).__name__}: {error}"
        for one in [client] if client else list(self.server.get_clients().values()):
            one.add_notification(
                "That did not work", text, color="red", auto_close_seconds=12.0 if expected else None
            )

    # What the worker does.

    def _work(self, asked: tuple[State, Settings]) -> None:
        state, settings = asked
        with self._showing:
            if state.robot is not self.state.robot:
                return  # another one was loaded meanwhile
            with self._busy:
                outcome = self._outcome(state)
            self._show(outcome, settings)
            self.server.flush()
            self._show_slow(outcome, settings)

    def _outcome(self, state: State) -> Outcome:
        if self.outcome is not None and self.outcome.state is state:
            return self.outcome
        outcome = self._session.solve(state)
        self.rows.append(np.array(row(perf_counter() - self._began, outcome, self.controls)))
        if outcome.shape is not None and outcome.fresh:
            tip = outcome.shape.tip_position
            if not self._trace or np.linalg.norm(tip - self._trace[-1]) > LEAST_TRACE_STEP:
                self._trace.append(tip)
        self.recorder.add(outcome)
        self.outcome = outcome
        return outcome

    def _show(self, outcome: Outcome, settings: Settings) -> None:
        shape = outcome.shape
        with self.server.atomic():
            if shape is None:
                self._scene.hide()
            else:
                drawn = picture(
                    shape,
                    diameter_scale=settings.diameter_scale,
                    most_tension=self.most_tension,
                    frames=settings.frames,
                    places=self._disk_places(outcome),
                )
                self._scene.update(drawn, settings)
                self._scene.trace(np.array(self._trace) if settings.trace else None)
                if not outcome.fresh:
                    self._scene.grey()
            self.panel.status(status_html(outcome))

    def _disk_places(self, outcome: Outcome) -> Places | None:
        """Where disks are: known as long as no tube was moved along and no host changed."""
        if not outcome.fresh or outcome.shape is None:
            return None
        key = outcome.state.host, tuple(tube.translation for tube in outcome.shape.robot.tubes)
        if self._disks is None or self._disks[0] != key:
            self._disks = key, disk_places(outcome.shape.robot)
        return self._disks[1]

    def _show_slow(self, outcome: Outcome, settings: Settings) -> None:
        """What may come a little later."""
        # the pause also leaves the interpreter to the thread that sends the geometry
        if self.worker.newer_within(PAUSE) and perf_counter() - self._curves_at < SLOW_PERIOD:
            return
        shape, self._curves_at = outcome.shape, perf_counter()
        with self.server.atomic():
            self._show_rest(outcome.state, settings)
            if shape is not None:
                self.panel.curves(shape)
            self._show_points(shape)
        self.server.flush()

    def _show_rest(self, state: State, settings: Settings) -> None:
        rest = self._session.rest(state) if settings.rest else None
        if rest is not self._rest:
            self._rest = rest
            drawn = None if rest is None else walls(rest.sample(wall_stations(rest.robot)))
            self._scene.rest(drawn)

    def _show_points(self, shape: Shape | None) -> None:
        points = self._points
        if points is None or shape is None:
            self._scene.measured(None if points is None else points, None)
            self.panel.misfit("")
        else:
            found = misfit(points, shape.centreline, shape.tip_position)
            self._scene.measured(points, found.gaps)
            self.panel.misfit(str(found))


def _example_of(source: str) -> str:
    """The name of the example that a program loads, or what stands for robots that are none."""
    name = source.removeprefix('tactr.examples.load("').removesuffix('")')
    return name if name in examples.names() else OWN_ROBOT
