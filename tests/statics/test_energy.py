"""Energies and actuator forces against closed forms and differences of the energy."""

from __future__ import annotations

import numpy as np
import pytest

import tactr
from tactr import (
    Annulus,
    DistributedLoad,
    Gravity,
    Helix,
    Material,
    NotConverged,
    PointLoad,
    Robot,
    RobotError,
    Stiffness,
    Straight,
    Tendon,
    Tube,
)
from tactr.statics import Shape
from tactr.statics.solve import Prepared

EI, EA, GJ = 5e-3, 2e4, 4e-3
LENGTH, BEHIND = 0.2, 0.05


def stiffness(scale: float = 1.0, stretch: float = 1.0) -> Stiffness:
    """stretch: how much stiffer than metal against shear and stretch."""
    return Stiffness(
        EA=EA * stretch,
        GA=8e3 * stretch,
        EI_x=EI * scale,
        EI_y=EI * scale,
        GJ=GJ * scale,
        linear_density=0.02,
    )


def rod(**options) -> Tube:
    return Tube("rod", **({"length": LENGTH, "section": stiffness(), "translation": -BEHIND} | options))


def test_a_tendon_at_an_offset() -> None:
    """Outside: curvature lambda r / EI and compression lambda / EA; in the guide compression alone."""
    tension, r = 4.0, 0.006
    shape = tactr.solve(Robot([rod()], [Tendon("t", "rod", Straight(r, 0.0), tension=tension)]))
    out = LENGTH - BEHIND
    expected = 0.5 * (tension * r) ** 2 / EI * out + 0.5 * tension**2 / EA * LENGTH
    assert shape.energy == pytest.approx(expected, rel=1e-12)
    # a bent rod is driven out of its guide by M^2 / (2 EI) (Bigoni et al. 2015)
    force = shape.actuator_forces
    assert force.force[0] == pytest.approx(-0.5 * (tension * r) ** 2 / EI, rel=1e-12)
    assert force.torque[0] == pytest.approx(0.0, abs=1e-15) and force.tension[0] == tension


def test_a_precurved_rod_pays_for_the_part_in_the_guide() -> None:
    """It is straight there at (k EI) k / 2 per length, at rest outside: pushed out it gives that back."""
    k = 9.0
    shape = tactr.solve(Robot([rod(precurvature=(k, 0.0, 0.0))]))
    assert shape.energy == pytest.approx(0.5 * EI * k**2 * BEHIND, rel=1e-12)
    assert shape.actuator_forces.force[0] == pytest.approx(-0.5 * EI * k**2, rel=1e-12)


def test_twist_by_a_moment_at_the_tip() -> None:
    moment = 2e-3
    shape = tactr.solve(Robot([rod()], loads=[PointLoad("rod", moment=(0.0, 0.0, moment))]))
    assert shape.energy == pytest.approx(0.5 * moment**2 / GJ * LENGTH, rel=1e-12)
    assert shape.actuator_forces.torque[0] == pytest.approx(-moment, rel=1e-12)


@pytest.mark.parametrize("translation", [0.0, -BEHIND])
def test_an_axial_load_is_pushed_out(translation: float) -> None:
    force = 0.2  # below the buckling load pi^2 EI / (2 L)^2
    shape = tactr.solve(Robot([rod(translation=translation)], loads=[PointLoad("rod", force=(0, 0, -force))]))
    out = LENGTH + translation
    assert shape.energy == pytest.approx(0.5 * force**2 / EA * LENGTH, rel=1e-9)
    assert shape.load_potential == pytest.approx(force * out * (1 - force / EA), rel=1e-9)
    assert shape.actuator_forces.force[0] == pytest.approx(force * (1 - force / EA), rel=1e-9)


def test_weight_counts_from_the_exit() -> None:
    shape = tactr.solve(Robot([rod()], loads=[Gravity((0.0, 0.0, -9.81))]))
    middle = (LENGTH - 2 * BEHIND) / 2
    assert shape.load_potential == pytest.approx(0.02 * 9.81 * LENGTH * middle, rel=1e-4)
    assert shape.actuator_forces.force[0] == pytest.approx(0.02 * 9.81 * LENGTH, rel=1e-4)


def pair(stretch: float, translation: tuple[float, float]) -> Robot:
    """Jumps of all kinds on both tubes, no two at one place; a helical tendon on each."""
    tubes = [
        Tube("outer", length=0.12, section=stiffness(1.0, stretch),
             precurvature=[(0, (0, 0, 0)), (0.045, (4, 2, 1))], translation=translation[0], rotation=0.3),
        Tube("inner", length=0.2, section=stiffness(0.5, stretch),
             precurvature=[(0, (0, 3, 0)), (0.11, (0, 9, 2))], translation=translation[1], rotation=-0.9),
    ]  # fmt: skip
    tendons = [
        Tendon("a", "outer", Helix(0.006, 12.0), tension=1.5, end=0.1),
        Tendon("b", "inner", Helix(0.003, -9.0), tension=2.0),
    ]
    loads = [
        PointLoad("inner", force=(0.05, 0.02, -0.04)),
        PointLoad("outer", force=(0.0, 0.05, 0.03), at=0.07),
        DistributedLoad("inner", force=(0.0, 0.2, 0.1), start=0.06, end=0.15),
        Gravity((3.0, 0.0, -9.0)),
    ]
    return Robot(tubes, tendons, loads)


