"""Uniform samples of numbers in a row: against rejection, and against volumes in closed form."""

from math import factorial, inf
from typing import Any

import numpy as np
import pytest
from scipy.stats import chisquare, ks_2samp

from tactr.studies.chain import Chain

CTR = Chain((-0.10, -0.20, -0.30), (0.0, -0.02, -0.05), (0.01, 0.0), (0.1315, 0.1325))
SKEW = Chain((0.0, -1.0, 0.2), (1.0, 0.7, 2.0), (-0.4, -inf), (inf, 0.1))


def holds(chain, x):
    inside = ((x >= np.array(chain.low)) & (x <= np.array(chain.high))).all(axis=1)
    apart = x[:, :-1] - x[:, 1:]
    return inside & ((apart >= np.array(chain.least)) & (apart <= np.array(chain.most))).all(axis=1)


def by_rejection(chain, count, seed):
    low, high = np.array(chain.low), np.array(chain.high)
    x = low + np.random.default_rng(seed).random((count, len(low))) * (high - low)
    return x[holds(chain, x)]


@pytest.mark.parametrize("chain", [CTR, SKEW])
def test_every_sample_is_in_the_set(chain):
    x = chain.points(np.random.default_rng(0).random((20_000, 3)))
    rounding = 1e-15
    wider = Chain(
        *(tuple(v + sign * rounding for v in part) for part, sign in (
            (chain.low, -1), (chain.high, 1), (chain.least, -1), (chain.most, 1)
        ))
    )  # fmt: skip
    assert holds(wider, x).all()


@pytest.mark.parametrize("chain", [CTR, SKEW])
def test_samples_are_distributed_as_by_rejection(chain):
    x = chain.points(np.random.default_rng(1).random((40_000, 3)))
    expected = by_rejection(chain, 400_000, 2)
    directions = np.random.default_rng(3).normal(size=(12, 3))
    for direction in (*np.eye(3), *directions):
        result: Any = ks_2samp(x @ direction, expected @ direction)
        assert result.pvalue > 1e-4


@pytest.mark.parametrize("chain", [CTR, SKEW])
def test_samples_fill_boxes_as_by_rejection(chain):
    """Boxes in all three directions at once, which no projection would show."""
    x, expected = chain.points(np.random.default_rng(4).random((60_000, 3))), by_rejection(chain, 600_000, 5)
    edges = [np.quantile(column, np.linspace(0, 1, 6)[1:-1]) for column in expected.T]

    def counts(points):
        places = [np.searchsorted(edge, column) for edge, column in zip(edges, points.T, strict=True)]
        return np.bincount(np.ravel_multi_index(places, (5, 5, 5)), minlength=125)

    found, known = counts(x), counts(expected)
    full = known > 200
    assert full.sum() > 20
    assert found[known == 0].sum() == 0
    # the known counts scatter, too: their share of the variance is that of their number
    scale = found[full].sum() / known[full].sum()
    spread = ((found[full] - scale * known[full]) ** 2 / (scale * (1 + scale) * known[full])).sum()
    assert spread < full.sum() + 5 * np.sqrt(2 * full.sum())


def test_ordered_numbers_have_the_volume_of_a_simplex():
    for count in (1, 2, 3, 8):
        gap = 0.02
        chain = Chain((-1.0,) * count, (0.0,) * count, (gap,) * (count - 1), (inf,) * (count - 1))
        expected = (1.0 - (count - 1) * gap) ** count / factorial(count)
        assert chain.volume == pytest.approx(expected, rel=1e-11)


def test_ordered_numbers_are_order_statistics():
    """The k-th largest of n uniform numbers has the density of a beta distribution; here its mean."""
    chain = Chain((0.0,) * 5, (1.0,) * 5, (0.0,) * 4, (inf,) * 4)
    x = chain.points(np.random.default_rng(0).random((50_000, 5)))
    assert x.mean(axis=0) == pytest.approx(np.arange(5, 0, -1) / 6, abs=5e-3)


@pytest.mark.parametrize("chain", [CTR, SKEW])
def test_volume_is_the_share_that_rejection_keeps(chain):
    box = np.prod(np.array(chain.high) - np.array(chain.low))
    kept = len(by_rejection(chain, 400_000, 6)) / 400_000
    assert chain.volume / box == pytest.approx(kept, abs=4 * np.sqrt(kept / 400_000))


def test_without_rules_it_is_a_box():
    chain = Chain((0.0, 5.0), (1.0, 7.0), (-inf,), (inf,))
    u = np.random.default_rng(0).random((100, 2))
    assert chain.points(u) == pytest.approx(np.array([0.0, 5.0]) + u * np.array([1.0, 2.0]), abs=1e-12)


def test_nothing_meets_rules_that_exclude_each_other():
    assert Chain((0.0, 0.0), (1.0, 1.0), (2.0,), (inf,)).volume == 0.0


def test_even_samples_of_the_cube_stay_even():
    """A Sobol sequence goes through: boxes of equal volume hold nearly equal numbers of it."""
    from tactr.studies.unit_samples import unit_samples

    chain = Chain((0.0,) * 2, (1.0,) * 2, (0.0,), (inf,))
    x = chain.points(unit_samples("sobol", 0, 4096, 2, 0, 4096))
    # x[0] ** 2 and x[1] / x[0] are uniform and independent
    places = np.floor(8 * np.stack([x[:, 0] ** 2, x[:, 1] / x[:, 0]])).astype(int)
    counts = np.bincount(np.ravel_multi_index(tuple(places), (8, 8)), minlength=64)
    assert chisquare(counts).statistic < 2.0
