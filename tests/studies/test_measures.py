"""Dexterity and stiffness, against matrices and beams where they are known."""

import numpy as np
import pytest

import tactr
from tactr import Robot, Rod, Tube
from tactr.studies import measures

Q, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))


def jacobian(shift, turn=None):
    return np.concatenate([shift, np.zeros_like(shift) if turn is None else turn])[None]


def test_manipulability_is_the_mean_half_axis_of_the_ellipsoid():
    j = jacobian(Q @ np.diag([1.0, 2.0, 4.0]))
    assert measures.manipulability(j) == pytest.approx([2.0])
    det = np.linalg.det(j[0, :3] @ j[0, :3].T)
    assert measures.manipulability(j) ** 3 == pytest.approx([np.sqrt(det)])  # Yoshikawa's measure
    assert measures.isotropy(j) == pytest.approx([0.25])


def test_lost_directions():
    j = jacobian(Q @ np.diag([1.0, 2.0, 0.0]))
    assert measures.manipulability(j)[0] < 1e-5
    assert measures.isotropy(j)[0] == pytest.approx(0.0, abs=1e-12)
    two = jacobian(Q @ np.diag([3.0, 12.0, 0.0])[:, :2])
    assert measures.manipulability(two) == pytest.approx([6.0])


def test_condition_weighs_rotations_by_a_length():
    j = jacobian(np.hstack([np.eye(3), np.zeros((3, 3))]), np.hstack([np.zeros((3, 3)), 10.0 * np.eye(3)]))
    assert measures.condition(j, 0.1) == pytest.approx([1.0])
    assert measures.condition(j, 1.0) == pytest.approx([10.0])


def test_actuators_count_by_their_range():
    j = jacobian(np.eye(3))
    assert measures.manipulability(measures.strokes(j, np.array([1.0, 2.0, 4.0]))) == pytest.approx([2.0])


def test_rows_without_a_shape_stay_empty():
    j = np.concatenate([jacobian(np.eye(3)), np.full((1, 6, 3), np.nan)])
    assert measures.manipulability(j)[0] == pytest.approx(1.0)
    assert np.isnan(measures.manipulability(j)[1])
    assert np.isnan(measures.tip_stiffness(np.full((1, 6, 6), np.nan)))[0]


def test_the_tip_of_a_cantilever_is_as_stiff_as_in_the_books():
    """3 EI / L^3, and shear and stretch that hardly matter for a thin rod."""
    material = tactr.Material(E=60e9, nu=0.3)
    rod = Robot([Tube("rod", length=0.1, section=Rod(1e-3), material=material)])
    compliance = tactr.solve(rod).compliance()[None]
    expected = 3 * 60e9 * np.pi * 1e-12 / 64 / 0.1**3
    assert measures.tip_stiffness(compliance) == pytest.approx([expected], rel=1e-3)
