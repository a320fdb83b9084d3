"""Routings put together from others."""

import math

import numpy as np
import pytest

from tactr.robot import Helix, Piecewise, Polynomial, Spline, Straight

KINKED = Piecewise([(0, Straight(0.005, 0)), (0.1, Polynomial((0.005,), (-0.002, 0.02)))])


def test_every_part_counts_sigma_from_the_tube() -> None:
    assert KINKED.r(0.05) == (0.005, 0.0)
    assert KINKED.r(0.15) == pytest.approx((0.005, 0.001))


def test_slope_jumps_at_the_kink() -> None:
    _, slope = KINKED.evaluate([0.1 - 1e-12, 0.1, 0.1 + 1e-12])
    np.testing.assert_allclose(slope[:, 1], [0, 0.02, 0.02])


def test_pieces() -> None:
    assert [(piece.start, piece.end) for piece in KINKED.pieces(0.2)] == [(0.0, 0.1), (0.1, 0.2)]
    assert [(piece.start, piece.end) for piece in KINKED.pieces(0.1)] == [(0.0, 0.1)]
    assert [(piece.start, piece.end) for piece in KINKED.pieces(0.2, start=0.12)] == [(0.12, 0.2)]
    assert [(piece.start, piece.end) for piece in KINKED.pieces(0.2, start=-0.1)] == [(-0.1, 0.1), (0.1, 0.2)]


def test_mixed_kinds_and_domain() -> None:
    end = Helix(0.005, 10).r(0.1)
    routing = Piecewise([(0, Helix(0.005, 10)), (0.1, Spline((0.1, 0.2), (end, (0.0, 0.0))))])
    assert routing.domain == (-math.inf, 0.2)
    assert [piece.polar for piece in routing.pieces(0.2)] == [True, False]
    assert routing.r(0.2) == pytest.approx((0, 0), abs=1e-18)
    assert not routing.covers(0, 0.3)


def test_nested() -> None:
    nested = Piecewise([(0, KINKED), (0.2, Straight(0.005, 0.002))])
    assert len(nested.pieces(0.3)) == 3
    assert nested.r(0.25) == (0.005, 0.002)


def test_one_part_is_that_part() -> None:
    assert Piecewise([(0, Straight(1.0, 2.0))]).r(0.3) == (1.0, 2.0)


def test_joint_tolerance() -> None:
    Piecewise([(0, Straight(0.005, 0)), (0.1, Straight(0.005 + 0.9e-9, 0))])
    with pytest.raises(ValueError, match=r"jumps by 1\.1e-09 m"):
        Piecewise([(0, Straight(0.005, 0)), (0.1, Straight(0.005 + 1.1e-9, 0))])
