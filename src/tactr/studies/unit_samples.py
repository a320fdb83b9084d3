"""Numbers in [0, 1) for any range of samples: a pure function of method, seed, count and indices.

Whoever computes the samples from 4000 to 5000 gets what one run over all of them would have there.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

METHODS = ("sobol", "random", "latin_hypercube")
MOST_SOBOL_BITS = 30
WORDS = 4  # that one step of Philox's counter gives
GOLDEN = 0x9E3779B97F4A7C15


def unit_samples(method: str, seed: int, count: int, dimensions: int, start: int, stop: int) -> np.ndarray:
    """Samples start to stop of count, (stop - start, dimensions)."""
    if dimensions == 0:
        return np.empty((stop - start, 0))
    if method == "sobol":
        return _sobol(seed, count, dimensions, np.arange(start, stop))
    if method == "random":
        return _random(seed, dimensions, start, stop)
    return _latin_hypercube(seed, count, dimensions, start, stop)


def _random(seed: int, dimensions: int, start: int, stop: int) -> np.ndarray:
    """Independent and uniform: Philox, a generator that counts (Salmon et al., SC11), so that any sample can
    be had without those before it."""
    steps = -(-dimensions // WORDS)
    numbers = np.random.Generator(np.random.Philox(key=seed).advance(start * steps))
    return numbers.random((stop - start, steps * WORDS))[:, :dimensions]


def _latin_hypercube(seed: int, count: int, dimensions: int, start: int, stop: int) -> np.ndarray:
    """In every dimension one sample in each of count equal strips, at random within it; which strip a sample
    gets is a permutation that differs from dimension to dimension."""
    within = _random(seed, dimensions, start, stop)
    strips = [permuted(np.arange(start, stop), count, seed * dimensions + k) for k in range(dimensions)]
    return np.minimum((np.stack(strips, axis=1) + within) / count, np.nextafter(1.0, 0.0))


def permuted(indices: np.ndarray, count: int, key: int) -> np.ndarray:
    """Where a permutation of 0 ... count - 1 takes these, without holding the whole of it: a Feistel network
    on the next power of four, walked until inside (Black and Rogaway, CT-RSA 2002)."""
    half = np.uint64(max(1, -(-(count - 1).bit_length() // 2)))
    keys = np.random.Philox(key=(1 << 64) + key).random_raw(6)  # not a key of _random
    result = _feistel(indices.astype(np.uint64), half, keys)
    while (outside := result >= count).any():
        result[outside] = _feistel(result[outside], half, keys)
    return result.astype(np.int64)


def _feistel(x: np.ndarray, half: np.uint64, keys: np.ndarray) -> np.ndarray:
    mask = np.uint64((1 << int(half)) - 1)
    left, right = x >> half, x & mask
    for key in keys:
        left, right = right, left ^ (_mixed(right ^ key) & mask)
    return (left << half) | right


def _mixed(x: np.ndarray) -> np.ndarray:
    """splitmix64's finaliser (Steele, Lea, Flood, OOPSLA 2014)."""
    x = x + np.uint64(GOLDEN)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


def _sobol(seed: int, count: int, dimensions: int, indices: np.ndarray) -> np.ndarray:
    """Sobol's sequence, scrambled. Point n is the first one with those directions added, bit by bit without
    carry, that belong to the ones of the Gray code of n."""
    first, directions = _sobol_directions(seed, max(1, (count - 1).bit_length()), dimensions)
    points = np.tile(first, (len(indices), 1))
    gray = indices ^ (indices >> 1)
    for bit, direction in enumerate(directions):
        points[(gray >> bit) & 1 == 1] ^= direction
    return points / 2.0**MOST_SOBOL_BITS


@lru_cache(maxsize=8)
def _sobol_directions(seed: int, bits: int, dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """The first point (dimensions,) and the direction of each bit (bits, dimensions) as whole numbers, read
    off scipy's sequence: the Gray code of 2^(k+1) - 1 is the bit k alone."""
    from scipy.stats import qmc

    options: dict[str, Any] = {"scramble": True, "bits": MOST_SOBOL_BITS, "seed": np.random.default_rng(seed)}
    engine = qmc.Sobol(dimensions, **options)
    points = [engine.random(1)[0]]
    for bit in range(bits):
        engine.fast_forward(2 ** (bit + 1) - 1 - engine.num_generated)
        points.append(engine.random(1)[0])
    whole = np.rint(np.array(points) * 2.0**MOST_SOBOL_BITS).astype(np.int64)
    return whole[0], whole[1:] ^ whole[0]
