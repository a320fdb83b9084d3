"""The cloud of a sweep's tips: which points, in which colours, and what the panel does to it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactr import Range, RobotError, Samples, Study, Sweep, examples, sweep
from tactr.plotting.palette import SCALE, scale_colours
from tactr.viewer import View
from tactr.viewer.cloud import Cloud, coloured
from tactr.viewer.viser_units import PER_METRE, rgb


@pytest.fixture(scope="module")
def swept(tmp_path_factory) -> Sweep:
    study = Study(
        examples.load("two_tube_90"),
        [Range("tendons.outer.tension", 0.0, 4.0), Range("tubes.inner.rotation", -3.0, 3.0)],
        samples=Samples(300),
        outputs=["tip", "jacobian", "stability"],
    )
    return sweep(study, tmp_path_factory.mktemp("cloud") / "x.zarr")


def cloud_of(view: View) -> tuple[Cloud, Any]:
    assert view.cloud is not None
    return view.cloud, view.cloud._node


def test_all_tips_in_their_colours(swept):
    with View(swept) as view:
        cloud, node = cloud_of(view)
        tips = swept.dataset.tip_position.values
        assert node.points == pytest.approx(PER_METRE * tips, abs=1e-5)
        assert cloud._colour.value == "manipulability"
        values = swept.quantity("manipulability")
        assert rgb(SCALE[0]) == tuple(node.colors[values.argmin()])
        assert rgb(SCALE[-1]) == tuple(node.colors[values.argmax()])
        assert 'data-cloud="300"' in cloud._legend.content
        assert "manipulability (mm): 300 stable tips of 300" in cloud._legend.content
        assert view.page.state.robot == swept.robot


def test_what_the_panel_does(swept):
    with View(swept) as view:
        cloud, first = cloud_of(view)
        cloud._colour.value = "z"
        cloud._draw()
        assert "z of the tip (mm)" in cloud._legend.content
        cloud._part.value = "y above 0"
        cloud._draw()
        node = cloud._node
        assert node is not first
        assert 0 < len(node.points) < 300
        assert (node.points[:, 1] >= 0).all()
        cloud._part.value, cloud._number.value = "all", 100
        cloud._draw()
        assert len(cloud._node.points) == 100
        cloud._shown.value = False
        cloud._dress()
        assert not cloud._node.visible


def test_colours_of_values():
    colours, low, high = coloured(np.array([0.0, 1.0, np.nan, *np.linspace(0.2, 0.8, 97)]))
    assert low < 0.3
    assert high > 0.7
    assert tuple(colours[2]) == (150, 150, 150)
    assert tuple(colours[0]) == rgb(SCALE[0])
    assert coloured(np.full(3, np.nan))[0].tolist() == [[150, 150, 150]] * 3
    assert coloured(np.full(3, 2.0))[1:] == (2.0, 2.0)


def test_the_scale_is_viridis():
    import matplotlib

    shares = np.linspace(0.0, 1.0, 9)
    known = (255 * matplotlib.colormaps["viridis"](shares)[:, :3]).round()
    assert np.abs(scale_colours(shares) - known).max() <= 3


def test_nothing_else_is_shown():
    with pytest.raises(RobotError, match="a Robot, a Shape or a Sweep"):
        View("x")  # type: ignore[arg-type]


def test_in_the_browser(swept, browser, pictures):
    with View(swept) as view:
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.goto(view.url)
        page.wait_for_selector('[data-cloud="300"]', timeout=30000)
        page.wait_for_timeout(1000)
        page.screenshot(path=pictures / "cloud.png")
        page.close()
