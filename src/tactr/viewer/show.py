"""Show a robot or a shape in the browser, from a script or a notebook."""

from __future__ import annotations

import os
import sys

from tactr.robot import Robot
from tactr.statics import Shape
from tactr.studies import Sweep
from tactr.viewer.view import View


def show(
    shown: Shape | Robot | Sweep, *, block: bool | None = None, port: int | None = None, browser: bool = True
) -> View:
    """Open a page with a shape, or with a robot, in which everything can be moved; a sweep's robot comes with
    the cloud of its tips. (extra: view)

    block: wait until the page is closed; None: in a script, not in a notebook or at a prompt, where the View
    that comes back shows itself and is ended with ``close()``. port: None for the first free one from 8080
    on. browser: open one. Served on 127.0.0.1 only, without any other connection. Raises MissingExtra,
    RobotError, and PortTaken for a port in use.
    """
    interactive = _in_notebook() or hasattr(sys, "ps1")
    view = View(shown, port=port)
    opened = browser and not _in_notebook() and open_browser(view.url)
    if block or (block is None and not interactive):
        if not opened:  # to wait for a page that nobody knows of would be a hang
            print(f"open {view.url} in a browser", file=sys.stderr, flush=True)
        try:
            view.wait()
        finally:
            view.close()
    return view


def open_browser(url: str) -> bool:
    """Open a page where there is a screen to open it on; whether that was tried."""
    screen = sys.platform in ("darwin", "win32") or any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
    if screen:
        import webbrowser

        webbrowser.open(url)
    return bool(screen)


def _in_notebook() -> bool:
    return "ipykernel" in sys.modules
