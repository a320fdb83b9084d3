"""The page without a browser: what handlers do to nodes, and that nothing they are given breaks it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import examples
from tactr.viewer import View
from tactr.viewer.page import Page

FILE = """\
tubes:
  - name: <b>tube</b>
    length: 100 mm
    stiffness: {EA: 1e4 N, GA: 1e4 N, EI_x: 1e-3 N m^2, EI_y: 1e-3 N m^2, GJ: 1e-3 N m^2}
loads:
  - {kind: distributed, force: [0.1 N/m, 0, 0]}
"""


@pytest.fixture(scope="module")
def view() -> Iterator[View]:
    with View(examples.load("two_tube_90")) as running:
        yield running


@pytest.fixture
def page(view) -> Page:
    view.page.load(examples.load("three_tube_a"), 'tactr.examples.load("three_tube_a")')
    return view.page


def _settle(page: Page) -> None:
    assert page.worker.wait(20.0)


def _names(page: Page) -> set[str]:
    return {name for name in page.server.scene._handle_from_node_name if name.startswith("/robot")}


def test_a_robot_takes_the_place_of_the_one_before(page):
    before = _names(page)
    page.load(examples.load("rucker_webster"), 'tactr.examples.load("rucker_webster")')
    after = _names(page)
    assert before.isdisjoint(after)
    assert sum("/tubes/" in name for name in after) == 2
    assert page.panel.example.value == "rucker_webster"
    page.load(examples.load("ctr"), "tactr.load('ctr.yaml')")
    assert page.panel.example.value == "(my own)"


def test_switches_show_and_hide(page):
    scene = page._scene
    assert [node.visible for node in scene._threads] == [True] * 3
    assert scene._disks.visible and scene._ground.visible and not scene._frames.visible
    assert any(node.visible for node in scene._ghosts)
    changed = replace(
        page.settings, tendons=False, disks=False, rest=False, frames=True, grid=False, diameter_scale=4.0
    )
    width = np.ptp(scene._walls[0].vertices[:20, 0])
    page.show_settings(changed)
    _settle(page)
    assert [node.visible for node in scene._threads] == [False] * 3
    assert not scene._disks.visible and not scene._ground.visible and scene._frames.visible
    assert not any(node.visible for node in scene._ghosts)
    assert np.ptp(scene._walls[0].vertices[:20, 0]) == pytest.approx(4.0 * width, rel=1e-5)
    page.show_settings(replace(page.settings, **vars(type(page.settings)())))
    _settle(page)


def test_the_tip_leaves_a_trace(page):
    control = page.controls[0]
    assert not page._scene._trace.visible
    for value in (3.1, 3.2, 3.3):
        page.move(control, value)
        _settle(page)
    assert page._scene._trace.visible
    assert page._scene._trace.points.shape == (3, 2, 3)
    assert page.outcome is not None and page.outcome.shape is not None
    np.testing.assert_allclose(
        page._scene._trace.points[-1, 1], 10 * page.outcome.shape.tip_position, rtol=1e-6
    )
    page.clear_trace(None)
    _settle(page)
    assert not page._scene._trace.visible


def test_hosts_and_loads(page):
    page.choose_host("own (B)")
    _settle(page)
    expected = tactr.solve(page.state.actuated).tip_position
    assert page.outcome is not None and page.outcome.shape is not None
    np.testing.assert_allclose(page.outcome.shape.tip_position, expected, atol=2e-6)
    page.load_upload("beam.yaml", FILE.encode())
    assert page.state.robot.tubes[0].name == "<b>tube</b>"
    assert page._scene._arrows.visible
    assert "&lt;b&gt;tube" in page.panel._about.content
    assert "No diameter is known of" in page.panel._unknown.content
    page.switch_loads(False)
    _settle(page)
    assert not page._scene._arrows.visible
    np.testing.assert_allclose(page.outcome.shape.tip_position, [0, 0, 0.1], atol=1e-9)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.yaml", b"\xff\xfe", "not a text in UTF-8"),
        ("a.yaml", b"tubes: [", "a.yaml:"),
        ("a.yaml", b"x" * 70_000, "larger than 64 KiB"),
        ("../../etc/passwd", b"", "passwd: has the ending"),
        ("", b"", "robot.yaml: is empty"),
    ],
)
def test_files_that_are_none_are_told(page, name, content, words):
    page.load_upload(name, content)
    assert words in page.panel._errors.content
    assert page.panel._errors.visible
    assert page.state.robot.name == "three_tube_a"


def test_a_control_of_the_robot_before_moves_nothing(page):
    old = page.controls[0]
    page.load(examples.load("ctr"), 'tactr.examples.load("ctr")')
    page.move(old, 1.0)
    _settle(page)
    assert page.state.moved == {}


@pytest.mark.parametrize(
    ("origin", "let_in"),
    [
        ("http://127.0.0.1:{}", True),
        ("http://localhost:{}", True),
        ("http://evil.example", False),
        ("http://evil.example:{}", False),
        ("http://127.0.0.1.evil.example:{}", False),
        ("null", False),
    ],
)
def test_pages_of_other_sites_are_kept_out(view, origin, let_in):
    import viser
    from websockets.exceptions import InvalidStatus
    from websockets.sync.client import connect
    from websockets.typing import Origin, Subprotocol

    def joined():
        return connect(
            f"ws://127.0.0.1:{view.port}",
            origin=Origin(origin.format(view.port)),
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        )

    if let_in:
        with joined() as socket:
            assert len(socket.recv(timeout=10.0)) > 0
    else:
        with pytest.raises(InvalidStatus, match="403"):
            joined()


def test_a_robot_without_an_equilibrium_opens():
    robot = examples.load("two_tube_90")
    heavy = robot.replace(loads=(tactr.PointLoad("inner", force=(1e4, 0.0, 0.0)),))
    with View(heavy) as view:
        page = view.page
        assert page.outcome is not None and page.outcome.shape is None
        assert 'data-status="no equilibrium"' in page.panel._status.content
        assert not any(node.visible for node in page._scene._walls)
        page.switch_loads(False)
        _settle(page)
        assert page.outcome.fresh and any(node.visible for node in page._scene._walls)
