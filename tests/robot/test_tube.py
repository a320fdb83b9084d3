"""Tubes: what is stored, and how precurvature is normalised."""

import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from tactr.materials import nitinol
from tactr.robot import Annulus, Rod, Stiffness, Tube

STRAIGHT = ((0.0, (0.0, 0.0, 0.0)),)


def test_defaults(outer: Tube) -> None:
    assert outer.precurvature == STRAIGHT
    assert (outer.translation, outer.rotation, outer.tip) == (0.0, 0.0, 0.14)
    assert (outer.outer_diameter, outer.inner_diameter) == (0.001, 0.0008)


def test_tip_counts_from_the_guide(outer: Tube) -> None:
    assert replace(outer, translation=-0.05).tip == pytest.approx(0.09)


@pytest.mark.parametrize(
    "given",
    [(0, 10, 0), [0, 10, 0], np.array([0, 10, 0]), [(0, (0, 10, 0))], [[0.0, np.array([0.0, 10.0, 0.0])]]],
)
def test_constant_precurvature(outer: Tube, given: object) -> None:
    assert replace(outer, precurvature=given).precurvature == ((0.0, (0.0, 10.0, 0.0)),)  # type: ignore[arg-type]


def test_piecewise_precurvature(outer: Tube) -> None:
    bent = replace(outer, precurvature=[(0, (0, 0, 0)), (np.float64(0.09), (10, 0, 1))])  # type: ignore[arg-type]
    assert bent.precurvature == ((0.0, (0.0, 0.0, 0.0)), (0.09, (10.0, 0.0, 1.0)))
    assert replace(bent, rotation=1.0).precurvature == bent.precurvature


def test_stiffness_needs_no_material() -> None:
    given = Stiffness(EA=1e4, GA=1e3, EI_x=1e-3, EI_y=2e-3, GJ=1e-3, linear_density=0.01)
    tube = Tube("a", length=0.1, section=given)
    assert tube.stiffness is given
    assert tube.linear_density == 0.01
    assert tube.outer_diameter is None


def test_linear_density(outer: Tube) -> None:
    assert outer.linear_density == pytest.approx(6450 * np.pi / 4 * (1e-6 - 0.64e-6))


def test_immutable_equal_hashable_picklable(outer: Tube) -> None:
    with pytest.raises(FrozenInstanceError):
        outer.length = 0.2  # type: ignore[misc]
    same = Tube("outer", length=0.14, section=Annulus(0.001, 0.0008), material=nitinol)
    assert outer.stiffness is outer.stiffness
    assert same == outer
    assert hash(same) == hash(outer)
    assert pickle.loads(pickle.dumps(outer)) == outer
    assert replace(outer, section=Rod(0.001)) != outer
