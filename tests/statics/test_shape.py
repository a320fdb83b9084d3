"""What a shape offers once it converged."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import Robot, RobotError, Rod, Straight, Tendon, Tube
from tactr.materials import nitinol
from tactr.statics import Shape, Status


def test_a_converged_shape_says_so(shape: Shape) -> None:
    assert shape.converged and shape.status is Status.CONVERGED
    assert shape.message.startswith("converged")
    assert 0.0 <= shape.residual <= shape.residual_tolerance
    assert 0.0 <= shape.discretisation_error <= shape.tolerance == 1e-6
    assert shape.iterations > 0 and shape.solve_time > 0.0


def test_repr_names_the_robot_and_its_tip(shape: Shape) -> None:
    x, y, z = shape.tip_position * 1e3
    assert repr(shape).startswith(f"<Shape of pair: tip ({x:.3f}, {y:.3f}, {z:.3f}) mm")
    assert repr(shape.tubes[1]) == "<TubeShape 'inner': 86 stations>" or "inner" in repr(shape.tubes[1])
    assert repr(shape.tendons[0]).startswith("<TendonShape 'a': length ")


def test_no_array_holds_a_nan(shape: Shape) -> None:
    jacobian = shape.tip_jacobian()
    arrays = [shape.s, shape.centreline, shape.theta, *shape.transition_points, *jacobian]
    arrays += [shape.tip_position, shape.tip_quaternion, shape.tip_orientation]
    for tube in shape.tubes:
        arrays += [tube.s, tube.sigma, tube.position, tube.frames, tube.psi, tube.u, tube.v, tube.n, tube.m]
    for tendon in shape.tendons:
        arrays += [tendon.s, tendon.path, tendon.tension, np.array(tendon.length)]
    assert all(np.isfinite(array).all() for array in arrays)


def test_sizes_follow_the_stations(shape: Shape) -> None:
    k = len(shape.s)
    assert k == 101 and shape.centreline.shape == (k, 3) and shape.theta.shape == (2, k)
    for tube in shape.tubes:
        here = len(tube.s)
        assert (
            tube.position.shape == tube.u.shape == tube.v.shape == tube.n.shape == tube.m.shape == (here, 3)
        )
        assert tube.frames.shape == (here, 3, 3) and tube.psi.shape == tube.sigma.shape == (here,)


def test_tubes_are_listed_where_they_are(robot: Robot, shape: Shape) -> None:
    for tube, found in zip(robot.tubes, shape.tubes, strict=True):
        assert found.name == tube.name
        assert found.s[0] == 0.0 and found.s[-1] <= tube.tip + 1e-12
        np.testing.assert_allclose(found.sigma, found.s - tube.translation, rtol=0.0, atol=1e-15)
        np.testing.assert_array_equal(found.position, shape.centreline[: len(found.s)])


def test_frames_are_rotations_and_agree_with_the_tip(shape: Shape) -> None:
    for tube in shape.tubes:
        identity = np.einsum("kab,kac->kbc", tube.frames, tube.frames)
        np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), rtol=0.0, atol=1e-12)
        assert (np.linalg.det(tube.frames) > 0.0).all()
    np.testing.assert_allclose(shape.tubes[1].frames[-1], shape.tip_orientation, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(shape.centreline[-1], shape.tip_position, rtol=0.0, atol=1e-12)
    assert np.linalg.norm(shape.tip_quaternion) == pytest.approx(1.0, abs=1e-12)


def test_the_robot_leaves_the_guide_along_z(shape: Shape) -> None:
    np.testing.assert_array_equal(shape.centreline[0], 0.0)
    np.testing.assert_allclose(shape.tubes[0].frames[0][:, 2], (0.0, 0.0, 1.0), rtol=0.0, atol=1e-6)


def test_theta_is_relative_to_the_outermost_tube_present(shape: Shape) -> None:
    both = len(shape.tubes[0].s)
    np.testing.assert_array_equal(shape.theta[0], 0.0)
    relative = shape.tubes[1].psi[:both] - shape.tubes[0].psi
    np.testing.assert_allclose(shape.theta[1, :both], relative, rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(shape.theta[1, both:], 0.0)


def test_transition_points(shape: Shape) -> None:
    points, s = shape.transition_points
    np.testing.assert_allclose(s, [0.1], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(points, shape.sample([0.1]).centreline, rtol=0.0, atol=1e-15)


def test_one_tube_has_no_transition_point() -> None:
    points, s = tactr.solve(
        Robot([Tube("rod", length=0.1, section=Rod(0.001), material=nitinol)])
    ).transition_points
    assert points.shape == (0, 3) and s.shape == (0,)


def test_sample_is_the_same_shape_at_other_stations(shape: Shape) -> None:
    other = shape.sample(shape.s[::10])
    np.testing.assert_allclose(other.centreline, shape.centreline[::10], rtol=0.0, atol=1e-9)
    np.testing.assert_array_equal(other.tip_position, shape.tip_position)
    assert shape.sample(7).s.shape == (7,)


def test_stations_do_not_change_the_tip(robot: Robot, shape: Shape) -> None:
    np.testing.assert_array_equal(tactr.solve(robot, stations=2).tip_position, shape.tip_position)


@pytest.mark.parametrize(
    "stations",
    [0, 1, -3, True, [], [0.0, 0.2], [0.1, 0.05], [-0.01, 0.1], [math.nan], ["a"], [[0.0, 0.1]], None],
)
def test_wrong_stations(robot: Robot, shape: Shape, stations) -> None:
    for call in (shape.sample, lambda places: tactr.solve(robot, stations=places)):
        with pytest.raises(RobotError) as caught:
            call(stations)
        assert caught.value.field == "stations"


@pytest.mark.parametrize("tolerance", [0.0, -1e-6, math.nan, math.inf, "fine", None])
def test_wrong_tolerance(robot: Robot, tolerance) -> None:
    with pytest.raises(RobotError) as caught:
        tactr.solve(robot, tolerance=tolerance)
    assert caught.value.field == "tolerance"


RADIUS, LENGTH, TENSION = 0.005, 0.15, 1.5


def bent() -> tuple[Shape, float, float]:
    """A rod bent towards +x by one straight tendon: its shape, curvature (1/m) and stretch."""
    rod = Tube("rod", length=LENGTH, section=Rod(0.001), material=nitinol)
    tendons = [
        Tendon("pull", "rod", Straight(RADIUS, 0.0), tension=TENSION),
        Tendon("far", "rod", Straight(-RADIUS, 0.0)),
        Tendon("short", "rod", Straight(RADIUS, 0.0), end=0.1),
        Tendon("beside", "rod", Straight(0.0, RADIUS)),
    ]
    k = rod.stiffness
    shape = tactr.solve(Robot([rod], tendons), tolerance=1e-10)
    return shape, TENSION * RADIUS / k.EI_y, 1.0 - TENSION / k.EA


def test_tendon_lengths_of_an_arc() -> None:
    """Along a fibre at x = r the rod, stretched by e, is e - kappa r times as long as its rest length."""
    shape, curvature, stretch = bent()
    expected = {
        "pull": (stretch - curvature * RADIUS) * LENGTH,
        "far": (stretch + curvature * RADIUS) * LENGTH,
        "short": (stretch - curvature * RADIUS) * 0.1,
        "beside": stretch * LENGTH,
    }
    for tendon in shape.tendons:
        assert tendon.length == pytest.approx(expected[tendon.name], rel=1e-9), tendon.name


def test_tendon_path_is_a_concentric_arc() -> None:
    shape, curvature, stretch = bent()
    pull, _, short, _ = shape.tendons
    centre = np.array([stretch / curvature, 0.0, 0.0])
    distance = np.linalg.norm(pull.path - centre, axis=1)
    np.testing.assert_allclose(distance, stretch / curvature - RADIUS, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(pull.path[0], (RADIUS, 0.0, 0.0), rtol=0.0, atol=1e-9)
    np.testing.assert_array_equal(pull.tension, TENSION)
    assert 0.0985 < short.s[-1] <= 0.1 and len(short.path) == len(short.s)


def test_length_is_that_of_the_path_and_of_the_part_in_the_guide(shape: Shape) -> None:
    """The part in the guide adds its own length. Where the outermost tube ends the path jumps to the next
    tube's frame, which counts for nothing."""
    fine = shape.sample(2001)
    for tendon, inside in zip(fine.tendons, (0.0, 0.03 * math.hypot(1.0, 0.1), 0.03), strict=True):
        pieces = np.linalg.norm(np.diff(tendon.path, axis=0), axis=1)
        outside = pieces[pieces < 1e-3].sum()
        assert tendon.length == pytest.approx(outside + inside, abs=3e-4), tendon.name
