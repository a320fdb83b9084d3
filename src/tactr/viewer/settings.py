"""What is shown, and how."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    """diameter_scale: of the tubes' diameters; the rest says what is drawn."""

    diameter_scale: float = 1.0
    tendons: bool = True
    disks: bool = True
    loads: bool = True
    rest: bool = True
    trace: bool = True
    frames: bool = False
    grid: bool = True
