"""Routings in closed form, and the pieces through which they reach the solver."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tactr.robot import (
    Function,
    Helix,
    Piecewise,
    PolarPolynomial,
    Polynomial,
    Routing,
    Spline,
    Straight,
)
from tactr.robot.piece import evaluate, shifted

LENGTH = 0.2
SIGMA = np.linspace(0, LENGTH, 201)
STEP = 1e-6

ROUTINGS: dict[str, Routing] = {
    "straight": Straight(0.003, -0.005),
    "polar": Straight.polar(0.0065, 2.0),
    "helix": Helix(0.0065, 8.0, 0.3),
    "left": Helix.from_pitch(0.0065, -0.05, 1.0),
    "polynomial": Polynomial((0.005, -0.02, 0.3), (0.001, 0.0, 0.1, -2.0)),
    "cone": PolarPolynomial((0.008, -0.02), (0.2, 3.0, 10.0)),
    "spline": Spline(
        (0, 0.05, 0.09, 0.15, 0.2), ((0.005, 0), (0.004, 0.003), (0, 0.005), (-0.004, 0.003), (-0.005, 0))
    ),
    "function": Function(lambda s: (0.005 * math.cos(12 * s), 0.004 * math.sin(9 * s)), LENGTH),
    "piecewise": Piecewise(((0, Straight(0.005, 0)), (0.1, Polynomial((0.005,), (-0.002, 0.02))))),
}
everything = pytest.mark.parametrize("routing", ROUTINGS.values(), ids=ROUTINGS)


@everything
def test_pieces_cover_and_agree(routing: Routing) -> None:
    for start, end in ((0.0, LENGTH), (0.03, 0.17)):
        pieces = routing.pieces(end, start=start)
        assert (pieces[0].start, pieces[-1].end) == (start, end)
        assert all(before.end == after.start for before, after in pairwise(pieces))
        inside = SIGMA[(start <= SIGMA) & (end >= SIGMA)]
        for ours, theirs in zip(evaluate(pieces, inside), routing.evaluate(inside), strict=True):
            np.testing.assert_allclose(ours, theirs, atol=1e-13, rtol=1e-12)


@everything
def test_derivative(routing: Routing) -> None:
    inside = SIGMA[1:-1] + 1.7e-4 * 0.5
    _, slope = routing.evaluate(inside)
    numeric = (routing.evaluate(inside + STEP)[0] - routing.evaluate(inside - STEP)[0]) / (2 * STEP)
    np.testing.assert_allclose(slope, numeric, atol=1e-8)


@everything
def test_shapes(routing: Routing) -> None:
    xy, slope = routing.evaluate(0.05)
    assert xy.shape == slope.shape == (2,)
    assert routing.r(0.05) == tuple(xy)
    xy, slope = routing.evaluate(np.full((3, 4), 0.05))
    assert xy.shape == slope.shape == (3, 4, 2)
    assert routing.evaluate([])[0].shape == (0, 2)


@everything
def test_hashable(routing: Routing) -> None:
    assert routing in {routing}


def test_straight_and_helix_by_hand() -> None:
    assert Straight(0.003, -0.005).r(0.1) == (0.003, -0.005)
    assert Straight.polar(0.01, math.pi / 2).r(0) == pytest.approx((0, 0.01), abs=1e-18)
    assert Helix(0.01, 8, 0.3).r(0.1) == pytest.approx((0.01 * math.cos(1.1), 0.01 * math.sin(1.1)))
    assert Helix.from_pitch(0.01, 0.05).rate == pytest.approx(2 * math.pi / 0.05)


def test_helix_reaches_the_solver_in_closed_form() -> None:
    (piece,) = Helix(0.0065, 8.0, 0.3).pieces(0.2, start=0.1)
    assert piece.polar
    assert piece.a == (0.0065,)
    assert piece.b == pytest.approx((1.1, 8.0))


def test_any_sigma_of_an_endless_routing() -> None:
    assert Helix(0.01, 8).domain == (-math.inf, math.inf)
    assert Helix(0.01, 8).pieces(math.inf)[0].end == math.inf
    assert Straight(1.0, 0).pieces(0.1, start=-0.1)[0].start == -0.1
    with pytest.raises(ValueError, match="start"):
        Straight(1.0, 0).pieces(0.1, start=math.nan)


numbers = st.floats(-1, 1, allow_nan=False)


@settings(max_examples=60, deadline=None)
@given(st.lists(numbers, min_size=1, max_size=16), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_shift_keeps_the_polynomial(coefficients: list[float], shift: float, d: float) -> None:
    moved = np.polynomial.polynomial.polyval(d, shifted(coefficients, shift))
    assert moved == pytest.approx(np.polynomial.polynomial.polyval(shift + d, coefficients), abs=1e-13)


def test_a_routing_of_ones_own() -> None:
    class Ellipse(Routing):
        def pieces(self, length: float, *, start: float = 0.0):  # type: ignore[override]
            return Helix(0.01, 5).pieces(length, start=start)

        def evaluate(self, sigma):  # type: ignore[override]
            return Helix(0.01, 5).evaluate(sigma)

    assert Ellipse().r(0.1) == Helix(0.01, 5).r(0.1)
    assert Ellipse().covers(0, 1)
