"""Observed order of the integrator: eighth, on robots with helical tendons and rest curvature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tactr import Annulus, Helix, Material, PointLoad, Robot, Rod, Straight, Tendon, Tube, _core
from tactr.statics import Prepared

NITINOL = Material(E=60e9, G=23e9)
FINE = 40
ROUNDING = 1e-13  # m


def helical_rod() -> Robot:
    rod = Tube("rod", length=0.2, section=Rod(0.0012), material=NITINOL, precurvature=(6.0, -4.0, 5.0))
    tendons = [
        Tendon("helix", "rod", Helix(0.006, 40.0), tension=4.0),
        Tendon("straight", "rod", Straight(0.0, 0.005), tension=1.0),
    ]
    return Robot([rod], tendons, [PointLoad("rod", force=(0.1, 0.05, -0.05))])


def mixed_tubes() -> Robot:
    tubes = [
        Tube(
            "outer",
            length=0.1,
            section=Annulus(0.0014, 0.0011),
            material=NITINOL,
            precurvature=(15.0, 0.0, 0.0),
        ),
        Tube(
            "inner",
            length=0.2,
            section=Annulus(0.001, 0.0007),
            material=NITINOL,
            precurvature=(0.0, 20.0, 0.0),
            rotation=1.3,
        ),
    ]
    tendons = [
        Tendon("helix", "inner", Helix(0.006, 50.0), tension=2.0),
        Tendon("shared", "inner", Helix(0.005, -30.0, 0.4), host="outermost", tension=1.5),
    ]
    return Robot(tubes, tendons)


ROBOTS = {"one helical rod under load": helical_rod, "two tubes that twist": mixed_tubes}


def solved(prepared: Prepared, steps: int) -> _core.Solution:
    """The robot with so many steps in every section, whatever their error."""
    arrays = prepared._tension, prepared._rotation, prepared._translation
    return _core.solve(prepared._core, *arrays, 1e-6, 1e-13, None, steps=steps)


@pytest.mark.parametrize("name", ROBOTS)
def test_eighth_order_and_an_estimate_above_the_error(name: str) -> None:
    prepared = Prepared(ROBOTS[name]())
    exact = solved(prepared, FINE).tip_position
    counts = [2, 3, 4, 6, 8]
    found = [solved(prepared, n) for n in counts]
    errors = [float(np.linalg.norm(solution.tip_position - exact)) for solution in found]
    for n, solution, error in zip(counts, found, errors, strict=True):
        assert solution.discretisation_error >= error - ROUNDING, f"{n} steps"
    clear = [(n, e) for n, e in zip(counts, errors, strict=True) if e > 30 * ROUNDING]
    (n0, e0), (n1, e1) = clear[-3], clear[-1]
    order = math.log(e0 / e1) / math.log(n1 / n0)
    assert order >= 7.5, f"order {order:.2f}, errors {errors}"
