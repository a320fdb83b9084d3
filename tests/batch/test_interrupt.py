"""A batch under way can be stopped."""

import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

import tactr


@pytest.mark.skipif(sys.platform == "win32", reason="signals to oneself are another matter there")
def test_an_interrupt_stops_a_batch() -> None:
    robot = tactr.examples.load("two_tube_90")
    pulls = {robot.tendons[0].name: np.linspace(0.0, 5.0, 2_000_000)}
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    start = time.perf_counter()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        tactr.solve_batch(robot, tension=pulls)
    assert time.perf_counter() - start < 20.0
