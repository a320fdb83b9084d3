"""All equilibria: of two opposed tubes against the pendulum, of others by what must hold for any count."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tactr
from tactr import Annulus, Gravity, Material, PointLoad, Robot, RobotError, Stiffness, Tube
from tactr.statics import Shape, Status

from .opposed_tubes import LENGTH, find_root, pair


def pendulum_base(tip: float, size: float) -> float:
    """The base angle for one at the tip: a'' = size^2 sin a over unit length, a' = 0 at the tip."""
    path = solve_ivp(
        lambda _, a: (a[1], size**2 * math.sin(a[0])), (1.0, 0.0), (tip, 0.0), rtol=1e-12, atol=1e-13
    )
    return float(path.y[0, -1])


def pendulum_bases(tips: np.ndarray, size: float) -> np.ndarray:
    """The same for many tips at once, (n,), coarser: between which of them a base angle is met."""
    path = solve_ivp(
        lambda _, y: np.concatenate([y[len(tips) :], size**2 * np.sin(y[: len(tips)])]),
        (1.0, 0.0),
        np.concatenate([tips, 0.0 * tips]),
        rtol=1e-9,
        atol=1e-9,
    )
    return path.y[: len(tips), -1]


def pendulum_tips(angle: float, size: float) -> list[float]:
    """All tip angles in [0, 2 pi) whose base is at angle, up to whole turns; unwound to meet it exactly."""
    places = np.linspace(1e-3, 2 * math.pi + 1e-3, 401)
    bases = pendulum_bases(places, size)
    tips = []
    for m in range(math.floor(bases.min() / math.tau) - 1, math.ceil(bases.max() / math.tau) + 2):
        missed = bases - angle - math.tau * m
        for k in np.flatnonzero(missed[:-1] * missed[1:] < 0.0):
            wanted = angle + math.tau * m
            root = find_root(
                lambda x, w=wanted: pendulum_base(x, size) - w, places[k], places[k + 1], xtol=1e-13
            )
            tips.append(root - math.tau * m)
    return sorted(tips)


def tips(shapes: list[Shape]) -> list[float]:
    return sorted(float(shape.theta[1, -1]) for shape in shapes)


@pytest.mark.parametrize(
    ("size", "angle", "count", "stable"),
    [
        (0.5, 180.0, 1, 1),
        (1.5, 180.0, 1, 1),
        (1.6, 180.0, 3, 2),
        (2.0, 180.0, 3, 2),
        (4.0, 180.0, 3, 2),
        (5.0, 180.0, 5, 2),
        (2.0, 170.0, 3, 2),
        (2.0, 100.0, 1, 1),
        (6.0, 60.0, None, None),
    ],
)
def test_two_tubes_against_the_pendulum(
    size: float, angle: float, count: int | None, stable: int | None
) -> None:
    shapes = tactr.branches(pair(size, math.radians(angle)), tolerance=1e-10)
    expected = pendulum_tips(math.radians(angle), size)
    np.testing.assert_allclose(tips(shapes), expected, rtol=0.0, atol=1e-7)
    if count is not None:
        assert len(shapes) == count and sum(shape.stability.stable for shape in shapes) == stable
    for shape in shapes:
        assert shape.converged and shape.theta[1, 0] == pytest.approx(math.radians(angle), abs=1e-7)


def test_order_is_by_stability_then_energy() -> None:
    shapes = tactr.branches(pair(3.0, math.radians(150)))
    order = [(not shape.stability.stable, shape.potential_energy) for shape in shapes]
    assert len(shapes) == 3 and order == sorted(order)


def ctr(turns: tuple[float, float, float], loads: tuple = ()) -> Robot:
    """Three tubes curved beyond where they snap."""
    rows = (
        ("outer", 0.09, 1.4e-3, 1.2e-3),
        ("middle", 0.12, 1.1e-3, 0.97e-3),
        ("inner", 0.15, 0.92e-3, 0.8e-3),
    )
    return Robot(
        [
            Tube(
                name,
                length=length,
                section=Annulus(outer, bore),
                material=Material(E=65e9, nu=0.32, density=6450.0),
                precurvature=(18.0, 0.0, 0.0),
                rotation=turn,
            )
            for (name, length, outer, bore), turn in zip(rows, turns, strict=True)
        ],
        loads=loads,
    )


LOADS = {
    "none": (),
    "force": (PointLoad("inner", force=(0.02, 0.03, -0.03)),),
    "weight": (Gravity((0.0, 9.81, 0.0)),),
}


