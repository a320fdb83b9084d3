"""Tendons pulled by displacements against closed forms.

Straight tendons at offsets r_j on one straight rod lie along its axis wherever it bends in a plane: at
tensions T the rod bends with the moment sum T_j r_j and shortens with the force sum T_j, uniformly, so that
tendon i shortens by sum_j G_ij T_j with G_ij = L / EA + r_i . r_j L / EI, exactly. With displacements d the
tensions solve the linear complementarity problem T >= 0, (G + C) T - d >= 0, T ((G + C) T - d) = 0; its
solution is found here by trying all sets of slack tendons.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import tactr
from tactr import Material, Robot, Rod, Straight, Tendon, Tube

L, R, DIAMETER, E = 0.2, 5e-3, 1e-3, 60e9
EA, EI = E * math.pi * DIAMETER**2 / 4, E * math.pi * DIAMETER**4 / 64
ROD = Tube("rod", length=L, section=Rod(DIAMETER), material=Material(E=E, nu=0.3))


def robot(angles, compliance=(), pretension=0.0, **rod):
    springs = compliance or [0.0] * len(angles)
    tendons = [
        Tendon(f"t{k}", "rod", Straight.polar(R, angle), compliance=c, pretension=pretension)
        for k, (angle, c) in enumerate(zip(angles, springs, strict=True))
    ]
    return Robot([ROD], tendons)


def tensions(angles, compliance, displacement):
    """By trying all sets of taut tendons, the larger first: where several fit, they bend the rod alike."""
    n = len(angles)
    G = L / EA + L / EI * R**2 * np.cos(np.subtract.outer(angles, angles)) + np.diag(compliance)
    for count in range(n, -1, -1):
        for taut in itertools.combinations(range(n), count):
            T, taut = np.zeros(n), list(taut)
            if taut:
                T[taut] = np.linalg.solve(G[np.ix_(taut, taut)], displacement[taut])
            gap = G @ T - displacement
            if (T >= 0.0).all() and (np.delete(gap, taut) >= -1e-15).all():
                return T
    raise AssertionError("a monotone complementarity problem has a solution")


@pytest.mark.parametrize("compliance", [0.0, 1e-4, 2e-3])
@pytest.mark.parametrize("displacement", [1e-5, 2e-3, 0.012])
def test_one_tendon(displacement, compliance):
    shape = tactr.solve(robot([0.0], [compliance]), displacement={"t0": displacement})
    tension = displacement / (L / EA + L * R**2 / EI + compliance)
    assert shape.converged, shape.message
    assert shape.tension[0] == pytest.approx(tension, rel=1e-6)
    curvature, stretch = tension * R / EI, 1.0 - tension / EA
    x = (1.0 - math.cos(curvature * L)) / curvature * stretch
    assert shape.tip_position[0] == pytest.approx(x, abs=2e-6)
    assert shape.tendons[0].length == pytest.approx(L - displacement + compliance * tension, abs=1e-7)


PAIR = np.array([0.0, math.pi])
TRIPLE = 2.0 * math.pi / 3.0 * np.arange(3)


@pytest.mark.parametrize("compliance", [0.0, 1e-5, 1e-3])
@pytest.mark.parametrize(
    "displacement",
    [(1e-3, -1e-3), (1e-3, -9e-4), (1e-3, -2e-3), (-1e-3, 3e-3), (0, 0), (1e-3, 1e-3), (2e-3, 0)],
)
def test_an_antagonistic_pair(displacement, compliance):
    check(PAIR, [compliance] * 2, np.array(displacement, dtype=float))


def test_which_of_the_pair_is_slack():
    share = (L * R**2 / EI - L / EA) / (L / EA + L * R**2 / EI)  # what the other tendon is paid out, per pull
    for factor, slack in ((0.999, ()), (1.001, ("t1",))):
        shape = tactr.solve(robot(PAIR), displacement=[2e-3, -2e-3 * share * factor])
        assert shape.converged
        assert shape.slack == slack
        assert [tendon.slack for tendon in shape.tendons] == [False, bool(slack)]


@pytest.mark.parametrize("compliance", [0.0, 1e-4])
@pytest.mark.parametrize("seed", range(12))
def test_triples(seed, compliance):
    displacement = np.random.default_rng(seed).uniform(-4e-3, 4e-3, 3)
    check(TRIPLE, [compliance] * 3, displacement)


def check(angles, compliance, displacement):
    shape = tactr.solve(robot(angles, compliance), displacement=displacement)
    expected = tensions(angles, compliance, displacement)
    assert shape.converged, shape.message
    assert shape.tension == pytest.approx(expected, rel=1e-6, abs=0.01 * shape.tolerance / (L / EA))
    assert shape.slack == tuple(f"t{k}" for k in np.flatnonzero(expected == 0.0))


def test_a_stiff_triple_is_as_stiff_as_the_rod():
    for pull in (1e-6, 1e-3):
        shape = tactr.solve(robot(TRIPLE), displacement=[pull] * 3)
        assert shape.converged
        assert shape.tension == pytest.approx([pull * EA / L / 3.0] * 3, rel=1e-2 if pull < 1e-5 else 1e-5)


def test_pretension_is_what_they_carry_at_zero_displacement():
    pretensioned = robot(TRIPLE, [1e-4] * 3, pretension=2.0)
    shape = tactr.solve(pretensioned, displacement=[0.0] * 3)
    assert shape.tension == pytest.approx([2.0] * 3, abs=1e-4)
    pull = np.array([1e-3, -0.5e-3, -0.5e-3])
    rise = pull / (1.5 * L * R**2 / EI + 1e-4)  # G (1, -1/2, -1/2) = 3/2 r^2 L / EI of it
    assert tactr.solve(pretensioned, displacement=pull).tension == pytest.approx(2.0 + rise, abs=1e-4)


def test_many_tendons_without_compliance_are_not_told_apart_but_bend_the_rod_as_the_fewer_do():
    angles = math.pi / 3.0 * np.arange(6)
    pull = 1e-3 * np.cos(angles)
    shape = tactr.solve(robot(angles), displacement=pull)
    assert shape.converged, shape.message
    T = shape.tension
    moment = np.array([T @ np.cos(angles), T @ np.sin(angles)]) * R
    assert moment[0] * R * L / EI == pytest.approx(
        1e-3, rel=1e-2
    )  # shortening on the axis is EI / (EA R^2) of it
    assert moment[1] == pytest.approx(0.0, abs=1e-6)