def potential(shape: Shape) -> float:
    """Whose derivatives the actuator forces are: strain energy, loads, and tension times length."""
    assert shape.converged, shape.message
    lengths = sum(t.length * f for t, f in zip(shape.tendons, shape.actuator_forces.tension, strict=True))
    return shape.energy + shape.load_potential + lengths


def slope(robot: Robot, field: str, i: int, step: float) -> float:
    """Central differences; one-sided of second order where a tube cannot move further out."""
    at = [getattr(tube, field) for tube in robot.tubes]

    def moved(by: float) -> float:
        places = [place + by * (j == i) for j, place in enumerate(at)]
        actuated = robot.with_actuation(**{field: places})
        return potential(tactr.solve(actuated, tolerance=1e-11))

    if field == "translation" and at[i] == 0.0:
        return (3 * moved(0.0) - 4 * moved(-step) + moved(-2 * step)) / (2 * step)
    return (moved(step) - moved(-step)) / (2 * step)


@pytest.mark.parametrize("translation", [(-0.02, -0.05), (0.0, 0.0), (0.0, -0.05)])
def test_forces_are_the_slopes_of_the_energy(translation: tuple[float, float]) -> None:
    """With tubes that hardly stretch: the drift of tubes along each other is not in the model."""
    robot = pair(1e3, translation)
    found = tactr.solve(robot, tolerance=1e-11).actuator_forces
    for i in range(2):
        assert slope(robot, "rotation", i, 1e-3) == pytest.approx(found.torque[i], rel=1e-6, abs=1e-9)
        assert slope(robot, "translation", i, 1e-5) == pytest.approx(found.force[i], rel=3e-5)


def test_metal_tubes_are_near_that() -> None:
    robot = pair(1.0, (-0.02, -0.05))
    found = tactr.solve(robot, tolerance=1e-11).actuator_forces
    for i in range(2):
        assert slope(robot, "rotation", i, 1e-3) == pytest.approx(found.torque[i], rel=1e-4)
        assert slope(robot, "translation", i, 1e-5) == pytest.approx(found.force[i], rel=1e-3)


def test_lengths_are_the_slopes_by_tension() -> None:
    robot = pair(1.0, (-0.02, -0.05))
    for j, tendon in enumerate(tactr.solve(robot, tolerance=1e-11).tendons):
        ends = [
            potential(tactr.solve(robot, tolerance=1e-11, tension={tendon.name: tendon.tension[0] + step}))
            for step in (1e-3, -1e-3)
        ]
        assert (ends[0] - ends[1]) / 2e-3 == pytest.approx(tendon.length, rel=2e-6), j


@pytest.mark.parametrize(
    ("load", "field"),
    [
        (PointLoad("rod", force=(0.1, 0.0, 0.0), axes="body"), "loads[0].axes"),
        (DistributedLoad("rod", moment=(0.001, 0.0, 0.0)), "loads[0].moment"),
    ],
)
def test_loads_without_a_potential(load, field: str) -> None:
    shape = tactr.solve(Robot([rod()], loads=[load]))
    with pytest.raises(RobotError) as caught:
        _ = shape.load_potential
    assert caught.value.field == field
    assert shape.energy > 0.0


def test_no_shape_no_forces() -> None:
    shape = tactr.solve(Robot([rod()], [Tendon("t", "rod", Straight(0.006, 0.0), tension=1e9)]))
    for name in ("energy", "tube_energy", "load_potential", "actuator_forces", "contacts", "guide_reaction"):
        with pytest.raises(NotConverged):
            getattr(shape, name)


def test_one_tube_has_no_contact_but_a_guide() -> None:
    shape = tactr.solve(Robot([rod()], loads=[PointLoad("rod", force=(0.1, 0.0, 0.0))]))
    assert shape.contacts == ()
    np.testing.assert_allclose(shape.guide_reaction.force, (-0.1, 0.0, 0.0), atol=1e-9)
    np.testing.assert_allclose(shape.guide_reaction.moment[1], -0.1 * shape.tip_position[2], rtol=1e-6)


@pytest.mark.parametrize("gap", [3e-9, 2e-9, 1e-9, 5e-10, 3e-10, 1e-10])
def test_sections_of_nanometres_have_their_forces(gap):
    """In steps taken over from where they were longer, whose ends miss the section's by rounding."""
    assert forces_of_a_gap(gap) == pytest.approx(forces_of_a_gap(1e-7), rel=1e-5)


def forces_of_a_gap(gap: float) -> np.ndarray:
    """Of two tubes that bend from places on that lie so far apart; between them numbers get coarser."""
    place, straight = 0.0625 - 0.6 * gap, (0.0, (0.0, 0.0, 0.0))
    metal, bent = Material(E=60e9, nu=0.3), ((place, (3.0, 0.0, 0.0)), (place + gap + 0.05, (0.0, 5.0, 0.0)))
    outer, inner = (
        Tube(
            name, length=length, section=Annulus(d, d - 0.4e-3), material=metal, precurvature=(straight, rest)
        )
        for name, length, d, rest in zip(("outer", "inner"), (0.13, 0.2), (2e-3, 1.2e-3), bent, strict=True)
    )
    pull = Tendon("pull", "inner", Straight(0, 3e-3), host="own", tension=4.0)
    prepared = Prepared(Robot([outer, inner], [pull]), tolerance=1e-13)
    far = prepared.solve(rotation=[0.0, 1.0], translation=[0.0, -0.002])
    return prepared.solve(rotation=[0.0, 1.0], translation=[0.0, -0.05], guess=far).actuator_forces.force
