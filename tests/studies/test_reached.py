"""The volume that points reach, against bodies whose volume is known."""

from itertools import pairwise

import numpy as np
import pytest

from tactr.studies.reached import good_voxel, reached

RNG = np.random.default_rng(0)


def volume_of(points, voxel):
    half = np.arange(len(points)) < len(points) // 2
    return reached([(points, half)], voxel)


def in_a_ring(count):
    """Uniform in a torus of radii 40 and 10 mm: its hull is more than twice as large."""
    out = np.empty((0, 3))
    while len(out) < count:
        p = RNG.uniform([-0.05, -0.05, -0.01], [0.05, 0.05, 0.01], (count, 3))
        out = np.vstack([out, p[(np.hypot(*p[:, :2].T) - 0.04) ** 2 + p[:, 2] ** 2 < 1e-4]])
    return out[:count]


def test_cubes_that_are_all_hit_are_counted_exactly():
    inside = (np.stack(np.meshgrid(*[np.arange(4)] * 3), axis=-1).reshape(-1, 3) + 0.5) * 1e-3
    found = volume_of(np.vstack([inside, inside]) - 2e-3, 1e-3)
    assert found.volume == pytest.approx(64e-9)
    assert found.voxels == 64
    assert found.half == pytest.approx(64e-9)
    assert found.coarse == pytest.approx(64e-9)
    assert found.dimension == pytest.approx(3.0)
    assert found.unseen == 0.0


def test_a_ring_is_not_filled_up():
    exact, surface = 2 * np.pi**2 * 0.04 * 0.01**2, 4 * np.pi**2 * 0.04 * 0.01
    points = in_a_ring(400_000)
    for voxel in (2e-3, 1e-3):
        found = volume_of(points, voxel)
        assert exact < found.volume < exact + voxel * surface  # the rim counts whole
        assert found.is_a_volume
    assert found.volume == pytest.approx(exact, rel=0.2)
    assert found.unseen < 0.05
    assert 0.9 < found.half / found.volume < 1.0


def test_too_few_points_are_told():
    found = volume_of(in_a_ring(2000), 1e-3)
    assert found.unseen > 0.5
    assert found.half < 0.7 * found.volume


def test_the_chance_of_a_new_voxel_is_right():
    points, more = in_a_ring(20_000), in_a_ring(20_000)
    old = {tuple(key) for key in np.floor(points / 2e-3).astype(int)}
    new = np.mean([tuple(key) not in old for key in np.floor(more / 2e-3).astype(int)])
    assert volume_of(points, 2e-3).unseen == pytest.approx(new, abs=0.01)


def test_a_surface_has_no_volume():
    points = RNG.normal(size=(300_000, 3))
    points *= 0.05 / np.linalg.norm(points, axis=1)[:, None]
    found = volume_of(points, 2e-3)
    assert found.dimension == pytest.approx(2.0, abs=0.1)
    assert not found.is_a_volume


def test_blocks_do_not_matter():
    points = in_a_ring(5000)
    half = np.arange(5000) < 2500
    cuts = [0, 1, 700, 700, 4000, 5000]
    blocks = [(points[a:b], half[a:b]) for a, b in pairwise(cuts)]
    assert reached(blocks, 1e-3) == reached([(points, half)], 1e-3)


def test_a_chosen_edge_holds_several_points():
    points = in_a_ring(50_000)
    edge = good_voxel(points)
    found = volume_of(points, edge)
    assert 5 <= found.tips / found.voxels < 25
    assert good_voxel(points[:1]) > 0
