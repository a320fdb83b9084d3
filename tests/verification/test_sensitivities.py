"""Exact derivatives against fourth-order differences of solves to rounding."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import (
    Annulus,
    Gravity,
    Helix,
    Material,
    PointLoad,
    RestShape,
    Robot,
    RobotError,
    Rod,
    Shape,
    Straight,
    Tendon,
    Tube,
    VaryingStiffness,
)
from tactr.statics.frames import rotation_matrices
from tactr.statics.parameters import value_of, with_value

NITINOL = Material(E=60e9, G=23e9, density=6450.0)
RELATIVE = 1e-5
TOLERANCE = 1e-11


def tubes(translations: tuple[float, float, float], tips: tuple[float, float, float]) -> list[Tube]:
    """Three precurved tubes, turned against each other."""
    sections = (Annulus(0.0016, 0.0013), Annulus(0.0011, 0.0008), Annulus(0.0007, 0.0004))
    rows = zip(sections, (2.0, 5.0, 8.0), (0.1, 0.7, -0.9), translations, tips, strict=True)
    return [
        Tube(
            f"tube {i}",
            length=tip - b,
            section=section,
            material=NITINOL,
            precurvature=[(0.0, (0.0, 0.0, 0.0)), (0.04 + 0.005 * i - b, (curvature, 1.0, 0.5))],
            rotation=rotation,
            translation=b,
        )
        for i, (section, curvature, rotation, b, tip) in enumerate(rows)
    ]


def own_hosts() -> Robot:
    """At the guide's exit, where only withdrawing is possible."""
    tendons = [
        Tendon("a", "tube 0", Straight(0.006, 0.0), tension=2.0),
        Tendon("b", "tube 1", Helix(0.005, 20.0), tension=1.5, end=0.12),
        Tendon("c", "tube 2", Helix(0.004, -30.0, 1.0), tension=0.5),
    ]
    return Robot(tubes((0.0, 0.0, 0.0), (0.1, 0.15, 0.2)), tendons)


def other_hosts() -> Robot:
    tendons = [
        Tendon("a", "tube 1", Straight(0.006, 0.0), host="outermost", tension=1.0),
        Tendon("b", "tube 2", Helix(0.005, 10.0), host="outermost", tension=1.0),
    ]
    return Robot(tubes((0.0, 0.0, 0.0), (0.1, 0.15, 0.2)), tendons)


def pushed_and_loaded() -> Robot:
    loads = [
        PointLoad("tube 2", force=(0.05, -0.02, 0.03), moment=(1e-3, 0.0, 5e-4)),
        Gravity((0.0, 9.81, 0.0)),
    ]
    tendons = [Tendon("a", "tube 0", Straight(0.0, 0.006), tension=1.0)]
    return Robot(tubes((-0.05, -0.11, -0.2), (0.1, 0.15, 0.2)), tendons, loads)


def inner_withdrawn() -> Robot:
    """The inner tube ends inside the outer ones."""
    return Robot(
        tubes((-0.05, -0.11, -0.2), (0.12, 0.15, 0.07)),
        [Tendon("a", "tube 1", Straight(0.006, 0.0), tension=1.0)],
    )


def smooth_tube() -> Robot:
    taper = VaryingStiffness.function(lambda s: Rod(1.2e-3 - 2e-3 * s), 0.21, material=NITINOL)
    rest = RestShape.helix(0.02, 0.08)
    tube = Tube("taper", length=0.2, section=taper, precurvature=rest, translation=-0.03)
    return Robot([tube], [Tendon("a", "taper", Helix(0.004, 15.0), tension=1.0)])


ROBOTS = [own_hosts, other_hosts, pushed_and_loaded, inner_withdrawn, smooth_tube]


@functools.cache
def solved(build: Callable[[], Robot]) -> Shape:
    shape = tactr.solve(build(), tolerance=TOLERANCE)
    assert shape.converged, shape.message
    return shape


def pose(shape: Shape, s: float | None) -> tuple[np.ndarray, np.ndarray]:
    if s is None:
        return shape.tip_position, shape.tip_orientation
    here = [tube for tube in shape.sample([s]).tubes if len(tube.s)][-1]
    return here.position[0], here.frames[0]


