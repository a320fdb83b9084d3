"""Contact against equilibrium of every single tube, integrated here from strains, frames and tensions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import tactr
from tactr import DistributedLoad, Helix, PointLoad, Robot, Tendon
from tactr.statics import Shape

from .balance import breakpoints, carried, contact_on, host_at, pull_at

GAP = 1e-7
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def rich(robot: Robot) -> Robot:
    """Dead loads on both tubes, and tendons of all kinds: two on one channel, one that changes its host while
    the tubes are turned against each other, one that ends on the inner tube while the outer guides it."""
    more = [
        Tendon("a2", "outer", robot.tendons[0].routing, tension=0.7, end=0.06),
        Tendon("slanted", "inner", Helix(0.004, 15.0), host="outermost", tension=0.6),
        Tendon("short", "inner", Helix(0.004, -9.0), host="outermost", tension=0.8, end=0.09),
    ]
    loads = [
        PointLoad("inner", force=(0.02, 0.0, -0.03), moment=(1e-3, 0.0, 5e-4)),
        PointLoad("outer", force=(0.0, 0.03, 0.01)),
        DistributedLoad("outer", force=(0.0, 0.1, 0.05), moment=(0.002, 0.0, 0.001)),
        DistributedLoad("inner", force=(0.05, 0.0, 0.02), axes="body"),
    ]
    return robot.replace(tendons=(*robot.tendons, *more), loads=loads)


def three() -> Robot:
    """The middle tube ends first, so the outer and the inner one become neighbours."""
    section = [tactr.Annulus(0.003 - 0.0008 * i, 0.0024 - 0.0008 * i) for i in range(3)]
    lengths, rest = (0.14, 0.1, 0.18), ((8.0, 0.0, 0.0), (0.0, 9.0, 2.0), (10.0, -4.0, 0.0))
    tubes = [
        tactr.Tube(
            name,
            length=lengths[i],
            section=section[i],
            material=tactr.materials.nitinol,
            precurvature=rest[i],
            rotation=0.5 * i,
        )
        for i, name in enumerate("abc")
    ]
    tendons = [Tendon("t", "b", Helix(0.004, 12.0), tension=3.0, end=0.08)]
    return Robot(tubes, tendons, [PointLoad("c", force=(0.05, 0.0, 0.02))])


def loads_on(shape: Shape, name: str, frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distributed load on a tube at stations with these frames, world axes."""
    force, moment = np.zeros((2, len(frames), 3))
    for load in shape.robot.loads:
        if isinstance(load, DistributedLoad) and load.tube == name:
            axes = frames if load.axes == "body" else np.eye(3)[None]
            force += axes @ np.array(load.force)
            moment += axes @ np.array(load.moment)
    return force, moment


@pytest.fixture(params=["rich", "three"], scope="module")
def loaded(request: pytest.FixtureRequest, robot: Robot) -> Robot:
    return rich(robot) if request.param == "rich" else three()


def test_each_tube_balances_between_breakpoints(loaded: Robot) -> None:
    """N and M change by the integral of contact, loads and p' x N."""
    solved = tactr.solve(loaded, tolerance=1e-11)
    ends = np.concatenate([[0.0], breakpoints(loaded)])
    for a, b in zip(ends[:-1] + GAP, ends[1:] - GAP, strict=True):
        places = np.concatenate([[a], a + (NODES + 1) * (b - a) / 2, [b]])
        shape = solved.sample(places)
        for i, tube in enumerate(shape.tubes):
            if len(tube.s) == 0:
                continue
            N, M = carried(shape, i)
            _, force, moment = contact_on(shape, i)
            f, tau = loads_on(shape, tube.name, tube.frames)
            tangent = np.einsum("kab,kb->ka", tube.frames, tube.v)
            w = WEIGHTS[:, None] * (b - a) / 2
            dN = -(w * (force + f)[1:-1]).sum(axis=0)
            dM = -(w * (moment + tau + np.cross(tangent, N))[1:-1]).sum(axis=0)
            np.testing.assert_allclose(N[-1] - N[0], dN, rtol=0.0, atol=2e-8, err_msg=f"{tube.name} {a}")
            np.testing.assert_allclose(M[-1] - M[0], dM, rtol=0.0, atol=1e-9, err_msg=f"{tube.name} {a}")
            across = np.einsum("ka,ka->k", force, tube.frames[:, :, 2])
            np.testing.assert_allclose(across, 0.0, rtol=0.0, atol=1e-12)


