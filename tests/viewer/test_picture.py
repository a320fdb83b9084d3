"""What is drawn lies where the shape is: tubes, tendons, disks, transitions, loads."""

from dataclasses import replace

import numpy as np
import pytest

import tactr
from tactr import DistributedLoad, Gravity, PointLoad, examples
from tactr.viewer.arrows import FORCE_COLOUR, PER_LOAD
from tactr.viewer.camera import FIELD_OF_VIEW, first_look
from tactr.viewer.disks import RIM, disk_places, most_disks, round_step
from tactr.viewer.picture import picture
from tactr.viewer.surface import SIDES, vertex_count
from tactr.viewer.tension_colours import SCALE, SLACK, tension_colours
from tactr.viewer.walls import STATIONS
from tactr.viewer.widths import holds_tendons, radii, unknown_diameters


@pytest.fixture(scope="module")
def shape() -> tactr.Shape:
    return tactr.solve(examples.load("three_tube_a"))


def _last_ring(vertices: np.ndarray) -> np.ndarray:
    return vertices[(STATIONS - 1) * SIDES : STATIONS * SIDES]


def test_walls_end_at_tips_with_the_tubes_diameters(shape):
    drawn = picture(shape, diameter_scale=2.0)
    parts = {(wall.tube, wall.nested): wall.vertices for wall in drawn.walls}
    assert {key for key, vertices in parts.items() if vertices is not None} == {
        (0, True), (1, True), (2, False)
    }  # fmt: skip
    for k, tube in enumerate(shape.robot.tubes):
        vertices = parts[k, k < 2]
        assert vertices is not None and vertices.shape == (vertex_count(STATIONS), 3)
        ring = _last_ring(vertices)
        tip = shape.sample([tube.tip]).centreline[0]
        np.testing.assert_allclose(ring.mean(axis=0), tip, atol=1e-9)
        assert tube.outer_diameter is not None
        np.testing.assert_allclose(np.linalg.norm(ring - tip, axis=1), tube.outer_diameter, rtol=1e-9)


def test_an_outer_tube_beyond_the_inner_ones_is_bare_there():
    robot = examples.load("two_tube_90").with_actuation(translation={"inner": -0.08})
    drawn = picture(tactr.solve(robot))
    ends = {
        (wall.tube, wall.nested): _last_ring(wall.vertices).mean(axis=0)
        for wall in drawn.walls
        if wall.vertices is not None
    }
    fine = tactr.solve(robot).sample([0.1, 0.14])
    np.testing.assert_allclose(ends[0, True], fine.centreline[0], atol=1e-7)
    np.testing.assert_allclose(ends[0, False], fine.centreline[1], atol=1e-7)
    np.testing.assert_allclose(ends[1, False], fine.centreline[0], atol=1e-7)
    assert (1, True) not in ends


def test_tendons_follow_their_paths_with_colours_by_tension():
    shape = tactr.solve(examples.load("two_tube_90"))
    drawn = picture(shape, most_tension=3.0)
    fine = shape.sample(np.unique([0.0, *(tube.tip for tube in shape.robot.tubes)]))
    for thread, tendon in zip(drawn.threads, fine.tendons, strict=True):
        np.testing.assert_allclose(thread.segments[0, 0], tendon.path[0], atol=1e-9)
        np.testing.assert_allclose(thread.segments[-1, 1], tendon.path[-1], atol=1e-9)
        np.testing.assert_array_equal(thread.segments[1:, 0], thread.segments[:-1, 1])
    assert (drawn.threads[0].colours == SCALE[-1]).all()  # 3 N of 3 N
    np.testing.assert_array_equal(tension_colours(np.array([0.0]), 3.0)[0], SLACK)


@pytest.mark.parametrize("tension", [(3.0, 2.0, 0.5), (0.5, 2.0, 3.0), (1.0, 1.0, 1.0)])
def test_of_tendons_in_one_place_the_tightest_is_seen(tension):
    """The three tendons of this robot all run at +y, each to the tip of its tube."""
    shape = tactr.solve(examples.load("three_tube_a"), tension=tension)
    whole = picture(shape).threads
    seen = [thread.segments[[0, -1], [0, 1]] if len(thread.segments) else None for thread in whole]
    tips = [shape.sample([tube.tip]).tendons[2].path[-1] for tube in shape.robot.tubes]
    base = shape.tendons[2].path[0]
    spans = [(base, tips[0]), (tips[0], tips[1]), (tips[1], tips[2])]
    expected = [None, None, (base, tips[2])] if tension[2] == 3.0 else spans
    for ends, span in zip(seen, expected, strict=True):
        assert (ends is None) == (span is None)
        if ends is not None and span is not None:
            np.testing.assert_allclose(ends, span, atol=1e-6)


def test_disks_stand_across_their_host_where_tendons_run_outside(shape):
    places = disk_places(shape.robot)
    drawn = picture(shape).disks
    tips = [tube.tip for tube in shape.robot.tubes]
    assert {host for host, *_ in places} == {0, 1, 2}
    for (host, s, offset), position, size in zip(places, drawn.position, drawn.sizes, strict=True):
        assert ([0.0, *tips][host]) < s <= tips[host]  # guided by the outermost tube present
        assert offset == pytest.approx(6.5e-3)
        np.testing.assert_allclose(position, shape.sample([s]).centreline[0], atol=1e-9)
        assert size[0] == pytest.approx(RIM * 6.5e-3)
    w, x, y, z = drawn.wxyz.T
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1)
    along = [shape.sample([s]).tubes[host].frames[0, :, 2] for host, s, _ in places]
    np.testing.assert_allclose(axis, along, atol=1e-9)
    assert len(places) <= most_disks(shape.robot)