def motion(start: Shape, end: Shape, s: float | None) -> np.ndarray:
    (p0, R0), (p1, R1) = pose(start, s), pose(end, s)
    turn = R1 @ R0.T
    axis = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    sine = float(np.linalg.norm(axis))
    return np.concatenate([p1 - p0, axis if sine < 1e-12 else axis * (np.arcsin(sine) / sine)])


FORWARD = {1: 4.0, 2: -3.0, 3: 4 / 3, 4: -1 / 4}


def differences(
    at: Callable[[float], Shape], step: float, s: float | None = None, *, side: int = 0
) -> np.ndarray:
    """Central, or on one side (-1, 1), where the robot ends on the other or its shape has a corner."""
    if side:
        start = at(0.0)
        moved = [side * w * motion(start, at(side * k * step), s) for k, w in FORWARD.items()]
        return np.sum(moved, axis=0) / step
    near, far = (motion(at(-k * step), at(k * step), s) / (2 * k * step) for k in (1, 2))
    return (4 * near - far) / 3


def same(exact: np.ndarray, expected: np.ndarray, what: str = "") -> None:
    for rows in (slice(0, 3), slice(3, 6)):
        size = max(np.abs(expected[rows]).max(), 1e-6)
        np.testing.assert_allclose(exact[rows], expected[rows], rtol=0.0, atol=RELATIVE * size, err_msg=what)


@pytest.mark.parametrize("place", [None, 0.063])
@pytest.mark.parametrize("build", ROBOTS, ids=lambda build: build.__name__)
def test_every_actuator(build: Callable[[], Robot], place: float | None) -> None:
    shape = solved(build)
    jacobian = shape.tip_jacobian() if place is None else shape.jacobian(place)

    def moved(kind: str, name: str, value: float) -> Callable[[float], Shape]:
        def at(h: float) -> Shape:
            robot = shape.robot.with_actuation(**{kind: {name: value + h}})
            found = tactr.solve(robot, guess=shape, tolerance=TOLERANCE)
            assert found.converged, found.message
            return found

        return at

    for j, tendon in enumerate(shape.robot.tendons):
        assert isinstance(tendon.tension, float)
        expected = differences(moved("tension", tendon.name, tendon.tension), 1e-3, place)
        same(jacobian.tension[:, j], expected)
    for i, tube in enumerate(shape.robot.tubes):
        expected = differences(moved("rotation", tube.name, tube.rotation), 1e-3, place)
        same(jacobian.rotation[:, i], expected)
        side = -1 if tube.translation == 0.0 else 0
        expected = differences(moved("translation", tube.name, tube.translation), 2e-5, place, side=side)
        same(jacobian.translation[:, i], expected)


def numbers(owner: Any, path: str = "") -> Iterator[str]:
    """Paths of all numbers of a robot's description, as a user would write them."""
    if isinstance(owner, float) and np.isfinite(owner):
        yield path[1:]
    elif isinstance(owner, tuple):
        for k, item in enumerate(owner):
            yield from numbers(item, f"{path}.{getattr(item, 'name', k)}")
    elif dataclasses.is_dataclass(owner):
        for field in dataclasses.fields(owner):
            if field.init:
                yield from numbers(getattr(owner, field.name), f"{path}.{field.name}")


NOT_OF_THE_SHAPE = {"compliance", "pretension"}  # of tendons with a tension
NOT_OF_THE_SHAPE |= {
    "friction",
    "play",
    "rotation_play",
    "translation_play",
    "translation_compliance",
}  # of tactr.drive only
AT_AN_END = (".precurvature.0.0", ".parts.0.0", ".end")  # where first pieces start and fitted ones end
STEP_FROM_ZERO = {
    "neutral_axis": 1e-5,
    "inner_diameter": 1e-5,
    "precurvature.v": 1e-4,
    "curvature": 5e-2,
    "force": 1e-3,
    "moment": 1e-4,
    "acceleration": 1e-2,
    "phase": 1e-3,
    "rotation_compliance": 1e-1,
    "rotation": 1e-3,
    "routing": 1e-5,
    "translation": 2e-5,
}  # SI units


