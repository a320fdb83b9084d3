"""Splines and fitted functions: how close they come, and where they end."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from tactr.robot import Function, RoutingPiece, Spline
from tactr.robot._fit import basis, fit

Path = Callable[[float], tuple[float, float]]

PATHS: dict[str, tuple[Path, float]] = {
    "constant": (lambda s: (0.005, -0.001), 0.2),
    "line": (lambda s: (0.005 - 0.01 * s, 0.02 * s), 0.2),
    "helix": (lambda s: (0.0065 * math.cos(8 * s), 0.0065 * math.sin(8 * s)), 0.3),
    "many turns": (lambda s: (0.0065 * math.cos(120 * s), 0.0065 * math.sin(120 * s)), 0.5),
    "peak": (lambda s: (0.006 / (1 + ((s - 0.1) / 0.01) ** 2), 0.001), 0.2),
    "step": (lambda s: (0.01 * math.tanh((s - 0.07) / 0.002), 0.0), 0.2),
    "gauss": (lambda s: (0.005 * math.exp(-(((s - 0.13) / 0.004) ** 2)), 0.002 * s), 0.2),
    "root": (lambda s: (math.sqrt(s + 1e-4), 0.0), 0.2),
    "cubic kink in curvature": (lambda s: (max(0.0, s - 0.0713) ** 3, 0.0), 0.2),
    "long": (lambda s: (0.05 * math.sin(3 * s), 0.05 * math.cos(2 * s)), 5.0),
    "short": (lambda s: (0.005 * math.sin(4e3 * s), 0.001), 2e-3),
}


@pytest.mark.parametrize(("path", "length"), PATHS.values(), ids=PATHS)
def test_fit_is_within_a_nanometre_everywhere(path: Path, length: float) -> None:
    routing = Function(path, length)
    sigma = np.linspace(0, length, 7919)
    exact = np.array([path(float(s)) for s in sigma])
    error = np.abs(routing.evaluate(sigma)[0] - exact).max()
    assert error < 1e-9
    assert routing.error < 1e-9
    assert len(routing.pieces(length)) <= 256


@pytest.mark.parametrize("name", ["helix", "many turns", "peak", "step", "gauss", "long"])
def test_powers_lose_no_digits(name: str) -> None:
    path, length = PATHS[name]
    routing = Function(path, length)
    sigma = np.linspace(0, length, 2003)
    exact = np.array([path(float(s)) for s in sigma])
    assert np.abs(routing.evaluate(sigma)[0] - exact).max() < 2e-11


def test_slope_of_a_smooth_function() -> None:
    routing = Function(PATHS["helix"][0], 0.3)
    sigma = np.linspace(0, 0.3, 501)
    exact = 8 * 0.0065 * np.stack((-np.sin(8 * sigma), np.cos(8 * sigma)), axis=-1)
    assert np.abs(routing.evaluate(sigma)[1] - exact).max() < 1e-9


def test_simple_functions_need_one_piece() -> None:
    assert [piece.a for piece in Function(PATHS["constant"][0], 0.2).pieces(0.2)] == [pytest.approx((0.005,))]
    assert len(Function(PATHS["line"][0], 0.2).pieces(0.2)[0].a) == 2
    assert len(Function(PATHS["helix"][0], 0.3).pieces(0.3)) == 1


def test_pieces_meet() -> None:
    pieces = Function(PATHS["many turns"][0], 0.5).pieces(0.5)
    assert len(pieces) > 2
    for before, after in pairwise(pieces):
        here = np.array(after.start)
        np.testing.assert_allclose(before.evaluate(here)[0], after.evaluate(here)[0], atol=1e-12)


def test_declared_kink_is_kept_sharp() -> None:
    routing = Function(lambda s: (abs(s - 0.07), 0.001), 0.2, breaks=[0.07])  # type: ignore[arg-type]
    assert routing.breaks == (0.07,)
    assert [piece.start for piece in routing.pieces(0.2)] == [0.0, 0.07]
    _, slope = routing.evaluate([0.07 - 1e-9, 0.07, 0.07 + 1e-9])
    np.testing.assert_allclose(slope[:, 0], [-1, 1, 1], atol=1e-9)


def test_function_is_not_called_again() -> None:
    calls: list[float] = []

    def path(sigma: float) -> list[np.float64]:
        calls.append(sigma)
        assert type(sigma) is float
        return [np.float64(0.01 * sigma), np.float64(0)]

    routing = Function(path, 0.1)
    count = len(calls)
    assert min(calls) == 0.0
    assert max(calls) == 0.1
    assert count < 200
    routing.evaluate(0.05)
    routing.pieces(0.1)
    assert len(calls) == count


def test_numpy_results_and_noise_below_the_tolerance() -> None:
    def rounded(sigma: float) -> np.ndarray:
        return np.round(np.array([0.005 * math.cos(8 * sigma), 0.005 * math.sin(8 * sigma)]), 10)

    routing = Function(rounded, 0.2)
    assert 1e-11 < routing.error < 1e-9


def test_error_of_the_function_is_chained() -> None:
    with pytest.raises(ValueError, match="ZeroDivisionError") as caught:
        Function(lambda s: (1 / s, 0.0), 0.1)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_equality_goes_by_function_length_and_breaks() -> None:
    path = PATHS["helix"][0]
    assert Function(path, 0.1) == Function(path, 0.1)
    assert Function(path, 0.1) != Function(path, 0.2)
    assert "pieces" not in repr(Function(path, 0.1))


def test_matrices() -> None:
    nodes = 0.5 - 0.5 * np.cos(np.pi * np.arange(16) / 15)
    values = np.polynomial.chebyshev.chebval(2 * nodes - 1, np.arange(1.0, 17.0))
    np.testing.assert_allclose(basis(16).to_chebyshev @ values, np.arange(1.0, 17.0), rtol=1e-12)
    for k in range(16):
        unit: Any = np.polynomial.chebyshev.Chebyshev.basis(k, domain=[0, 1]).convert(
            kind=np.polynomial.Polynomial
        )
        np.testing.assert_allclose(basis(16).to_monomial[: k + 1, k], unit.coef, rtol=1e-12)


def test_fit_reports_what_it_saw() -> None:
    pieces, error = fit(lambda s: (s, 0.0), (0.0, 0.1, 0.2))
    assert [(piece.start, piece.end) for piece in pieces] == [(0.0, 0.1), (0.1, 0.2)]
    assert isinstance(pieces[0], RoutingPiece)
    assert error < 1e-15


def test_spline_is_scipys() -> None:
    sigma = np.array([0, 0.03, 0.05, 0.11, 0.2])
    points = np.random.default_rng(1).normal(0, 0.005, (5, 2))
    routing, theirs = Spline(sigma, points), CubicSpline(sigma, points)
    places = np.linspace(0, 0.2, 301)
    xy, slope = routing.evaluate(places)
    np.testing.assert_allclose(xy, theirs(places), atol=1e-15)
    np.testing.assert_allclose(slope, theirs(places, 1), atol=1e-12)
    assert routing.sigma == tuple(sigma)
    assert type(routing.points[0][0]) is float
    assert routing == Spline(tuple(sigma), points.tolist())


@pytest.mark.parametrize("count", [2, 3, 4])
def test_spline_through_few_points(count: int) -> None:
    sigma = np.linspace(0, 0.1, count)
    routing = Spline(sigma, np.column_stack((sigma**2, 1 - sigma)))
    np.testing.assert_allclose(routing.evaluate(sigma)[0][:, 0], sigma**2, atol=1e-15)
    assert len(routing.pieces(0.1)) == count - 1


def test_domain_forgives_rounding_only() -> None:
    routing = Spline((0, 0.1), ((0, 0), (0, 0)))
    end = math.nextafter(0.1, 1)
    assert routing.pieces(end)[-1].end == end
    assert routing.evaluate(end)[0].shape == (2,)
    assert [(p.start, p.end) for p in routing.pieces(0.1 + 5e-10, start=0.1)] == [(0.1, 0.1 + 5e-10)]
    assert Spline((1e-10, 0.1), ((0, 0), (0, 0))).pieces(0.1)[0].start == 0.0
    assert routing.covers(0, 0.1)
    assert not routing.covers(0, 0.1001)
    assert not routing.covers(-0.001, 0.1)
