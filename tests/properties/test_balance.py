"""Equilibrium checked from outside: from the strains and frames of a shape, without the kernel's own sums."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import tactr
from tactr import Gravity, PointLoad, Robot, Tendon
from tactr.statics import Shape

Generator = Callable[[int], Robot]
SEEDS = st.integers(0, 2000)


@given(seed=SEEDS)
def test_every_cut_carries_the_loads_beyond_it(random_robot: Generator, seed: int) -> None:
    """Summed over tubes and tendons, force and moment about the cut are those of the load at the tip, and the
    elastic part follows from the strains. Tubes that stretch differently slide on each other; the model lets
    their axial forces act along one centreline, which moves moments by the difference of stretch."""
    robot = random_robot(seed)
    robot = robot.replace(loads=[load for load in robot.loads if not isinstance(load, Gravity)])
    length = max(tube.tip for tube in robot.tubes)
    stations = interior(robot, length)
    shape = tactr.solve(robot, tolerance=1e-9, stations=stations)
    assert shape.converged, shape.message
    force, moment = carried(shape, robot)
    tip_force, tip_moment = tip_load(shape, robot)
    lever = shape.tip_position - shape.centreline
    size = float(np.abs(tip_force).max() + sum(np.abs(tube.n).max() for tube in shape.tubes)) + 1e-3
    stretches = np.concatenate([tube.v[:, 2] for tube in shape.tubes])
    sliding = size * np.ptp(stretches) * length * (len(robot.tubes) > 1)
    np.testing.assert_allclose(force, np.tile(tip_force, (len(force), 1)), rtol=0.0, atol=1e-6 * size)
    expected = tip_moment + np.cross(lever, tip_force)
    np.testing.assert_allclose(moment, expected, rtol=0.0, atol=sliding + 1e-7 * size * length)


def interior(robot: Robot, length: float) -> np.ndarray:
    """Stations away from ends and jumps, where values differ on both sides."""
    s = (np.arange(23) + 0.37) * length / 23
    jumps = [tube.tip for tube in robot.tubes]
    jumps += [tube.translation + stretch.start for tube in robot.tubes for stretch in tube.stretches]
    jumps += [robot.tube(t.tube).translation + t.end for t in robot.tendons if t.end is not None]
    return s[np.abs(s[:, None] - jumps).min(axis=1) > 1e-6]


def carried(shape: Shape, robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment about the centreline of tubes and tendons at every station, world axes."""
    force, moment = np.zeros((2, len(shape.s), 3))
    for tube, described in zip(shape.tubes, robot.tubes, strict=True):
        here = np.isin(shape.s, tube.s)
        k = described.stiffness
        starts = [stretch.start for stretch in described.stretches]
        piece = np.clip(np.searchsorted(starts, tube.sigma, side="right") - 1, 0, None)
        rest = np.array([stretch.powers[0][5:8] for stretch in described.stretches])[piece]
        n, m = (tube.v - [0, 0, 1]) * [k.GA, k.GA, k.EA], (tube.u - rest) * [k.EI_x, k.EI_y, k.GJ]
        force[here] += np.einsum("kab,kb->ka", tube.frames, n)
        moment[here] += np.einsum("kab,kb->ka", tube.frames, m)
    for tendon in robot.tendons:
        add_pull(shape, robot, tendon, force, moment)
    return force, moment


def add_pull(shape: Shape, robot: Robot, tendon: Tendon, force: np.ndarray, moment: np.ndarray) -> None:
    own = robot.tube(tendon.tube)
    end = own.length if tendon.end is None else tendon.end
    for k, s in enumerate(shape.s):
        if not s - own.translation < end:
            continue
        hosts = [i for i, tube in enumerate(robot.tubes) if s < tube.tip]
        host = hosts[0] if tendon.host == "outermost" else [t.name for t in robot.tubes].index(tendon.tube)
        tube = shape.tubes[host]
        at = int(np.flatnonzero(tube.s == s)[0])
        xy, slope = tendon.routing.evaluate(s - own.translation)
        r, dr = np.append(xy, 0.0), np.append(slope, 0.0)
        q = np.cross(tube.u[at], r) + dr + tube.v[at]
        assert isinstance(tendon.tension, float)
        pull = tendon.tension * q / np.linalg.norm(q)
        force[k] += tube.frames[at] @ pull
        moment[k] += tube.frames[at] @ np.cross(r, pull)


def tip_load(shape: Shape, robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    force, moment = np.zeros((2, 3))
    for load in robot.loads:
        assert isinstance(load, PointLoad)
        names = [tube.name for tube in robot.tubes]
        last = tactr.solve(robot, guess=shape, tolerance=1e-9, stations=[max(t.tip for t in robot.tubes)])
        frame = last.tubes[names.index(load.tube)].frames[-1]
        turn = np.eye(3) if load.axes == "world" else frame
        force += turn @ load.force
        moment += turn @ load.moment
    return force, moment
