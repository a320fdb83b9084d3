"""The versions on which the bytes of a sweep depend."""

from __future__ import annotations

from functools import cache
from importlib.metadata import version

from tactr import __version__


@cache
def versions() -> str:
    """Of tactr, and of what scrambles and counts samples."""
    return f"tactr {__version__}, numpy {version('numpy')}, scipy {version('scipy')}"
