"""A worker that does the newest thing asked of it, and forgets what it did not get to."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class LatestWins(Generic[T]):
    """Calls ``work`` with the newest item submitted, in a thread of its own, one at a time.

    failed: called with whatever ``work`` raises; the worker goes on.
    """

    def __init__(self, work: Callable[[T], None], failed: Callable[[Exception], None]) -> None:
        self._work = work
        self._failed = failed
        self._waiting: list[T] = []
        self._changed = threading.Condition()
        self._closed = self._busy = False
        self._thread = threading.Thread(target=self._run, name="tactr-view", daemon=True)
        self._thread.start()

    def submit(self, item: T) -> None:
        """Ask for this instead of whatever waits."""
        with self._changed:
            self._waiting = [item]
            self._changed.notify_all()

    def newer_within(self, timeout: float) -> bool:
        """Whether something newer waits, or comes within a time in s."""
        with self._changed:
            return self._changed.wait_for(lambda: bool(self._waiting), timeout)

    def wait(self, timeout: float | None = None) -> bool:
        """Until nothing waits and nothing is being done; False where that takes longer."""
        with self._changed:
            return self._changed.wait_for(lambda: not (self._waiting or self._busy), timeout)

    def close(self) -> None:
        """Finish what is being done, and end."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout=5.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._busy = False
                self._changed.notify_all()
                self._changed.wait_for(lambda: self._waiting or self._closed)
                if self._closed:
                    return
                item, self._waiting, self._busy = self._waiting.pop(), [], True
            try:
                self._work(item)
            except Exception as error:  # a page that stops moving without a word is worse than any error
                self._failed(error)
