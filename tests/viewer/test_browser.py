"""The page in headless Chromium: it loads without a network, moves, says what is wrong, and gives out."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

import tactr
from tactr import examples
from tactr.viewer import View
from tactr.viewer.settings import Settings

from .conftest import SIZE

ROBOT = "two_tube_90"
WEAK = """\
name: weak
tubes:
  - name: tube
    length: 100 mm
    outer_diameter: 1 mm
    inner_diameter: 0.8 mm
    material: nitinol
tendons:
  - name: pull
    tube: tube
    routing: {kind: straight, x: 5 mm, y: 0 mm}
    tension: 1 N
    limits: {tension: [0, 400 N]}
"""
BAD = WEAK.replace("length: 100 mm", "lenght: 100 mm").replace("1 N", "1 mm")
POINTS = "x [mm],y [mm],z [mm]\n0,0,0\n{}\n"


@dataclass
class Opened:
    """A page in the browser, the view behind it, and all that it asked for."""

    page: Any
    view: View
    requests: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    @property
    def tip(self) -> np.ndarray:
        """The tip that the page shows, mm."""
        text = self.page.locator("[data-tip]").get_attribute("data-tip")
        return np.array([float(part) for part in text.split()])

    def says(self, headline: str) -> None:
        """Wait until the page says how the robot is."""
        self.page.wait_for_selector(f'[data-status="{headline}"]', timeout=10000)

    def shows(self, shape: tactr.Shape) -> None:
        """Wait until the page shows the tip of a shape, to a micrometre."""
        self.page.wait_for_function(
            "wanted => (document.querySelector('[data-tip]')?.dataset.tip ?? 'none').split(' ')"
            ".every((value, k) => Math.abs(value - wanted[k]) < 1e-3)",
            arg=(1e3 * shape.tip_position).tolist(),
        )

    def slider(self, label: str) -> Any:
        """The thumb of a slider by its label."""
        row = self.page.get_by_text(label, exact=True).locator("xpath=ancestor::*[.//*[@role='slider']][1]")
        return row.get_by_role("slider").first

    def tab(self, name: str) -> None:
        """Open a tab."""
        self.page.get_by_role("tab", name=name).click()

    def download(self, button: str) -> tuple[str, bytes]:
        """Name and content of what a button sends."""
        with self.page.expect_download(timeout=30000) as waiting:
            self.page.get_by_role("button", name=button).click()
        return waiting.value.suggested_filename, Path(waiting.value.path()).read_bytes()

    def upload(self, button: str, name: str, text: str) -> None:
        """Send a file."""
        with self.page.expect_file_chooser() as waiting:
            self.page.get_by_role("button", name=button).click()
        waiting.value.set_files({"name": name, "mimeType": "text/plain", "buffer": text.encode()})

    def start_over(self, name: str = ROBOT) -> None:
        """An example as it is in its file, and the first tab."""
        self.view.page.load(examples.load(name), f'tactr.examples.load("{name}")')
        self.view.page.panel.errors([])
        self.tab("Move")
        self.shows(tactr.solve(examples.load(name)))


@pytest.fixture(scope="module")
def opened(browser) -> Iterator[Opened]:
    with View(examples.load(ROBOT), source=f'tactr.examples.load("{ROBOT}")') as view:
        context = browser.new_context(viewport=SIZE, accept_downloads=True)
        found = Opened(context.new_page(), view)
        found.page.on("request", lambda request: found.requests.append(request.url))
        found.page.on("websocket", lambda socket: found.requests.append(socket.url))
        found.page.on("pageerror", lambda error: found.errors.append(str(error)))
        found.page.goto(view.url)
        found.page.wait_for_selector("[data-tip]", timeout=30000)
        yield found
        context.close()


def _shot(opened: Opened, path: Path) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(opened.page.screenshot(path=path))).convert("RGB")).astype(int)


def _until_drawn(opened: Opened, path: Path, right: Callable[[np.ndarray], bool]) -> None:
    """Take screenshots until the scene is as wanted: software rendering is late."""
    for _ in range(20):
        if right(_shot(opened, path)[:, 320:870]):
            return
        opened.page.wait_for_timeout(250)
    raise AssertionError(f"not drawn as it should be: look at {path}")


def _green(image: np.ndarray) -> int:
    return _like(image, slice(0, 60), slice(140, 200), slice(90, 150))


def _blue(image: np.ndarray) -> int:
    return _like(image, slice(0, 60), slice(60, 160), slice(120, 220))


def _like(image: np.ndarray, red: slice, green: slice, blue: slice) -> int:
    inside = [
        (image[..., k] >= band.start) & (image[..., k] < band.stop)
        for k, band in enumerate((red, green, blue))
    ]
    return int(np.logical_and.reduce(inside).sum())


def test_it_loads_without_a_request_outside(opened, pictures):
    assert {urlsplit(url).hostname for url in opened.requests if not url.startswith(("blob:", "data:"))} == {
        "127.0.0.1"
    }
    assert opened.errors == []
    opened.shows(tactr.solve(examples.load(ROBOT)))
    _until_drawn(  # the outer tube, the inner one and tendons
        opened,
        pictures / "first.png",
        lambda image: (
            _blue(image) > 100 and _like(image, slice(150, 245), slice(60, 190), slice(0, 150)) > 200
        ),
    )


def test_a_slider_moved_by_keys_moves_the_robot_and_not_the_camera(opened):
    opened.start_over()
    (client,) = opened.view._server.get_clients().values()
    camera = client.camera.position.copy()
    drawn = opened.view.page._scene._walls[0].vertices.copy()
    thumb = opened.slider("outer (N)")
    thumb.focus()
    for _ in range(4):
        thumb.press("ArrowRight")
    opened.shows(tactr.solve(examples.load(ROBOT), tension={"outer": 3.2}))
    moved = opened.view.page._scene._walls[0].vertices
    assert np.abs(moved - drawn).max() > 1e-3
    np.testing.assert_array_equal(client.camera.position, camera)


def test_the_menu_of_examples(opened, pictures):
    opened.start_over()
    opened.page.get_by_role("combobox", name="Robot").or_(
        opened.page.locator("input[value='two_tube_90']")
    ).first.click()
    opened.page.get_by_role("option", name="three_tube_ctr").click()
    opened.page.get_by_text("A published concentric tube robot").wait_for()
    opened.shows(tactr.solve(examples.load("three_tube_ctr")))
    assert opened.view.page.source == 'tactr.examples.load("three_tube_ctr")'
    _until_drawn(opened, pictures / "three_tube_ctr.png", lambda image: _green(image) > 100)  # the third tube
    opened.start_over()
    _until_drawn(  # nothing of the robot before
        opened, pictures / "again.png", lambda image: _green(image) < 10 and _blue(image) > 100
    )


def test_what_cannot_be_solved_is_said_and_the_last_shape_stays_grey(opened, pictures):
    opened.tab("Files")
    opened.upload("Load a robot file", "weak.yaml", WEAK)
    opened.tab("Move")
    opened.page.get_by_text("pull (N)").wait_for()
    good = opened.view.page._scene._walls[1].vertices.copy()
    thumb = opened.slider("pull (N)")
    thumb.focus()
    thumb.press("End")
    opened.says("no equilibrium")
    assert opened.page.get_by_text("The last good shape is shown in grey").is_visible()
    assert opened.page.get_by_text("bends its tubes to a radius").is_visible()
    np.testing.assert_array_equal(opened.view.page._scene._walls[1].vertices, good)
    red, green, blue = opened.view.page._scene._walls[1].color
    assert max(red, green, blue) - min(red, green, blue) < 25
    _until_drawn(opened, pictures / "no_equilibrium.png", lambda image: _blue(image) == 0)
    thumb.press("Home")
    opened.says("stable")
    np.testing.assert_allclose(opened.tip, [0.0, 0.0, 100.0], atol=1e-3)


def test_a_bad_file_is_told_as_on_the_command_line(opened, tmp_path, capsys, pictures):
    from tactr.cli import main

    opened.start_over()
    opened.tab("Files")
    opened.upload("Load a robot file", "bad.yaml", BAD)
    box = opened.page.locator("[data-errors]")
    box.wait_for()
    (tmp_path / "bad.yaml").write_text(BAD)
    assert main(["check", str(tmp_path / "bad.yaml")]) == 2
    told = capsys.readouterr().err.replace(f"{tmp_path}/", "").splitlines()
    assert len(told) == 3
    assert box.locator("div").all_inner_texts() == told
    assert opened.view.page.state.robot.name == ROBOT
    _shot(opened, pictures / "bad_file.png")
    opened.upload("Load a robot file", "../robot.exe", WEAK)
    opened.page.get_by_text("has the ending '.exe'").wait_for()


def test_measured_points(opened, pictures):
    opened.start_over()
    shape = tactr.solve(examples.load(ROBOT))
    x, y, z = 1e3 * shape.tip_position
    opened.tab("Files")
    opened.upload("Lay measured points over (CSV)", "points.csv", POINTS.format(f"{x},{y},{z + 3}"))
    opened.page.get_by_text(re.compile("the last one to the tip 3.00 mm")).wait_for()
    _shot(opened, pictures / "measured.png")
    opened.upload("Lay measured points over (CSV)", "bad.csv", "x,y,z\n1,2,3\n")
    opened.page.get_by_text("bad.csv:1: x: is missing, or has no unit").wait_for()
    opened.page.get_by_role("button", name="Take the points away").click()
    opened.page.get_by_text(re.compile("to the tip 3.00 mm")).wait_for(state="detached")


def test_exports_open(opened):
    import trimesh

    opened.start_over()
    shape = tactr.solve(examples.load(ROBOT))
    opened.tab("Files")
    name, content = opened.download("Robot (GLB)")
    assert name == f"{ROBOT}.glb"
    scene = trimesh.load_scene(io.BytesIO(content), file_type="glb")
    assert set(scene.geometry) == {"tube outer", "tube inner", "tendon outer", "tendon inner"}
    inner = scene.geometry["tube inner"].copy()
    inner.apply_transform(scene.graph.get("tube inner")[0])
    x, y, z = shape.tip_position
    upright = np.array([x, z, -y])
    assert np.linalg.norm(inner.vertices - upright, axis=1).min() < 0.5e-3
    assert scene.extents.max() < 0.25  # metres
    _, content = opened.download("Robot (STL)")
    mesh = trimesh.load_mesh(io.BytesIO(content), file_type="stl")
    assert np.linalg.norm(mesh.vertices - 1e3 * shape.tip_position, axis=1).min() < 0.5  # mm
    _, content = opened.download("Picture (PNG)")
    image = np.asarray(Image.open(io.BytesIO(content)))
    assert image.shape[-1] == 3
    assert image.std() > 3
    _, content = opened.download("Readings so far (CSV)")
    head, *rows = content.decode().splitlines()
    values = dict(zip(head.split(","), map(float, rows[-1].split(",")), strict=True))
    np.testing.assert_allclose([values[f"tip {a} [mm]"] for a in "xyz"], 1e3 * shape.tip_position, atol=1e-4)
    assert values["tension outer [N]"] == 3.0


def test_texts_to_copy(opened):
    opened.start_over()
    thumb = opened.slider("inner (deg)")
    thumb.focus()
    thumb.press("ArrowRight")
    opened.shows(tactr.solve(examples.load(ROBOT), rotation={"inner": np.deg2rad(2.0)}))
    opened.tab("Files")
    opened.page.get_by_role("button", name="Copy as robot file").click()
    text = opened.page.locator("textarea[data-copy]").input_value()
    assert tactr.io.loads(text).tube("inner").rotation == pytest.approx(np.deg2rad(2.0))
    opened.page.get_by_role("button", name="Close").click()
    opened.page.locator("textarea[data-copy]").wait_for(state="detached")
    opened.page.get_by_role("button", name="Copy as Python").click()
    text = opened.page.locator("textarea[data-copy]").input_value()
    names: dict[str, Any] = {}
    exec(text, names)
    np.testing.assert_allclose(1e3 * names["shape"].tip_position, opened.tip, atol=1e-3)
    opened.page.get_by_role("button", name="Close").click()


@pytest.mark.slow
def test_a_recorded_motion_plays_offline(opened, browser, tmp_path, pictures):
    opened.start_over()
    opened.view.page.show_settings(Settings(diameter_scale=4.0))
    opened.tab("Files")
    opened.page.get_by_role("button", name="Record a motion").click()
    stop = "Stop, and save the motion (HTML)"
    opened.page.get_by_role("button", name=stop).wait_for()
    control = opened.view.page.controls[0]
    for tension in np.linspace(3.0, 6.0, 5):
        opened.view.page.move(control, float(tension))
        opened.page.wait_for_timeout(100)
    name, content = opened.download(stop)
    assert name == f"{ROBOT}.html"
    assert len(content) < 8e6
    file = tmp_path / name
    file.write_bytes(content)
    with browser.new_context(viewport={"width": 480, "height": 320}, offline=True) as context:
        page = context.new_page()
        asked: list[str] = []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(file.as_uri())
        page.wait_for_function("Number(document.querySelector('input')?.value) > 0")  # s
        page.keyboard.press("Space")  # pause: a picture of what moves takes software rendering long
        for _ in range(10):
            shot = page.screenshot(path=pictures / "motion.png")
            image = np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
            if _blue(image) > 20:
                break
            page.wait_for_timeout(250)
    assert all(url.startswith(("file:", "blob:", "data:")) for url in asked)
    assert _blue(image) > 20  # the robot
