"""`tactr view` as people run it: it ends with its page, and says so where its port is taken."""

from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

import tactr
from tactr.cli import main
from tactr.viewer import View
from tactr.viewer.server import FIRST_PORT, PortTaken

VIEW = [sys.executable, "-m", "tactr.cli", "view", "two_tube_90", "--headless"]


@pytest.fixture
def running() -> Iterator[tuple[subprocess.Popen, str]]:
    process = subprocess.Popen(VIEW, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        found = re.search(r"http://127\.0\.0\.1:\d+", process.stdout.readline())
        assert found is not None
        yield process, found[0]
    finally:
        process.kill()
        process.wait()
    for pipe in (process.stdout, process.stderr):
        if pipe is not None:
            pipe.close()


@pytest.mark.slow
def test_closing_the_page_ends_it(running, browser):
    process, url = running
    page = browser.new_page(viewport={"width": 480, "height": 320})
    page.goto(url)
    page.wait_for_selector("[data-tip]", timeout=30000)
    page.reload()  # is not the end
    page.wait_for_selector("[data-tip]", timeout=30000)
    assert process.poll() is None
    page.close()
    assert process.wait(timeout=20) == 0
    assert process.stderr.read() == "close the page, or press Ctrl-C here, to end\n"


def test_an_interrupt_ends_it(running):
    process, _ = running
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=20) == 0
    assert "Traceback" not in process.stderr.read()


def test_a_used_port_is_told(capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["view", "--headless", "--port", str(port)]) == 2
        assert f"port {port} is in use: choose another" in capsys.readouterr().err
        with pytest.raises(PortTaken):
            View(tactr.examples.load("two_tube_90"), port=port)
    assert main(["view", "--headless", "--port", "0"]) == 2
    assert main(["view", "no_such_robot", "--headless"]) == 2


def test_two_views_get_ports_of_their_own():
    robot = tactr.examples.load("two_tube_90")
    with View(robot) as one, View(tactr.solve(robot)) as other:
        assert one.port != other.port
        assert min(one.port, other.port) >= FIRST_PORT
        assert one.url in one._repr_html_()
        assert repr(other) == f"<View of two_tube_90 at {other.url}>"


def test_show_returns_a_view_when_not_asked_to_wait():
    view = tactr.show(tactr.solve(tactr.examples.load("two_tube_90")), block=False, browser=False)
    assert view.page.outcome is not None and view.page.outcome.headline == "stable"
    view.close()
    view.close()  # twice is no harm


def test_a_script_that_waits_says_where(monkeypatch, capsys):
    monkeypatch.setattr(View, "wait", lambda self: None)
    view = tactr.show(tactr.examples.load("two_tube_90"), block=True, browser=False)
    assert capsys.readouterr().err == f"open {view.url} in a browser\n"


def test_without_viser_the_extra_is_named(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "viser", None)
    assert main(["view", "--headless"]) == 2
    assert "pip install 'tactr[view]'" in capsys.readouterr().err
