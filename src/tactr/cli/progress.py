"""Bars on stderr where that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol


class Show(Protocol):
    """Takes how much is done of how much, and what is being done if that changes."""

    def __call__(self, done: int, count: int, text: str = "") -> None: ...


@contextmanager
def progress_bar(text: str, *, time_left: bool = True) -> Iterator[Show | None]:
    """A bar with the time so far and an estimate of the time left, wiped at the end; None without a
    terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = [TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()]
    if time_left:
        columns += [TextColumn("left:"), TimeRemainingColumn()]
    with Progress(*columns, console=Console(stderr=True), transient=True, speed_estimate_period=300.0) as bar:
        task = bar.add_task(text, total=None)

        def show(done: int, count: int, text: str = "") -> None:
            bar.update(task, completed=done, total=count, description=text or None)

        yield show