def asked(build: Callable[[], Robot]) -> list[str]:
    """All but what cannot move, being at an end, and what changes nothing of the shape."""
    fitted = [
        path for path in numbers(build()) if not (path.endswith(AT_AN_END) and path.startswith("tubes"))
    ]
    return [path for path in fitted if path.split(".")[-1] not in NOT_OF_THE_SHAPE]


def check_number(
    shape: Shape, path: str, column: np.ndarray, step: float, sides: tuple[int, ...] = (0,)
) -> None:
    """Per relative change where the number is not 0. sides: any of them will do."""
    value = value_of(shape.robot, path)

    def at(h: float) -> Shape:
        found = tactr.solve(with_value(shape.robot, path, value + h), guess=shape, tolerance=TOLERANCE)
        assert found.converged, f"{path}: {found.message}"
        return found

    found = [differences(at, step, side=side) for side in sides]
    best = min(found, key=lambda expected: float(np.abs(expected - column).max()))
    scale = abs(value) or 1e3 * step
    same(scale * column, scale * best, path)


def step_of(robot: Robot, path: str) -> float:
    value = value_of(robot, path)
    return 1e-3 * abs(value) if value else next(h for part, h in STEP_FROM_ZERO.items() if part in path)


def side_of(robot: Robot, path: str) -> int:
    """To which a number that may go no further than 0 can go; 0: to both."""
    if value_of(robot, path):
        return 0
    return {"translation": -1, "inner_diameter": 1, "rotation_compliance": 1}.get(path.split(".")[-1], 0)


@pytest.mark.parametrize("build", ROBOTS, ids=lambda build: build.__name__)
def test_every_number_of_the_robot(build: Callable[[], Robot]) -> None:
    """Lengths, moduli, diameters, rest shapes, routings, loads: each against differences of solves."""
    shape = solved(build)
    paths = asked(build)
    for path, column in zip(paths, shape.sensitivity(paths).T, strict=True):
        check_number(shape, path, column, step_of(shape.robot, path), (side_of(shape.robot, path),))


def test_parameters_come_in_the_order_asked_for() -> None:
    shape = solved(own_hosts)
    paths = ["tendons.a.routing.x", "tubes.tube 1.rotation", "tubes.tube 1.length", "tendons.c.tension"]
    places = [0.05, 0.12]
    together = shape.sensitivity(paths, s=places)
    assert together.shape == (2, 6, 4)
    for k, path in enumerate(paths):
        np.testing.assert_allclose(
            together[..., k], shape.sensitivity([path], s=[0.05, 0.12])[..., 0], rtol=1e-9
        )
    np.testing.assert_allclose(together[..., 1], shape.jacobian(places).rotation[..., 1], rtol=1e-9)


@pytest.mark.parametrize(("path", "told"), [
    ("tubes.tube 9.length", "tube 0, tube 1, tube 2"),
    ("tubes.tube 0.colour", "material"),
    ("tubes.tube 0.material", "not a number"),
])  # fmt: skip
def test_a_wrong_path_is_told(path: str, told: str) -> None:
    with pytest.raises(RobotError, match=told):
        solved(own_hosts).sensitivity([path])


