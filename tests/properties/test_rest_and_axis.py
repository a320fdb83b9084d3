"""Rest shapes, and tendons that have no lever."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import tactr
from tactr import Annulus, Robot, Straight, Tendon, Tube
from tactr.materials import nitinol

Generator = Callable[[int], Robot]
SEEDS = st.integers(0, 2000)
CURVATURE = st.tuples(st.floats(-15, 15), st.floats(-15, 15), st.floats(-10, 10))
TOLERANCE = 1e-8


@given(
    pieces=st.lists(CURVATURE, min_size=1, max_size=4),
    rotation=st.floats(-math.pi, math.pi),
    behind=st.floats(0.0, 0.05),
)
def test_one_tube_without_tension_has_its_rest_shape(
    pieces: list[tuple[float, float, float]], rotation: float, behind: float
) -> None:
    """Helices one after another; behind the guide's exit straight, but the rest twist turns it there too."""
    length = 0.15 + behind
    starts = [k * length / len(pieces) for k in range(len(pieces))]
    tube = Tube(
        "tube",
        length=length,
        section=Annulus(0.001, 0.0008),
        material=nitinol,
        precurvature=list(zip(starts, pieces, strict=True)),
        rotation=rotation,
        translation=-behind,
    )
    slack = Tendon("slack", "tube", Straight(0.005, 0.0), tension=0.0)
    shape = tactr.solve(Robot([tube], [slack]), tolerance=TOLERANCE)
    frame, position = about_z(rotation), np.zeros(3)
    for start, end, u in zip(starts, [*starts[1:], length], pieces, strict=True):
        if min(end, behind) > start:
            frame = frame @ about_z(u[2] * (min(end, behind) - start))
        turn, step = arc(np.array(u), end - max(start, behind))
        position, frame = position + frame @ step, frame @ turn
    np.testing.assert_allclose(shape.tip_position, position, rtol=0.0, atol=2 * TOLERANCE)
    np.testing.assert_allclose(shape.tip_orientation, frame, rtol=0.0, atol=1e-6)


def about_z(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def arc(u: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Rotation and displacement along a helix of constant curvature and twist u, in its first frame."""
    size = float(np.linalg.norm(u))
    if length <= 0.0 or size < 1e-9:
        return np.eye(3), np.array([0.0, 0.0, max(length, 0.0)])
    k = np.array([[0.0, -u[2], u[1]], [u[2], 0.0, -u[0]], [-u[1], u[0], 0.0]]) / size
    a = size * length
    turn = np.eye(3) + math.sin(a) * k + (1.0 - math.cos(a)) * k @ k
    path = length * np.eye(3) + (1.0 - math.cos(a)) / size * k + (length - math.sin(a) / size) * k @ k
    return turn, path @ [0.0, 0.0, 1.0]


@given(seed=SEEDS)
def test_without_tensions_and_loads_tendons_do_not_matter(random_robot: Generator, seed: int) -> None:
    robot = random_robot(seed).replace(loads=())
    slack = robot.with_actuation(tension=[0.0] * len(robot.tendons))
    one, other = (tactr.solve(r, tolerance=TOLERANCE) for r in (slack, robot.replace(tendons=())))
    assert one.converged, one.message
    np.testing.assert_allclose(one.centreline, other.centreline, rtol=0.0, atol=4 * TOLERANCE)
    for tube, described in zip(one.tubes, robot.tubes, strict=True):
        k = described.stiffness
        starts = [stretch.start for stretch in described.stretches]
        piece = np.clip(np.searchsorted(starts, tube.sigma, side="right") - 1, 0, None)
        rest = np.array([stretch.powers[0][5:8] for stretch in described.stretches])[piece]
        inside = np.abs(tube.sigma[:, None] - starts).min(axis=1) > 1e-9
        moment = (tube.u - rest) * [k.EI_x, k.EI_y, k.GJ]
        np.testing.assert_allclose(tube.m[inside], moment[inside], rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(tube.n, 0.0, atol=1e-7)


@given(sizes=st.tuples(st.floats(0.0, 12.0), st.floats(0.0, 12.0)), direction=st.floats(-math.pi, math.pi))
def test_tubes_curved_in_one_plane_meet_at_the_weighted_curvature(
    sizes: tuple[float, float], direction: float
) -> None:
    tubes = [
        Tube(
            name,
            length=0.15,
            section=section,
            material=nitinol,
            precurvature=(0.0, k, 0.0),
            rotation=direction,
        )
        for name, section, k in zip(
            ("outer", "inner"), (Annulus(0.0014, 0.001), Annulus(0.0009, 0.0005)), sizes, strict=True
        )
    ]
    shape = tactr.solve(Robot(tubes), tolerance=TOLERANCE)
    stiffness = [tube.stiffness.EI_y for tube in tubes]
    _, path = arc(np.array([0.0, np.dot(stiffness, sizes) / sum(stiffness), 0.0]), 0.15)
    np.testing.assert_allclose(shape.tip_position, about_z(direction) @ path, rtol=0.0, atol=2 * TOLERANCE)


@given(seed=SEEDS, tension=st.floats(0.0, 10.0), host=st.sampled_from(["own", "outermost"]))
def test_a_tendon_on_the_axis_only_compresses(
    random_robot: Generator, seed: int, tension: float, host: str
) -> None:
    """Every frame stays as at rest; the centreline shortens by lambda / EA of its outermost tube."""
    rest = random_robot(seed).replace(loads=(), tendons=())
    tendon = Tendon("axis", rest.tubes[0].name, Straight(0.0, 0.0), host=host, tension=tension)  # pyright: ignore
    before, after = (
        tactr.solve(robot, tolerance=TOLERANCE) for robot in (rest, rest.replace(tendons=[tendon]))
    )
    assert before.converged and after.converged, before.message + after.message
    for one, other in zip(before.tubes, after.tubes, strict=True):
        np.testing.assert_allclose(other.frames, one.frames, rtol=0.0, atol=1e-6)
    pulled = after.tubes[0]
    stretch = 1.0 - tension / rest.tubes[0].stiffness.EA
    np.testing.assert_allclose(
        pulled.v, np.tile([0.0, 0.0, stretch], (len(pulled.v), 1)), rtol=0.0, atol=1e-10
    )
    np.testing.assert_allclose(
        pulled.position, stretch * before.tubes[0].position, rtol=0.0, atol=4 * TOLERANCE
    )


@given(seed=SEEDS)
def test_parting_the_robot_in_time_does_not_matter(random_robot: Generator, seed: int) -> None:
    """From a neighbouring shape as the guess, the same equilibrium."""
    robot = random_robot(seed)
    tension = [0.97 * t.tension for t in robot.tendons if isinstance(t.tension, float)]
    cold = tactr.solve(robot, tolerance=TOLERANCE)
    neighbour = tactr.solve(replace(robot), tension=tension, guess=cold)
    warm = tactr.solve(robot, guess=neighbour, tolerance=TOLERANCE)
    assert cold.converged and neighbour.converged and warm.converged
    np.testing.assert_allclose(warm.centreline, cold.centreline, rtol=0.0, atol=4 * TOLERANCE)
