"""Where a shape is read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tactr.errors import RobotError
from tactr.robot import Robot

Stations = int | Sequence[float] | np.ndarray


def station_places(robot: Robot, stations: Stations) -> np.ndarray:
    """Arc lengths s of the stations, (k,), m: so many, even over the length outside, or as given."""
    length = max(tube.tip for tube in robot.tubes)
    if isinstance(stations, int | np.integer):
        if isinstance(stations, bool) or stations < 2:
            raise RobotError("stations", f"{stations} stations", "at least 2", value=stations)
        return np.linspace(0.0, length, int(stations))
    expected = f"arc lengths in m, ascending, within [0, {length:.6g}]"
    try:
        s = np.array(stations, dtype=float)
    except (TypeError, ValueError):
        raise RobotError("stations", f"{stations!r} are not numbers", expected, value=stations) from None
    if s.ndim != 1 or s.size == 0 or not np.all(np.isfinite(s)):
        raise RobotError("stations", f"{stations!r} is not a list of numbers", expected, value=stations)
    rounding = 1e-12 * length
    if np.any(np.diff(s) < 0) or s[0] < -rounding or s[-1] > length + rounding:
        raise RobotError(
            "stations", f"from {s[0]:.6g} to {s[-1]:.6g} m, or not ascending", expected, value=stations
        )
    return np.clip(s, 0.0, length)