@pytest.mark.parametrize("name", examples.names())
def test_every_example_has_a_picture_and_no_more_disks_than_said(name):
    robot = examples.load(name)
    for host in ("own", "outermost"):
        tendons = tuple(replace(tendon, host=host) for tendon in robot.tendons)
        assert len(disk_places(robot.replace(tendons=tendons))) <= most_disks(robot)
    drawn = picture(tactr.solve(robot), frames=True)
    arrays = [wall.vertices for wall in drawn.walls if wall.vertices is not None]
    arrays += [thread.segments for thread in drawn.threads]
    arrays += [drawn.disks.position, drawn.transitions, drawn.frame_position, drawn.frame_wxyz, drawn.arrows]
    assert all(np.isfinite(array).all() for array in arrays)
    assert len(drawn.transitions) == len({tube.tip for tube in robot.tubes}) - 1


def test_arrows_point_as_loads_push():
    robot = examples.load("two_tube_90").replace(
        loads=(
            PointLoad("inner", force=(0.02, 0.0, 0.0)),
            PointLoad("outer", force=(0.0, -0.01, 0.0), at=0.07),
            PointLoad("inner", force=(0.0, 0.0, 0.005), axes="body"),
        )
    )
    shape = tactr.solve(robot)
    drawn = picture(shape)
    assert drawn.arrows.shape == (3, 2, 3)
    length = np.linalg.norm(drawn.arrows[:, 1] - drawn.arrows[:, 0], axis=1)
    np.testing.assert_allclose(length / length[0], [1.0, 0.5, 0.25], atol=1e-9)
    way = (drawn.arrows[:, 1] - drawn.arrows[:, 0]) / length[:, None]
    np.testing.assert_allclose(way[:2], [[1, 0, 0], [0, -1, 0]], atol=1e-9)
    np.testing.assert_allclose(way[2], shape.tip_orientation[:, 2], atol=1e-9)
    np.testing.assert_allclose(drawn.arrows[0, 1], shape.tip_position, atol=1e-9)
    np.testing.assert_allclose(drawn.arrows[1, 1], shape.sample([0.07]).centreline[0], atol=1e-9)
    assert (drawn.arrow_colours == FORCE_COLOUR).all()


def test_spread_loads_and_weight_have_arrows():
    robot = examples.load("two_tube_90")
    spread = (DistributedLoad(force=(0.1, 0.0, 0.0)), DistributedLoad("inner", moment=(0.0, 0.01, 0.0)))
    assert len(picture(tactr.solve(robot, loads=spread)).arrows) == 2 * PER_LOAD
    rod = examples.load("till_straight")
    assert any(isinstance(load, Gravity) for load in rod.loads)
    assert len(picture(tactr.solve(rod)).arrows) == 1


def test_widths_of_pieces_and_of_tubes_without_a_diameter():
    wide, thin = tactr.Annulus(2e-3, 1e-3), tactr.Annulus(1.5e-3, 1e-3)
    stepped = tactr.Tube("a", length=0.1, section=[(0, wide), (0.04, thin)], material=tactr.materials.nitinol)
    outer, inner = radii(tactr.Robot([stepped]), 0, np.array([0.0, 0.03, 0.05, 0.1]))
    np.testing.assert_allclose(outer, [1e-3, 1e-3, 0.75e-3, 0.75e-3])
    np.testing.assert_allclose(inner, 0.5e-3)
    bare = tactr.Stiffness(EA=1e4, GA=1e4, EI_x=1e-3, EI_y=1e-3, GJ=1e-3)
    robot = tactr.Robot([tactr.Tube(name, length=0.1, section=bare) for name in ("out", "in")])
    assert unknown_diameters(robot) == ("out", "in")
    bores = [radii(robot, k, np.zeros(1)) for k in (0, 1)]
    assert bores[0][1] >= bores[1][0]  # the inner one fits into the outer one


def test_tubes_that_hold_tendons():
    tacter, outside = examples.load("tacter"), examples.load("two_tube_90")
    assert [holds_tendons(tacter, k) for k in (0, 1)] == [True, True]
    assert [holds_tendons(outside, k) for k in (0, 1)] == [False, False]


@pytest.mark.parametrize("length", [0.03, 0.14, 0.25, 0.5, 1.7])
def test_round_steps(length):
    step = round_step(length)
    assert length / 16 <= step < 2.6 * length / 16
    assert f"{step:.0e}"[0] in "125"


def test_the_camera_sees_the_whole_robot(shape):
    position, look_at = first_look(shape.robot, shape.centreline)
    ahead = (look_at - position) / np.linalg.norm(look_at - position)
    seen = shape.centreline - position
    angle = np.arccos(np.einsum("ka,a->k", seen, ahead) / np.linalg.norm(seen, axis=1))
    assert angle.max() < FIELD_OF_VIEW / 2