@pytest.mark.parametrize("name", LOADS)
def test_signs_of_the_determinants_add_up_to_one(name: str) -> None:
    """The map from free end to base has degree 1; conjugate points give the sign of every solution."""
    counts = []
    for turns in ((0.0, 3.0, 2.0), (0.0, 2.9, -2.7), (0.0, math.pi, 0.1)):
        shapes = tactr.branches(ctr(turns, LOADS[name]))
        assert sum((-1) ** len(shape.stability.conjugate_points) for shape in shapes) == 1
        for shape in shapes:
            assert (np.sign(shape.stability.determinant[0]) > 0) == (
                len(shape.stability.conjugate_points) % 2 == 0
            )
        assert (
            shapes[0].potential_energy == min(shape.potential_energy for shape in shapes)
            and shapes[0].stability.stable
        )
        counts.append(len(shapes))
    assert max(counts) > 1


def test_more_samples_find_no_more() -> None:
    robot = ctr((0.0, 2.9, -2.7))
    few, many = tactr.branches(robot), tactr.branches(robot, samples=2500)
    assert len(few) == len(many) > 1
    np.testing.assert_allclose(
        [s.potential_energy for s in few], [s.potential_energy for s in many], rtol=1e-6
    )


def test_one_tube_without_loads_has_one_shape() -> None:
    robot = Robot([Tube("rod", length=0.1, section=Stiffness(EA=1e4, GA=4e3, EI_x=1e-3, EI_y=1e-3, GJ=1e-3))])
    assert len(tactr.branches(robot)) == 1


def test_a_buckled_round_rod_counts_once() -> None:
    """Between once and nine times Euler's load: straight or buckled, in whatever direction."""
    tube = Tube("rod", length=LENGTH, section=Stiffness(EA=1e7, GA=1e7, EI_x=1e-2, EI_y=1e-2, GJ=8e-3))
    force = 2.0 * math.pi**2 * 1e-2 / (4 * LENGTH**2)
    shapes = tactr.branches(Robot([tube], loads=[PointLoad("rod", force=(0.0, 0.0, -force))]))
    assert [shape.stability.stable for shape in shapes] == [True, False]
    assert len(shapes[1].stability.conjugate_points) == 2


@pytest.mark.parametrize("samples", [0, -1, 2.5, "many", True])
def test_wrong_samples(samples) -> None:
    with pytest.raises(RobotError) as caught:
        tactr.branches(pair(1.0, 1.0), samples=samples)
    assert caught.value.field == "samples"


@pytest.mark.parametrize("size", [1.6, 2.0, 3.0, 5.0])
def test_a_cold_start_leaves_the_unstable_shape(size: float) -> None:
    shape = tactr.solve(pair(size, math.pi))
    assert shape.converged and shape.status is Status.CONVERGED and shape.stability.stable
    assert "found first was unstable" in shape.message
    assert abs(float(shape.theta[1, -1]) - math.pi) > 0.1


@pytest.mark.parametrize("force", [1.05, 2.0, 5.0])
def test_a_cold_start_buckles(force: float) -> None:
    """Deflection of the elastica against a pendulum integrated here: phi'' = -(P / EI) sin(phi)."""
    section = Stiffness(EA=1e8, GA=1e8, EI_x=1e-2, EI_y=1.2e-2, GJ=8e-3)
    load = force * math.pi**2 * 1e-2 / (4 * LENGTH**2)
    robot = Robot(
        [Tube("rod", length=LENGTH, section=section)], loads=[PointLoad("rod", force=(0, 0, -load))]
    )
    shape = tactr.solve(robot, tolerance=1e-9)
    assert shape.stability.stable

    def at_base(tip: float) -> np.ndarray:
        rate = lambda _, a: (a[1], -load / 1e-2 * math.sin(a[0]), math.sin(a[0]))  # noqa: E731
        return solve_ivp(rate, (0.0, LENGTH), (tip, 0.0, 0.0), rtol=1e-11, atol=1e-13).y[:, -1]

    tip = find_root(lambda x: at_base(x)[0], 0.05, 3.1, xtol=1e-12)
    assert np.hypot(*shape.tip_position[:2]) == pytest.approx(at_base(tip)[2], abs=1e-7)


def test_a_guess_stays_on_its_branch() -> None:
    gentle = tactr.solve(pair(1.5, math.pi))
    shape = tactr.solve(pair(1.7, math.pi), guess=gentle)
    np.testing.assert_allclose(shape.theta[1], math.pi, rtol=0.0, atol=1e-6)
    assert not shape.stability.stable and shape.status is Status.CONVERGED