def test_compliance_of_a_straight_rod() -> None:
    """Of a cantilever: L^3 / 3EI + L / GA, L^2 / 2EI, L / EI, L / EA, L / GJ."""
    rod = Tube("rod", length=0.2, section=Rod(0.001), material=NITINOL)
    k, L = rod.stiffness, 0.15
    shape = tactr.solve(Robot([rod]), tolerance=1e-12)
    bend, turn, both = L**3 / (3 * k.EI_x) + L / k.GA, L / k.EI_x, L**2 / (2 * k.EI_x)
    expected = np.diag([bend, bend, L / k.EA, turn, turn, L / k.GJ])
    expected[0, 4] = expected[4, 0] = both
    expected[1, 3] = expected[3, 1] = -both
    np.testing.assert_allclose(shape.compliance(L), expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("build", [own_hosts, pushed_and_loaded])
def test_compliance_at_the_tip_against_loads(build: Callable[[], Robot]) -> None:
    shape = solved(build)
    compliance = shape.compliance()
    last = shape.robot.tubes[-1].name
    for row in range(6):

        def at(h: float, row: int = row) -> Shape:
            wrench = h * np.eye(6)[row]
            (fx, fy, fz), (mx, my, mz) = wrench[:3], wrench[3:]
            extra = PointLoad(last, force=(fx, fy, fz), moment=(mx, my, mz))
            loaded = shape.robot.replace(loads=(*shape.robot.loads, extra))
            return tactr.solve(loaded, tolerance=TOLERANCE)

        same(compliance[:, row], differences(at, 1e-3 if row < 3 else 1e-4))


def test_body_axes_are_those_of_the_innermost_tube() -> None:
    shape = solved(pushed_and_loaded)
    R = rotation_matrices(shape.tip_quaternion)
    block = np.kron(np.eye(2), R)
    world, body = shape.tip_jacobian(), shape.tip_jacobian(axes="body")
    np.testing.assert_allclose(block @ body.rotation, world.rotation, atol=1e-12)
    np.testing.assert_allclose(
        block @ shape.compliance(axes="body") @ block.T, shape.compliance(), atol=1e-12
    )
    inside = [tube for tube in shape.sample([0.063]).tubes if len(tube.s)][-1]
    block = np.kron(np.eye(2), inside.frames[0])
    np.testing.assert_allclose(
        block @ shape.jacobian(0.063, axes="body").tension, shape.jacobian(0.063).tension, atol=1e-12
    )


def test_nothing_moves_at_the_exit_and_no_place_is_off_the_robot() -> None:
    shape = solved(own_hosts)
    assert not np.any(shape.jacobian(0.0).tension) and not np.any(shape.compliance(0.0))
    with pytest.raises(RobotError, match="not on the robot"):
        shape.jacobian(0.3)


def test_derivatives_pass_where_tube_ends_pass_each_other() -> None:
    """A tip passes another's: the tip's derivative with respect to a tension goes on without a jump."""
    robot = own_hosts().with_actuation(translation={"tube 2": -0.03})
    reach = robot.tubes[0].tip

    def column(shift: float) -> np.ndarray:
        middle = robot.with_actuation(translation={"tube 1": reach - robot.tubes[1].length + shift})
        return tactr.solve(middle, tolerance=TOLERANCE).tip_jacobian().tension[:, 0]

    near = [np.abs(column(h) - column(-h)).max() for h in (1e-4, 1e-5, 1e-6)]
    size = np.abs(column(1e-6)).max()
    assert near[2] < 2e-4 * size and near[0] > 5 * near[1] > 25 * near[2]


PASSING = [
    ("tube 1", "tube 0"),  # a middle tube drawn back into the outer one
    ("tube 1", "tube 2"),  # and pushed beyond the inner one, so far the tip of the robot
]


def meeting(tube: str, other: str, shift: float) -> Robot:
    """A tube pushed or drawn until its tip is so far beyond another's."""
    robot = pushed_and_loaded()
    mover, reached = robot.tube(tube), robot.tube(other)
    return robot.with_actuation(translation={tube: mover.translation + reached.tip - mover.tip + shift})


@pytest.mark.parametrize("shift", [2e-4, 2e-5, 0.0, -2e-5, -2e-4])
@pytest.mark.parametrize(("tube", "other"), PASSING)
def test_everything_across_tube_ends_that_pass_each_other(tube: str, other: str, shift: float) -> None:
    """Before, where they meet (there on one side) and beyond: actuators and all other numbers."""
    robot = meeting(tube, other, shift)
    shape = tactr.solve(robot, tolerance=TOLERANCE)
    paths = asked(pushed_and_loaded)
    moving = {f"tubes.{name}.{field}" for name in (tube, other) for field in ("translation", "length")}
    for path, column in zip(paths, shape.sensitivity(paths).T, strict=True):
        if path in moving:
            check_number(shape, path, column, 0.4 * abs(shift) or 1e-5, (0,) if shift else (-1, 1))
        else:
            check_number(shape, path, column, step_of(robot, path), (side_of(robot, path),))
