"""Ends of tubes and tendons, hosts, loads and breakpoints."""

from __future__ import annotations

import numpy as np
import pytest

from tactr import reference
from tactr.robot import (
    Annulus,
    DistributedLoad,
    Gravity,
    Helix,
    Material,
    Piecewise,
    PointLoad,
    Robot,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

NITINOL = Material(E=60e9, nu=0.33, density=6450.0)
WIDE, THIN = Annulus(1.35e-3, 1.07e-3), Annulus(1.0e-3, 0.8e-3)


def pair(outer: float = 0.1, inner: float = 0.16) -> list[Tube]:
    """Return two precurved tubes of these lengths (m), turned against each other."""
    return [
        Tube("outer", length=outer, section=WIDE, material=NITINOL, precurvature=(3.0, 0.0, 0.0)),
        Tube(
            "inner", length=inner, section=THIN, material=NITINOL, precurvature=(5.0, 1.0, 0.0), rotation=1.0
        ),
    ]


def slanted(host: str = "own") -> Tendon:
    """Return a helical tendon to the inner tube's tip."""
    return Tendon("t", "inner", Helix(5e-3, 9.0), host="own" if host == "own" else "outermost", tension=1.0)


def triple(values: np.ndarray) -> tuple[float, float, float]:
    """Return three numbers as the robot description takes them."""
    x, y, z = values
    return float(x), float(y), float(z)


def test_ended_tube_carries_nothing_along_its_axis() -> None:
    robot = Robot(pair(), [slanted()], [DistributedLoad(force=(0.0, 0.2, 0.1))])
    shape = reference.solve(robot, stations=[0.1, 0.16])
    outer, inner = (tube.n[-1, 2] for tube in shape.tubes)
    assert abs(outer) < 1e-8
    assert -1.0 < inner < -0.99
    assert abs(shape.tubes[0].m[-1, 2]) < 1e-9


def test_outermost_host_bears_the_kink_where_it_ends() -> None:
    """The ended host holds lambda (t+ - t-) of the tendon that goes on to the inner tube."""
    robot = Robot(pair(), [slanted("outermost")], [PointLoad("inner", force=(0.1, 0.05, 0.0))])
    end = 0.1
    shape = reference.solve(robot, stations=[end, np.nextafter(end, 1.0) + 1e-9])
    (r,), (dr,) = Helix(5e-3, 9.0).evaluate(np.array([end]))
    r, dr = np.append(r, 0.0), np.append(dr, 0.0)
    before, after = (tube.u[k] for tube, k in ((shape.tubes[0], -1), (shape.tubes[1], -1)))
    v_before, v_after = shape.tubes[0].v[-1], shape.tubes[1].v[-1]
    t = [
        q / np.linalg.norm(q)
        for q in (np.cross(before, r) + dr + v_before, np.cross(after, r) + dr + v_after)
    ]
    assert shape.tubes[0].n[-1, 2] == pytest.approx(t[1][2] - t[0][2], abs=1e-9)
    assert abs(shape.tubes[0].n[-1, 2]) > 1e-6


def test_tendon_guided_by_the_outer_tube_pulls_on_the_inner_one_that_it_ends_on() -> None:
    robot = Robot(pair(0.16, 0.1), [Tendon("t", "inner", Straight(0.0, 4e-3), host="outermost", tension=1.0)])
    shape = reference.solve(robot, stations=[0.1])
    outer, inner = (tube.n[0, 2] for tube in shape.tubes)
    assert inner == pytest.approx(-1.0, abs=1e-3)
    assert abs(outer) < 1e-3


def test_inner_tube_withdrawn_into_the_outer_one() -> None:
    robot = Robot(pair(0.16, 0.1), [Tendon("t", "inner", Straight(0.0, 4e-3), tension=1.0)])
    shape = reference.solve(robot, stations=33)
    assert len(shape.tubes[1].s) == np.count_nonzero(shape.s <= 0.1)
    assert shape.frames.shape == (33, 3, 3)
    beyond = shape.tubes[0].s > 0.1
    assert shape.tubes[0].u[beyond, 0] == pytest.approx(3.0, abs=1e-9)


def test_tubes_that_end_together() -> None:
    robot = Robot(pair(0.12, 0.12), [slanted()])
    together = reference.solve(robot)
    almost = reference.solve(Robot(pair(0.12, 0.12 + 1e-9), [slanted()]))
    assert together.tip == pytest.approx(almost.tip, abs=5e-9)


def test_breakpoints_without_a_jump_change_nothing() -> None:
    tubes = pair()
    plain = Robot(tubes, [slanted()])
    cut = Robot(
        [
            Tube(
                "outer",
                length=0.1,
                section=WIDE,
                material=NITINOL,
                precurvature=[(0.0, (3, 0, 0)), (0.03, (3, 0, 0))],
            ),
            tubes[1],
        ],
        [
            Tendon(
                "t",
                "inner",
                Piecewise([(0.0, Helix(5e-3, 9.0)), (0.071, Helix(5e-3, 9.0))]),
                tension=TensionProfile((0.0, 0.05, 0.16), (1.0, 1.0, 1.0)),
            )
        ],
    )
    a, b = reference.solve(plain, stations=7), reference.solve(cut, stations=7)
    assert a.centreline == pytest.approx(b.centreline, abs=1e-10)


def test_kinked_routing_and_stepped_precurvature_are_limits_of_smooth_ones() -> None:
    """A kink of the routing taken in one step or in two half as large, close together."""

    def robot(kinks: list[tuple[float, Straight | Helix]]) -> Robot:
        return Robot(
            [pair()[1]],
            [Tendon("t", "inner", Piecewise(kinks), tension=1.0)],
            [PointLoad("inner", force=(0.05, 0, 0))],
        )

    whole = robot([(0.0, Helix(5e-3, 0.0)), (0.08, Helix(5e-3, 10.0, -0.8))])
    d = 1e-7
    halves = robot(
        [(0.0, Helix(5e-3, 0.0)), (0.08, Helix(5e-3, 5.0, -0.4)), (0.08 + d, Helix(5e-3, 10.0, -0.8 - 5 * d))]
    )
    assert reference.solve(whole).tip == pytest.approx(reference.solve(halves).tip, abs=1e-8)


def test_gravity_is_the_weight_of_each_tube() -> None:
    tubes = pair()
    g = np.array([0.0, -200.0, 0.0])
    weights = [
        DistributedLoad(tube.name, force=triple(tube.linear_density * g))
        for tube in tubes
        if tube.linear_density
    ]
    assert len(weights) == 2
    by_density = reference.solve(Robot(tubes, [slanted()], [Gravity((0.0, -200.0, 0.0))]))
    by_load = reference.solve(Robot(tubes, [slanted()], weights))
    assert by_density.tip == pytest.approx(by_load.tip, abs=1e-10)


def test_body_load_is_the_world_load_turned_with_the_tip() -> None:
    robot = Robot(
        pair(),
        [slanted()],
        [PointLoad("inner", force=(0.05, 0.02, -0.03), moment=(1e-3, 0, 2e-3), axes="body")],
    )
    shape = reference.solve(robot)
    R = shape.tubes[1].frames[-1]
    turned = PointLoad(
        "inner",
        force=triple(R @ [0.05, 0.02, -0.03]),
        moment=triple(R @ [1e-3, 0, 2e-3]),
    )
    world = reference.solve(Robot(pair(), [slanted()], [turned]), guess=(shape.u_base, shape.v_base))
    assert world.tip == pytest.approx(shape.tip, abs=1e-9)


def test_short_distributed_load_is_a_point_load() -> None:
    d = 1e-5
    spread = DistributedLoad("inner", force=(0.05 / d, 0.0, 0.0), start=0.07, end=0.07 + d)
    at = PointLoad("inner", force=(0.05, 0.0, 0.0), at=0.07 + d / 2)
    a, b = (reference.solve(Robot(pair(), [slanted()], [load])).tip for load in (spread, at))
    assert a == pytest.approx(b, abs=1e-8)


def test_turning_the_whole_robot_turns_the_shape() -> None:
    tubes = pair()
    angle = 0.7
    turned = [
        Tube(
            t.name,
            length=t.length,
            section=t.section,
            material=t.material,
            precurvature=t.precurvature,
            rotation=t.rotation + angle,
        )
        for t in tubes
    ]
    a, b = (reference.solve(Robot(each, [slanted()])).centreline for each in (tubes, turned))
    c, s = np.cos(angle), np.sin(angle)
    assert b == pytest.approx(a @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]), abs=1e-10)
