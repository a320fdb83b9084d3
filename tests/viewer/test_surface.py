"""Swept surfaces are closed, face outwards, and hold the volume that Pappus' theorem gives."""

import numpy as np
import pytest
import trimesh

from tactr.viewer.surface import SIDES, swept_faces, swept_vertices

OUTER, INNER, LENGTH = 0.8, 0.5, 10.0
# Area of a regular polygon over that of its circle.
SHARE = np.sin(2 * np.pi / SIDES) * SIDES / (2 * np.pi)


def _bend(curvature: float, stations: int) -> tuple[np.ndarray, np.ndarray]:
    """A circular arc in the x-z plane, from the origin along z, with its frames."""
    s = np.linspace(0.0, LENGTH, stations)
    angle = curvature * s
    straight = curvature == 0.0
    x = 0 * s if straight else (1 - np.cos(angle)) / curvature
    z = s if straight else np.sin(angle) / curvature
    zero, one = 0 * s, 0 * s + 1
    d1 = np.stack([np.cos(angle), zero, -np.sin(angle)], axis=-1)
    d2 = np.stack([zero, one, zero], axis=-1)
    d3 = np.stack([np.sin(angle), zero, np.cos(angle)], axis=-1)
    return np.stack([x, zero, z], axis=-1), np.stack([d1, d2, d3], axis=-1)


@pytest.mark.parametrize("inner", [0.0, INNER])
@pytest.mark.parametrize("curvature", [0.0, 0.3])
def test_a_closed_wall_with_the_volume_of_pappus(curvature, inner):
    k = 200
    vertices = swept_vertices(*_bend(curvature, k), np.full(k, OUTER), np.full(k, inner))
    mesh = trimesh.Trimesh(vertices, swept_faces(k))
    mesh.update_faces(mesh.nondegenerate_faces())
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    # chords of the arc are shorter than it by (curvature step)^2 / 24 at most
    assert mesh.volume == pytest.approx(np.pi * (OUTER**2 - inner**2) * SHARE * LENGTH, rel=1e-4)


def test_normals_of_the_outside_point_away_from_the_axis():
    k = 7
    position, frames = _bend(0.0, k)
    vertices = swept_vertices(position, frames, np.full(k, OUTER), np.full(k, INNER))
    corners = vertices[swept_faces(k)]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = corners.mean(axis=1)
    away = np.einsum("ij,ij->i", normal[:, :2], middle[:, :2])
    outside = np.hypot(*middle[:, :2].T) > 0.95 * OUTER
    bore = np.hypot(*middle[:, :2].T) < 1.05 * INNER
    assert outside.sum() == bore.sum() == 2 * SIDES * (k - 1)
    assert (away[outside] > 0).all()
    assert (away[bore] < 0).all()


def test_a_ring_lies_where_the_frame_puts_it():
    position, frames = _bend(0.3, 3)
    vertices = swept_vertices(position, frames, np.array([1.0, 2.0, 3.0]), np.zeros(3), sides=4)
    np.testing.assert_allclose(
        vertices[4:8:2], [position[1] + 2 * frames[1, :, 0], position[1] - 2 * frames[1, :, 0]], atol=1e-12
    )
    np.testing.assert_allclose(vertices[5], position[1] + 2 * frames[1, :, 1], atol=1e-12)
