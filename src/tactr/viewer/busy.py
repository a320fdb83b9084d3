"""Says so when something takes long."""

from __future__ import annotations

import threading
from collections.abc import Callable

LONG = 0.4
"""From when on a person wonders, s."""


class Busy:
    """Context that calls ``say`` where it is not left within ``LONG``, and never after it is left."""

    def __init__(self, say: Callable[[], None]) -> None:
        self._say = say
        self._lock = threading.Lock()
        self._timer: threading.Timer | None = None

    def __enter__(self) -> None:
        self._timer = threading.Timer(LONG, self._late)
        self._timer.daemon = True
        self._timer.start()

    def __exit__(self, *_: object) -> None:
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
            self._timer = None

    def _late(self) -> None:
        with self._lock:
            if self._timer is threading.current_thread():
                self._say()
