"""Samples of the unit cube: what they are, and that any stretch of them is what the whole has there."""

from typing import Any

import numpy as np
import pytest
from scipy.stats import kstest, qmc

from tactr.studies.unit_samples import METHODS, permuted, unit_samples


def sobol(dimensions: int, seed: int) -> qmc.Sobol:
    options: dict[str, Any] = {"scramble": True, "bits": 30, "seed": np.random.default_rng(seed)}
    return qmc.Sobol(dimensions, **options)


@pytest.mark.parametrize("method", METHODS)
def test_any_stretch_is_a_part_of_the_whole(method):
    whole = unit_samples(method, 5, 1000, 6, 0, 1000)
    assert whole.shape == (1000, 6)
    assert (whole >= 0).all()
    assert (whole < 1).all()
    for start, stop in ((0, 1), (1, 2), (17, 300), (511, 513), (999, 1000), (4, 4)):
        assert np.array_equal(unit_samples(method, 5, 1000, 6, start, stop), whole[start:stop])


@pytest.mark.parametrize("method", METHODS)
def test_seeds_differ_and_repeat(method):
    one, same, other = (unit_samples(method, seed, 64, 3, 0, 64) for seed in (1, 1, 2))
    assert np.array_equal(one, same)
    assert not np.any(one == other)


@pytest.mark.parametrize("dimensions", [1, 4, 21])
def test_sobol_is_scipys(dimensions):
    engine = sobol(dimensions, 9)
    expected = engine.random(4096)
    assert np.array_equal(unit_samples("sobol", 9, 4096, dimensions, 0, 4096), expected)


def test_a_late_stretch_of_a_long_sobol_sequence():
    engine = sobol(2, 0)
    engine.fast_forward(1_000_003)
    assert np.array_equal(unit_samples("sobol", 0, 2**21, 2, 1_000_003, 1_000_013), engine.random(10))


@pytest.mark.parametrize("count", [1, 2, 7, 64, 1000])
def test_latin_hypercube_has_one_sample_in_every_strip(count):
    u = unit_samples("latin_hypercube", 3, count, 5, 0, count)
    assert np.array_equal(
        np.sort(np.floor(u * count), axis=0), np.repeat(np.arange(count)[:, None], 5, axis=1)
    )


def test_latin_hypercube_dimensions_are_not_alike():
    u = unit_samples("latin_hypercube", 3, 20_000, 4, 0, 20_000)
    apart = np.corrcoef(u.T) - np.eye(4)
    assert np.abs(apart).max() < 5 / np.sqrt(20_000)
    assert kstest(u[:5000, 0], "uniform").pvalue > 1e-3  # a stretch of it is spread, too


@pytest.mark.parametrize("count", [1, 2, 3, 5, 16, 17, 255, 1000])
def test_a_permutation_has_everything_once(count):
    assert sorted(permuted(np.arange(count), count, 4)) == list(range(count))


def test_random_samples_are_uniform_and_independent():
    u = unit_samples("random", 8, 50_000, 3, 0, 50_000)
    assert all(kstest(column, "uniform").pvalue > 1e-3 for column in u.T)
    assert np.abs(np.corrcoef(u.T) - np.eye(3)).max() < 5 / np.sqrt(50_000)
    assert abs(np.corrcoef(u[1:, 0], u[:-1, 0])[0, 1]) < 5 / np.sqrt(50_000)
