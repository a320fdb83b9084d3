"""Quantities along a tube and rest shapes: what they are, and what is refused."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import (
    Along,
    Annulus,
    PointLoad,
    RestShape,
    Robot,
    RobotError,
    Rod,
    Stiffness,
    Tube,
    VaryingStiffness,
)
from tactr.materials import nitinol

RADIUS, PITCH, LENGTH = 0.01, 0.04, 0.12
RISE = PITCH / (2 * math.pi)
RATE = 1 / math.hypot(RADIUS, RISE)
STIFF: dict[str, Any] = {"EA": 1e4, "GA": 3e3, "EI_x": 1e-3, "EI_y": 1e-3, "GJ": 8e-4}


def helix(s: float) -> np.ndarray:
    return np.array([RADIUS * math.cos(RATE * s), RADIUS * math.sin(RATE * s), RISE * RATE * s])


def helix_frame(s: float) -> np.ndarray:
    sine, cosine = math.sin(RATE * s), math.cos(RATE * s)
    tangent = np.array([-RADIUS * RATE * sine, RADIUS * RATE * cosine, RISE * RATE])
    normal = -np.array([cosine, sine, 0.0])
    return np.column_stack((np.cross(tangent, normal), -normal, tangent))


def misfit(a: np.ndarray, b: np.ndarray) -> float:
    """Largest distance of two curves after the best turn and shift."""
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
    return float(np.max(np.linalg.norm(a @ turn - b, axis=1)))


def unloaded(shape: RestShape, length: float) -> np.ndarray:
    """The centreline that the solver finds without load, at 41 stations."""
    tube = Tube("a", length=length, section=Rod(1e-3), material=nitinol, precurvature=shape)
    found = tactr.solve(Robot([tube]), tolerance=1e-11, stations=41)
    assert found.converged
    np.testing.assert_allclose(found.tubes[0].m, 0.0, atol=1e-9)
    return found.centreline


def test_along_values() -> None:
    q = Along([(0.0, (1.0, 2.0)), (0.5, (4.0, 0.0, 1.0))], 2.0)
    np.testing.assert_allclose(q([0.0, 0.25, 0.5, 1.5]), [1.0, 1.5, 4.0, 5.0])
    assert q.powers_at(1.0) == (4.25, 1.0, 1.0)
    assert q.least(0.0, 2.0) == 1.0
    assert Along([(0.0, (1.0, -2.0, 1.0))]).least(0.0, 3.0) == pytest.approx(0.0, abs=1e-15)
    assert Along.steps((0, 1), (2, 3)) == Along([(0.0, (2.0,)), (1.0, (3.0,))])
    np.testing.assert_allclose(Along.linear([0, 1, 3], [2, 4, 0])([0.5, 2.0]), [3.0, 2.0])


def test_along_function_keeps_its_tolerance_and_jumps() -> None:
    def f(s: float) -> float:
        return math.exp(-10 * s) * (1 + 0.3 * math.sin(90 * s)) + (s >= 0.05)

    q = Along.function(f, 0.1, breaks=[0.05])
    places = np.linspace(0, 0.1, 1001)
    np.testing.assert_allclose(q(places), [f(s) for s in places], rtol=0, atol=2e-9)
    assert q(0.05 - 1e-12) == pytest.approx(f(0.05 - 1e-12), abs=1e-9)


@pytest.mark.parametrize(
    ("make", "field", "words"),
    [
        (lambda: Along([]), "parts", "none"),
        (lambda: Along([(0.1, (1,))]), "parts[0]", "first start of 0"),
        (lambda: Along([(0, (1,)), (0, (1,))]), "parts[1]", "increase"),
        (lambda: Along([(0, ())]), "parts[0][1]", "1 to 8"),
        (lambda: Along([(0, (1,) * 9)]), "parts[0][1]", "1 to 8"),
        (lambda: Along([(0, (1,))], 0), "end", "too small"),
        (lambda: Along([(0, (math.nan,))]), "parts[0][1][0]", "nan"),
        (lambda: Along.linear([0, 1], [1]), "values", "1 entries"),
        (lambda: Along.function(lambda s: math.sqrt(abs(s - 0.03)), 0.1), "function", "too rough"),
        (lambda: Along.function(lambda s: math.nan, 0.1), "function", "nan"),
        (lambda: Along.function(lambda s: 1 / 0, 0.1), "function", "ZeroDivisionError"),
        (lambda: Along.function(lambda s: "1", 0.1), "function", "'1'"),  # type: ignore[arg-type]
        (lambda: Along([(0, (1,))], 1.0)(1.1), "sigma", "outside"),
        (lambda: VaryingStiffness(**{**STIFF, "EI_x": Along.linear([0, 1], [1, -1])}), "EI_x", "falls to -1"),
        (lambda: Stiffness(**STIFF, neutral_axis=(1,)), "neutral_axis", "1 entries"),  # type: ignore[arg-type]
        (lambda: VaryingStiffness.function(lambda s: 5, 0.1), "function", "5"),  # type: ignore[arg-type]
        (lambda: VaryingStiffness(**STIFF), "EI_x", "does not vary"),
        (lambda: RestShape((1, 2)), "u", "2 entries"),
        (lambda: RestShape(v=(0, 0, 0)), "v[2]", "above 0"),
        (lambda: RestShape.helix(0, 1), "radius", "above 0"),
        (lambda: RestShape.from_centreline(lambda s: (s, 0), 0.1), "position", "2 entries"),
        (lambda: RestShape.from_centreline(lambda s: (abs(s - 0.031), 0, s), 0.1), "position", "too rough"),
        (lambda: RestShape.from_centreline(lambda s: (0, 0, 0), 0.1), "position", "stands still"),
        (lambda: RestShape.from_centreline(helix, 0.1, frame=lambda s: 2 * np.eye(3)), "frame", "unit axes"),
        (lambda: RestShape.from_points([(0, 0, 0)] * 5), "points[1]", "again"),
        (lambda: RestShape.from_points([(0, 0, k) for k in range(3)]), "points", "at least 4"),
        (
            lambda: RestShape.from_points([(0, 0, k) for k in range(5)], frames=[np.eye(3)] * 5),
            "sigma",
            "frames",
        ),
    ],
)
def test_refused(make: Any, field: str, words: str) -> None:
    with pytest.raises(RobotError, match=None) as caught:
        make()
    assert (caught.value.field, words in str(caught.value)) == (field, True), str(caught.value)


def test_helix_curvature_and_torsion() -> None:
    shape = RestShape.helix(RADIUS, PITCH)
    assert shape.u == pytest.approx((RADIUS * RATE**2, 0.0, RISE * RATE**2), rel=1e-14)
    there = np.array([helix(s) for s in np.linspace(0, LENGTH, 41)])
    assert misfit(unloaded(shape, LENGTH), there) < 1e-10


def test_centreline_with_its_frame_is_the_helix() -> None:
    shape = RestShape.from_centreline(helix, LENGTH, frame=helix_frame)
    exact = RestShape.helix(RADIUS, PITCH)
    assert shape.v == (0.0, 0.0, 1.0)
    assert shape.u[1] == 0.0
    for k in (0, 2):
        found: Any = shape.u[k]
        np.testing.assert_allclose(found(np.linspace(0, LENGTH, 50)), float(exact.u[k]), rtol=1e-9)  # type: ignore[arg-type]


def test_centreline_that_turns_least() -> None:
    shape = RestShape.from_centreline(helix, LENGTH)
    assert shape.u[2] == 0.0
    x, y = (u(np.linspace(0, LENGTH, 50)) for u in shape.u[:2] if isinstance(u, Along))
    np.testing.assert_allclose(np.hypot(x, y), RADIUS * RATE**2, rtol=1e-8)
    # a frame without twist turns from the normal by the torsion
    turned = np.unwrap(np.arctan2(y, x))
    np.testing.assert_allclose(np.diff(turned), np.diff(turned)[0], rtol=1e-6)
    assert abs(turned[-1] - turned[0]) == pytest.approx(RISE * RATE**2 * LENGTH, rel=1e-8)
    there = np.array([helix(s) for s in np.linspace(0, LENGTH, 41)])
    assert misfit(unloaded(shape, LENGTH), there) < 1e-9


def test_points_of_a_helix() -> None:
    there = np.array([helix(s) for s in np.linspace(0, LENGTH, 41)])
    shape = RestShape.from_points(there)
    assert shape.end == pytest.approx(LENGTH, rel=1e-6)
    assert misfit(unloaded(shape, shape.end), there) < 2e-7
    framed = RestShape.from_points(
        there, sigma=np.linspace(0, LENGTH, 41), frames=[helix_frame(s) for s in np.linspace(0, LENGTH, 41)]
    )
    assert framed.end == pytest.approx(LENGTH)
    assert misfit(unloaded(framed, LENGTH), there) < 1e-6
    twist = framed.u[2]
    assert isinstance(twist, Along)
    np.testing.assert_allclose(twist(np.linspace(0.01, 0.11, 9)), RISE * RATE**2, rtol=1e-3)


def test_points_with_noise_are_smoothed() -> None:
    rng = np.random.default_rng(3)
    clean = np.array([helix(s) for s in np.linspace(0, LENGTH, 60)])
    shape = RestShape.from_points(clean + rng.normal(0, 2e-5, clean.shape), smoothing=3.4e-5)
    found = shape.centreline(np.linspace(0, shape.end, 60))[0]
    assert misfit(found, clean) < 1e-4
    assert sum(len(u.parts) for u in shape.u if isinstance(u, Along)) < 80


def test_a_curve_that_starts_late_and_is_stretched() -> None:
    shape = RestShape.from_centreline(lambda s: (0.0, 2 * s**2, 1.2 * s), 0.05, start=0.03)
    assert shape.end == pytest.approx(0.08)
    p, R = shape.centreline([0.0, 0.03, 0.08])
    np.testing.assert_allclose(p, [(0, 0, 0), (0, 0, 0.03), (0, 2 * 0.05**2, 0.03 + 0.06)], atol=1e-10)
    np.testing.assert_allclose(R[1], np.eye(3), atol=1e-12)
    stretch = shape.v[2]
    assert isinstance(stretch, Along)
    np.testing.assert_allclose(
        stretch([0.0, 0.04, 0.08]), [1.0, math.hypot(1.2, 0.04), math.hypot(1.2, 0.2)], rtol=1e-8
    )


def test_tube_in_parts() -> None:
    thick, thin = Annulus(2e-3, 1e-3), Annulus(1.5e-3, 1.2e-3)
    tube = Tube("a", length=0.1, section=[(0, thick), (0.06, thin)], material=nitinol)
    assert tube.section == ((0.0, thick), (0.06, thin))
    assert (tube.outer_diameter, tube.inner_diameter) == (2e-3, 1e-3)
    assert tube.linear_density == pytest.approx(6450 * math.pi / 4 * (0.6 * 3e-6 + 0.4 * 0.81e-6))
    assert replace(tube, rotation=1.0).parts == tube.parts
    assert [stretch.start for stretch in tube.stretches] == [0.0, 0.06]
    assert replace(tube, section=[(0, thick)]).section is thick
    with pytest.raises(RobotError, match="section: its stiffness is not the same all along"):
        _ = tube.stiffness
    with pytest.raises(RobotError, match=r"precurvature: it is defined to 0\.08 m only"):
        replace(tube, precurvature=RestShape((Along.linear([0, 0.08], [0, 1]), 0, 0)))


def test_fit_is_checked_where_sections_meet() -> None:
    outer = Tube(
        "outer",
        length=0.1,
        section=[(0.0, Annulus(4e-3, 3e-3)), (0.05, Annulus(4e-3, 1.2e-3))],
        material=nitinol,
    )
    inner = Tube("inner", length=0.15, section=[(0.0, Rod(2e-3)), (0.06, Rod(1e-3))], material=nitinol)
    with pytest.raises(RobotError, match=r"tubes\[1\]\.section\[0\]\.outer_diameter: 0\.002 m does not fit"):
        Robot([outer, inner])
    assert Robot([outer, replace(inner, translation=-0.02)])


def test_weight_of_a_stepped_tube() -> None:
    section = [(0.0, Annulus(2e-3, 1e-3)), (0.06, Annulus(1.5e-3, 1.2e-3))]
    tube = Tube("a", length=0.1, section=section, material=nitinol)
    shape = tactr.solve(Robot([tube], loads=[tactr.Gravity()]), stations=[0.0, 0.06])
    weights = 6450 * 9.81 * math.pi / 4 * np.array([0.06 * 3e-6 + 0.04 * 0.81e-6, 0.04 * 0.81e-6])
    np.testing.assert_allclose(shape.tubes[0].n[:, 2], -weights, rtol=1e-9)


@pytest.mark.parametrize("load", ["world", "body"])
def test_jacobian_of_a_varying_tube(load: Any) -> None:
    wavy = Along.function(lambda s: 1e-3 * (1 + 0.5 * math.sin(40 * s)), 0.1)
    inner = Tube(
        "inner",
        length=0.1,
        section=VaryingStiffness(
            **{**STIFF, "EI_x": wavy}, neutral_axis=(Along.linear([0, 0.1], [0, 3e-4]), -2e-4)
        ),
        precurvature=RestShape((Along.linear([0, 0.1], [0, 12]), 2.0, 1.0), (0.01, 0.0, 1.02)),
        translation=-0.02,
    )
    outer = Tube("outer", length=0.06, section=Stiffness(**STIFF), precurvature=(0, 7, 0), rotation=0.5)
    tendon = tactr.Tendon("pull", "inner", tactr.Straight(1e-3, 5e-4), tension=1.0)
    robot = Robot([outer, inner], [tendon], [PointLoad("inner", force=(0.05, 0.02, 0), axes=load)])
    prepared = tactr.Prepared(robot, tolerance=1e-12)
    base = prepared.solve()
    jacobian = base.tip_jacobian()
    step = 1e-5
    for j, change in enumerate(({"tension": [1.0]}, {"rotation": [0.5, 0.0]}, {"rotation": [0.5, 0.0]})):
        tips = []
        for sign in (1.0, -1.0):
            moved = {key: np.array(value, dtype=float) for key, value in change.items()}
            next(iter(moved.values()))[max(j - 1, 0)] += sign * step
            tips.append(prepared.solve(**moved, guess=base).tip_position)  # type: ignore[arg-type]
        column = jacobian.tension[:3, 0] if j == 0 else jacobian.rotation[:3, j - 1]
        np.testing.assert_allclose(column, (tips[0] - tips[1]) / (2 * step), rtol=1e-5, atol=1e-9)
