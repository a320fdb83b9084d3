"""Pictures of shapes: what is in them, for every kind of robot, and how they are saved and shown."""

from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import tactr
from tactr import examples
from tactr.plotting import TUBE_COLOURS, plot_shape, tube_colour
from tactr.plotting.curves import drawing


def views(figure: Figure) -> list[Any]:
    """The 3D view and the two projections."""
    return figure.axes


@pytest.mark.parametrize("name", examples.names())
def test_every_example_can_be_drawn(name):
    figure = tactr.solve(examples.load(name)).plot()
    assert isinstance(figure, Figure)
    space, xz, yz = views(figure)
    assert (space.get_xlabel(), space.get_ylabel(), space.get_zlabel()) == ("x (mm)", "y (mm)", "z (mm)")
    assert (xz.get_xlabel(), xz.get_ylabel(), yz.get_xlabel()) == ("x (mm)", "z (mm)", "y (mm)")


def test_what_is_drawn():
    shape = tactr.solve(examples.load("three_tube_c"))
    content = drawing(shape)
    assert [curve.label for curve in content.tubes] == ["outer", "middle", "inner"]
    assert [curve.label for curve in content.tendons] == [
        "tendon outer, 3 N",
        "tendon middle, 2 N",
        "tendon inner, 0.5 N",
    ]
    assert len({curve.colour for curve in content.tubes}) == 3
    assert [curve.width for curve in content.tubes] == sorted((c.width for c in content.tubes), reverse=True)
    # lines end where the tubes and the tendons do
    assert content.tubes[0].points[-1] == pytest.approx(content.marks[0])
    assert content.tubes[2].points[-1] == pytest.approx(1e3 * shape.tip_position)
    assert content.marks == pytest.approx(1e3 * shape.transition_points[0])
    offsets = np.linalg.norm(content.ends - np.vstack([content.marks, content.tip]), axis=1)
    assert offsets == pytest.approx([6.5, 6.5, 6.5])


def test_scales_are_equal_and_flat_shapes_have_room():
    figure = tactr.solve(examples.load("two_tube_0")).plot()
    space, xz, yz = views(figure)
    for axes in (xz, yz):
        assert axes.get_aspect() == 1
    width = np.ptp(xz.get_xlim())
    assert width == pytest.approx(np.ptp(yz.get_xlim()))
    assert width > 0.4 * np.ptp(xz.get_ylim())
    extent = [np.ptp(limits) for limits in (space.get_xlim(), space.get_ylim(), space.get_zlim())]
    assert space._box_aspect / space._box_aspect[0] == pytest.approx(np.array(extent) / extent[0])


def test_everything_lies_within_the_limits():
    shape = tactr.solve(examples.load("rucker_webster"))
    points = drawing(shape).points
    _, xz, yz = views(shape.plot())
    for axes, k in ((xz, 0), (yz, 1)):
        for values, (low, high) in ((points[:, k], axes.get_xlim()), (points[:, 2], axes.get_ylim())):
            assert low < values.min()
            assert values.max() < high


def test_names_and_legend():
    figure = tactr.solve(examples.load("two_tube_90")).plot()
    assert figure.get_suptitle() == "two_tube_90"
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["outer", "inner", "tendon outer, 3 N", "tendon inner, 2 N", "transition point", "guide"]
    assert figure.texts[-1].get_text().startswith("tip (")


def test_many_tendons_share_an_entry():
    labels = [curve.label for curve in drawing(tactr.solve(examples.load("tdcr_two_segment"))).tendons]
    assert labels == ["tendons", "", "", "", "", ""]


def test_a_robot_that_hardly_leaves_the_guide_and_one_without_tendons():
    robot = examples.load("three_tube_ctr")
    shape = tactr.solve(robot, translation=[-0.198, -0.33, -0.4629])
    assert shape.converged
    plot_shape(shape)


@pytest.mark.parametrize("ending", [".png", ".pdf", ".svg"])
def test_saving(ending, tmp_path):
    path = tmp_path / f"shape{ending}"
    tactr.solve(examples.load("two_tube_90")).plot(path)
    assert path.stat().st_size > 10_000


def test_where_it_cannot_be_written(tmp_path):
    shape = tactr.solve(examples.load("two_tube_90"))
    with pytest.raises(tactr.FileError, match="cannot be written"):
        shape.plot(tmp_path / "missing" / "shape.png")
    with pytest.raises(tactr.FileError, match="cannot be written"):
        shape.plot(tmp_path / "shape.xyz")


def test_notebooks_show_it_and_pyplot_knows_nothing_of_it():
    from matplotlib import _pylab_helpers

    figure: Any = tactr.solve(examples.load("two_tube_90")).plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    assert _pylab_helpers.Gcf.get_all_fig_managers() == []


def test_no_shape_no_picture():
    shape = tactr.solve(examples.load("till_straight"), tension={"tendon": 1e9})
    with pytest.raises(tactr.NotConverged):
        shape.plot()


def test_without_the_extra(monkeypatch):
    shape = tactr.solve(examples.load("two_tube_90"))
    monkeypatch.setitem(__import__("sys").modules, "matplotlib.figure", None)
    with pytest.raises(tactr.MissingExtra, match=r"pip install 'tactr\[plot\]'"):
        shape.plot()


def test_colours():
    assert len(set(TUBE_COLOURS)) == 8
    assert tube_colour(0) == "#0072B2"
