"""2,000 slider events in 20 s: memory stays, and the last state is the one shown."""

from __future__ import annotations

import gc
import time
from pathlib import Path

import numpy as np
import pytest

import tactr
from tactr.viewer import View

EVENTS, SECONDS = 2000, 20.0
WARM = 500
SLIDER = "outer (N)"
LARGEST_GROWTH = 20e6  # bytes


def _resident() -> int:
    gc.collect()
    status = Path("/proc/self/status").read_text().split("VmRSS:")[1].split()
    return 1024 * int(status[0])


def _storm(view: View, client, first: int, count: int) -> tuple[float, float]:
    """Events at an even pace, the slider swinging; what was sent last, and the most seconds behind."""
    low, high = client.sliders[SLIDER]
    begin, value, behind = time.perf_counter(), low, 0.0
    for k in range(count):
        due = begin + k * SECONDS / EVENTS
        time.sleep(max(due - time.perf_counter(), 0.0))
        behind = max(behind, time.perf_counter() - due)
        value = low + (high - low) * (0.5 + 0.3 * np.sin(0.05 * (first + k)))
        client.move(SLIDER, float(value))
        client.drain()
    return float(value), behind


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read from /proc")
def test_a_storm_of_events(raw_client):
    robot = tactr.examples.load("three_tube_a")
    with View(robot) as view, raw_client.RawClient(view.port) as client:
        _storm(view, client, 0, WARM)
        before = _resident()
        last, behind = _storm(view, client, WARM, EVENTS)
        time.sleep(0.5)
        assert view.page.worker.wait(5.0)
        growth = _resident() - before
        outcome = view.page.outcome
        assert behind < 5.0
        assert outcome is not None and outcome.fresh and outcome.shape is not None
        expected = tactr.solve(robot, tension={"outer": last})
        np.testing.assert_allclose(outcome.shape.tip_position, expected.tip_position, atol=1e-6)
        assert growth < LARGEST_GROWTH, f"{growth / 1e6:.1f} MB"
        print(f"grew {growth / 1e6:.1f} MB, {len(view.page.rows)} of {WARM + EVENTS} states solved")
