"""A page that runs: start it, wait for it, end it."""

from __future__ import annotations

import atexit
import threading
from types import TracebackType

from tactr.errors import RobotError
from tactr.robot import Robot
from tactr.statics import Shape
from tactr.studies import Sweep
from tactr.viewer.cloud import Cloud
from tactr.viewer.page import Page
from tactr.viewer.server import HOST, make_server, stop_server

GRACE = 4.0
"""How long (s) a page may be away: a reload takes a second."""


class View:
    """A page with a robot, served on the loopback address until it is closed.

    Of a sweep the robot amid the cloud of its tips. url: where it is. In a notebook it shows itself. Also a
    context manager.
    """

    def __init__(self, shown: Robot | Shape | Sweep, *, port: int | None = None, source: str = "") -> None:
        if not isinstance(shown, Robot | Shape | Sweep):
            expected = "a Robot, a Shape or a Sweep"
            raise RobotError("shown", f"{shown!r} is neither", expected, value=shown)
        robot = shown if isinstance(shown, Robot) else shown.robot
        shape = shown if isinstance(shown, Shape) else None
        self._server = make_server(port)
        self.port: int = self._server.get_port()
        self.url = f"http://{HOST}:{self.port}"
        self._gone, self._closed = threading.Event(), False
        self._leaving: threading.Timer | None = None
        try:
            self.page = Page(self._server, robot, source or "...  # your robot", shape)
            self.cloud = Cloud(self._server, shown) if isinstance(shown, Sweep) else None
        except BaseException:
            stop_server(self._server)
            raise
        atexit.register(self.close)
        self._server.on_client_connect(lambda _: self._arrive())
        self._server.on_client_disconnect(lambda _: self._leave())

    def wait(self) -> None:
        """Until every page that was opened is closed."""
        while not self._gone.wait(0.2):  # in bits: a wait without end cannot be interrupted everywhere
            pass

    def close(self) -> None:
        """End the page and its server."""
        if self._closed:
            return
        self._closed = True
        atexit.unregister(self.close)
        self._gone.set()
        if self._leaving is not None:
            self._leaving.cancel()
        self.page.worker.close()
        stop_server(self._server)

    def _arrive(self) -> None:
        if self._leaving is not None:
            self._leaving.cancel()

    def _leave(self) -> None:
        if not self._server.get_clients():
            self._leaving = threading.Timer(GRACE, self._gone.set)
            self._leaving.daemon = True
            self._leaving.start()

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<View of {self.page.state.robot.name or 'robot'} at {self.url}>"

    def _repr_html_(self) -> str:
        return f'<iframe src="{self.url}" width="100%" height="640" style="border:0"></iframe>'
