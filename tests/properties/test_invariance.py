"""What must not change the shape, or must change it in a known way, whatever the robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import tactr
from tactr import Annulus, Gravity, Helix, Piecewise, PointLoad, RestShape, Robot, Straight, Tendon, Tube
from tactr.materials import nitinol
from tactr.robot import Routing
from tactr.robot.load import Load
from tactr.statics import Shape

Generator = Callable[[int], Robot]
SEEDS = st.integers(0, 2000)
TOLERANCE = 1e-7
NEAR = 4 * TOLERANCE  # of two solves, each with its own steps


def solved(robot: Robot, *, tolerance: float = TOLERANCE) -> Shape:
    shape = tactr.solve(robot, tolerance=tolerance, stations=5)
    assert shape.converged, f"{robot.name}: {shape.message}"
    return shape


def check_same(one: Robot, other: Robot, *, turn: np.ndarray | None = None) -> None:
    """Both robots have the same centreline and tip frame, the first one's turned by the matrix."""
    a, b = solved(one), solved(other)
    turn = np.eye(3) if turn is None else turn
    np.testing.assert_allclose(b.centreline, a.centreline @ turn.T, rtol=0.0, atol=NEAR)


@given(seed=SEEDS, angle=st.floats(-math.pi, math.pi))
def test_rotating_the_whole_robot_rotates_the_shape(random_robot: Generator, seed: int, angle: float) -> None:
    robot = random_robot(seed)
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    tubes = [replace(tube, rotation=tube.rotation + angle) for tube in robot.tubes]
    turned = robot.replace(tubes=tubes, loads=[transformed(load, turn, turn) for load in robot.loads])
    check_same(robot, turned, turn=turn)


def transformed(load: Load, force: np.ndarray, moment: np.ndarray, *, body: bool = False) -> Load:
    """The load with its force and moment multiplied by the matrices; in body axes only where body is true."""
    if isinstance(load, Gravity):
        x, y, z = force @ load.acceleration
        return Gravity((x, y, z))
    assert isinstance(load, PointLoad)
    if load.axes == "body" and not body:
        return load
    return replace(load, force=tuple(force @ load.force), moment=tuple(moment @ load.moment))


@given(seed=SEEDS)
def test_mirrored_robot_has_the_mirrored_shape(random_robot: Generator, seed: int) -> None:
    """y to -y: curvatures and moments are axial vectors, so that their x and z change sign instead."""
    robot = random_robot(seed)
    mirror, axial = np.diag([1.0, -1.0, 1.0]), np.diag([-1.0, 1.0, -1.0])
    tubes = [
        replace(
            tube,
            rotation=-tube.rotation,
            precurvature=[(start, (-u[0], u[1], -u[2])) for start, u in rest_of(tube)],
        )
        for tube in robot.tubes
    ]
    tendons = [replace(tendon, routing=mirrored(tendon.routing)) for tendon in robot.tendons]
    loads = [transformed(load, mirror, axial, body=True) for load in robot.loads]
    check_same(robot, robot.replace(tubes=tubes, tendons=tendons, loads=loads), turn=mirror)


def mirrored(routing: Routing) -> Routing:
    if isinstance(routing, Helix):
        return Helix(routing.radius, -routing.rate, -routing.phase)
    assert isinstance(routing, Straight)
    return Straight(routing.x, -routing.y)


@given(seed=SEEDS, order=st.randoms(use_true_random=False))
def test_swapping_the_order_of_tendons_changes_nothing(
    random_robot: Generator, seed: int, order: object
) -> None:
    robot = random_robot(seed)
    tendons = list(robot.tendons)
    order.shuffle(tendons)  # pyright: ignore[reportAttributeAccessIssue]
    check_same(robot, robot.replace(tendons=tendons))


@given(seed=SEEDS, where=st.floats(0.01, 0.99))
def test_an_extra_breakpoint_in_tubes_and_routings_changes_nothing(
    random_robot: Generator, seed: int, where: float
) -> None:
    robot = random_robot(seed)
    tubes = [replace(tube, precurvature=split_rest(tube, where)) for tube in robot.tubes]
    tendons = [
        replace(t, routing=Piecewise([(0.0, t.routing), (where * end_of(robot, t), t.routing)]))
        for t in robot.tendons
    ]
    check_same(robot, robot.replace(tubes=tubes, tendons=tendons))


def rest_of(tube: Tube) -> list[tuple[float, tuple[float, float, float]]]:
    assert not isinstance(tube.precurvature, RestShape)
    return list(tube.precurvature)


def split_rest(tube: Tube, where: float) -> list[tuple[float, tuple[float, float, float]]]:
    pieces = rest_of(tube)
    start, u = pieces[-1]
    return [*pieces, (start + where * (tube.length - start), u)]


def end_of(robot: Robot, tendon: Tendon) -> float:
    return robot.tube(tendon.tube).length if tendon.end is None else tendon.end


@given(seed=SEEDS, where=st.floats(0.01, 1.0), axes=st.sampled_from(["world", "body"]))
def test_a_load_of_nothing_anywhere_changes_nothing(
    random_robot: Generator, seed: int, where: float, axes: str
) -> None:
    robot = random_robot(seed)
    tube = robot.tubes[-1]
    nothing = PointLoad(tube.name, at=where * tube.length, axes=axes)  # pyright: ignore[reportArgumentType]
    check_same(robot, robot.replace(loads=[*robot.loads, nothing]))


@given(seed=SEEDS)
def test_a_tendon_cut_in_two_of_half_the_tension_changes_nothing(random_robot: Generator, seed: int) -> None:
    robot = random_robot(seed)
    halves = [
        replace(tendon, name=f"{tendon.name} {half}", tension=0.5 * newtons(tendon))
        for tendon in robot.tendons
        for half in "ab"
    ]
    check_same(robot, robot.replace(tendons=halves))


def newtons(tendon: Tendon) -> float:
    assert isinstance(tendon.tension, float)
    return tendon.tension


def test_tendons_that_end_together_inside_another_tube_end_in_any_order() -> None:
    """Led by the outer tube's disks, fixed to the inner tube: the pulls of both ends depend on each other."""
    tubes = [
        Tube("outer", length=0.14, section=Annulus(0.0014, 0.0011), material=nitinol, precurvature=(3, 0, 0)),
        Tube("inner", length=0.2, section=Annulus(0.001, 0.0006), material=nitinol, rotation=0.7),
    ]
    tendons = [
        Tendon(name, "inner", routing, host="outermost", tension=10.0, end=0.08)
        for name, routing in (("one", Helix(0.004, 60.0, 0.3)), ("other", Helix(0.006, -40.0, 2.0)))
    ]
    check_same(Robot(tubes, tendons), Robot(tubes, tendons[::-1]))
