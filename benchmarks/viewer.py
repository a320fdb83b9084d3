"""Time from a slider's event to the new geometry, over the page's own websocket.

    python benchmarks/viewer.py [--robot three_tube_a] [--count 300]

Starts `tactr view` in a process of its own, connects as a page does, and moves the tension of the first
tendon (without tendons, the rotation of the first tube) up and down: from the moment the event is sent to
that at which the tubes' new vertices are there. Wanted: a median under 20 ms for three tubes with
three tendons. Exit code 1 above.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import time

import numpy as np
from convergence import machine
from viewer_client import RawClient, moves_tubes

WANTED = 20.0  # ms
PAUSE = 0.03  # s between events: a hand moves no faster


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robot", default="three_tube_a")
    parser.add_argument("--count", type=int, default=300)
    options = parser.parse_args()
    command = [sys.executable, "-m", "tactr.cli", "view", options.robot, "--headless"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert server.stdout is not None
        found = re.search(r":(\d+)$", server.stdout.readline().strip())
        assert found is not None
        times = measure(int(found[1]), options.count)
    finally:
        server.terminate()
        server.wait()
    median, late = float(np.median(times)), float(np.percentile(times, 99))
    print(f"{options.robot}, {options.count} events, {machine()}")
    print(f"median {median:.1f} ms, 99 % {late:.1f} ms, least {min(times):.1f} ms; wanted: {WANTED:.0f} ms")
    return 0 if median < WANTED else 1


def measure(port: int, count: int) -> list[float]:
    """Milliseconds from event to geometry."""
    with RawClient(port) as client:
        label = next(label for label in client.sliders if label.endswith(("(N)", "(deg)")))
        low, high = client.sliders[label]
        times = []
        for k in range(count):
            time.sleep(PAUSE)
            client.drain()
            value = low + (high - low) * (0.5 + 0.2 * np.sin(0.2 * (k + 1)))
            sent = client.move(label, float(value))
            times.append(1e3 * (client.receive(moves_tubes) - sent))
        return times


if __name__ == "__main__":
    sys.exit(main())
