"""The command `view`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from tactr.cli.inputs import UsageError, read_robot

if TYPE_CHECKING:
    from tactr.robot import Robot
    from tactr.studies import Sweep


def run_view(file: str, *, port: int | None, browser: bool) -> int:
    """Serve the page until it is closed or the command is interrupted. Raises MissingExtra, FileError,
    UsageError, PortTaken."""
    if port is not None and not 1 <= port <= 65535:
        raise UsageError(f"--port: {port} is not a port; expected a number from 1 to 65535")
    shown, source = _shown(file)
    from tactr.viewer import View
    from tactr.viewer.show import open_browser

    try:
        with View(shown, port=port, source=source) as view:
            print(f"{view.page.state.robot.name or file} is at {view.url}", flush=True)
            if browser:
                open_browser(view.url)
            print("close the page, or press Ctrl-C here, to end", file=sys.stderr, flush=True)
            view.wait()
    except KeyboardInterrupt:
        print(file=sys.stderr)
    return 0


def _shown(file: str) -> tuple[Robot | Sweep, str]:
    """A robot, or the results of a sweep, and what loads it in Python."""
    if Path(file).is_dir():
        from tactr.studies import Sweep

        return Sweep(file), f"tactr.Sweep({file!r}).robot"
    robot = read_robot(file)
    from tactr import examples

    built_in = file in examples.names() and not Path(file).exists()
    return robot, f'tactr.examples.load("{file}")' if built_in else f"tactr.load({file!r})"