def point_loads(shape: Shape, name: str, s: float) -> tuple[np.ndarray, np.ndarray]:
    force, moment = np.zeros((2, 3))
    own = shape.robot.tube(name)
    for load in shape.robot.loads:
        if isinstance(load, PointLoad) and load.tube == name and abs(own.tip - s) < 1e-9:
            force, moment = force + load.force, moment + load.moment
    return force, moment


def handed_over(shape: Shape, i: int, before: float, beyond: float) -> tuple[np.ndarray, np.ndarray]:
    """Pull on tube i of tendons that change their host, or end on another tube, between two stations."""
    force, moment = np.zeros((2, 3))
    names = [tube.name for tube in shape.robot.tubes]
    for tendon in shape.robot.tendons:
        here, there = host_at(shape.robot, tendon, before), host_at(shape.robot, tendon, beyond)
        if here is None or here == there:
            continue
        if there is None:
            (pull, turn), giver = pull_at(shape, tendon, here, before), names.index(tendon.tube)
        else:
            (pull, turn), giver = pull_at(shape, tendon, there, beyond), there
        sign = (i == here) - (i == giver)
        force, moment = force + sign * pull, moment + sign * turn
    return force, moment


def test_each_tube_balances_across_breakpoints(loaded: Robot) -> None:
    """Along the axis too: what a tendon leaves on one tube the other has, as force and as moment, also where
    tubes are turned against each other."""
    solved = tactr.solve(loaded, tolerance=1e-11)
    turned = solved.sample([0.1 - 1e-9]).theta
    assert abs(turned[1, 0]) > 0.1
    for s in breakpoints(loaded):
        beyond = min(s + 1e-9, solved.s[-1])
        shape = solved.sample([s - 1e-9, beyond])
        for i, tube in enumerate(shape.tubes):
            if len(tube.s) == 0:
                continue
            places, force, moment = contact_on(solved, i, points=True)
            near = (np.abs(places - s) < 1e-12)[:, None]  # nowhere where only one tube is left
            N, M = carried(shape, i)
            f, m = point_loads(shape, tube.name, s)
            df, dm = handed_over(shape, i, s - 1e-9, s + 1e-9)
            gone = len(tube.s) == 1 or beyond <= s
            N_beyond, M_beyond = (np.zeros(3), np.zeros(3)) if gone else (N[1], M[1])
            np.testing.assert_allclose(
                N_beyond - N[0] + (near * force).sum(axis=0) + f + df,
                0.0,
                atol=5e-8,
                err_msg=f"{tube.name} {s}",
            )
            np.testing.assert_allclose(
                M_beyond - M[0] + (near * moment).sum(axis=0) + m + dm,
                0.0,
                atol=5e-9,
                err_msg=f"{tube.name} {s}",
            )


def test_the_exit_holds_each_tube(loaded: Robot) -> None:
    solved = tactr.solve(loaded, tolerance=1e-11)
    shape = solved.sample([1e-9])
    total_force, total_moment = np.zeros((2, 3))
    for i in range(len(shape.tubes)):
        N, M = carried(shape, i)
        total_force, total_moment = total_force + N[0], total_moment + M[0]
        if i == 0:
            continue
        _, force, moment = contact_on(solved, i, points=True)
        np.testing.assert_allclose((force[0] + N[0])[:2], 0.0, atol=5e-8)
        np.testing.assert_allclose((moment[0] + M[0])[:2], 0.0, atol=5e-9)
    reaction = solved.guide_reaction
    np.testing.assert_allclose(reaction.force[:2], -total_force[:2], atol=5e-8)
    np.testing.assert_allclose(reaction.moment[:2], -total_moment[:2], atol=5e-9)
    assert reaction.force[2] == pytest.approx(0.0, abs=1e-15)


Generator = Callable[[int], Robot]


@pytest.mark.parametrize("seed", range(12))
def test_nothing_breaks_on_random_robots(random_robot: Generator, seed: int) -> None:
    shape = tactr.solve(random_robot(seed))
    assert shape.converged
    for contact in shape.contacts:
        arrays = (contact.force, contact.moment, contact.points.force, contact.points.moment)
        assert all(np.isfinite(array).all() for array in arrays)
    assert len(shape.contacts) >= len(shape.robot.tubes) - 1
