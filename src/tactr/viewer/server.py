"""A viser server on the loopback address that asks nobody else for anything."""

from __future__ import annotations

import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tactr.errors import MissingExtra, TactrError

HOST = "127.0.0.1"
FIRST_PORT, MOST_PORTS = 8080, 50
OWN_PAGES = re.compile(r"https?://(127\.0\.0\.1|localhost|\[::1\])(:\d+)?")
"""Origins that may talk to the server. A page of another site could otherwise move the robot."""


class PortTaken(TactrError):
    """The port asked for is in use."""


def make_server(port: int | None = None) -> Any:
    """A server; port: that one or none (PortTaken), None: the first free one from 8080 on. Raises
    MissingExtra."""
    try:
        import viser
    except ImportError:
        raise MissingExtra("viser", "view", "the page") from None
    with _quiet(), _only_own_pages():
        server = viser.ViserServer(host=HOST, port=_free_port(port), verbose=False)
    _refuse_sharing(server)
    server.gui.configure_theme(
        control_width="large", show_logo=False, show_share_button=False, brand_color=(0, 114, 178)
    )
    _light(server.scene)
    server.scene.set_up_direction("+z")
    return server


def stop_server(server: Any) -> None:
    """Stop a server without a word."""
    with _quiet():
        server.stop()


def _free_port(port: int | None) -> int:
    if port is not None:
        if not _is_free(port):
            raise PortTaken(
                f"port {port} is in use: choose another, or leave --port away to get the next free one"
            )
        return port
    for candidate in range(FIRST_PORT, FIRST_PORT + MOST_PORTS):
        if _is_free(candidate):
            return candidate
    raise PortTaken(f"ports {FIRST_PORT} to {FIRST_PORT + MOST_PORTS - 1} are all in use: choose one")


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError:
            return False
    return True


def _light(scene: Any) -> None:
    """Even light: viser's environment maps wash colours out, and its own lamps alone leave sides black."""
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=True, cast_shadow=False)
    scene.add_light_ambient("/light/ambient", intensity=2.2)
    scene.add_light_directional("/light/side", intensity=1.2, position=(4.0, -6.0, 2.0))


@contextmanager
def _quiet() -> Iterator[None]:
    """viser draws a table of its addresses, and says when it ends: in a notebook as output of a cell."""
    import rich

    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before


@contextmanager
def _only_own_pages() -> Iterator[None]:
    """Servers started within refuse browsers' requests from other sites; programs, which name no origin, may
    come. viser itself lets in whoever asks, and has no setting for it."""
    from websockets.asyncio import server as sockets

    serve, started = sockets.serve, []

    def guarded(*arguments: Any, **options: Any) -> Any:
        started.append(True)
        return serve(*arguments, **options, origins=[None, OWN_PAGES])

    sockets.serve = guarded  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        sockets.serve = serve  # type: ignore[misc]
    if not started:
        raise TactrError("this version of viser cannot be kept from pages of other sites: use viser 1.1")


def _refuse_sharing(server: Any) -> None:
    """A page may ask viser to open a tunnel to a machine outside; this one stays here."""
    server.request_share_url = lambda verbose=True: None
