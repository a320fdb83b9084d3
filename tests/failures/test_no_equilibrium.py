"""Robots without a shape: the solve returns, says what happened and what to do, and gives no geometry."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

import tactr
from tactr import (
    Annulus,
    DistributedLoad,
    Helix,
    Material,
    NotConverged,
    PointLoad,
    Robot,
    Rod,
    Straight,
    Tendon,
    Tube,
)
from tactr.materials import nitinol
from tactr.statics import Shape, Status
from tactr.statics.stability import stability_of

SOFT = Material(E=1e5, nu=0.45)


def rod(
    tension: float, *loads: PointLoad | DistributedLoad, material: Material = nitinol, **routing: Any
) -> Robot:
    tube = Tube("rod", length=0.2, section=Rod(0.001), material=material)
    tendons = [Tendon("t", "rod", routing.get("routing", Straight(0.005, 0.0)), tension=tension)]
    return Robot([tube], tendons if tension else [], loads)


def two_tubes(tension: float) -> Robot:
    tubes = [
        Tube("outer", length=0.1, section=Annulus(0.0014, 0.0011), material=nitinol, precurvature=(4, 0, 0)),
        Tube("inner", length=0.2, section=Annulus(0.001, 0.0007), material=nitinol, precurvature=(0, 6, 0)),
    ]
    return Robot(tubes, [Tendon("t", "inner", Helix(0.005, 20.0), host="outermost", tension=tension)])


IMPOSSIBLE: dict[str, Callable[[], Robot]] = {
    "huge tension": lambda: rod(1e4),
    "absurd tension": lambda: rod(1e9),
    "huge tension of a helix": lambda: rod(1e5, routing=Helix(0.005, 30.0)),
    "huge tension on two tubes": lambda: two_tubes(1e5),
    "soft tube, metal's tension": lambda: rod(5.0, material=SOFT),
    "huge force on a pulled rod": lambda: rod(1.0, PointLoad("rod", force=(1e6, 0.0, 0.0))),
    "crushing force": lambda: rod(0.0, PointLoad("rod", force=(0.0, 0.0, -1e7))),
    "huge moment": lambda: rod(0.0, PointLoad("rod", moment=(1e6, 0.0, 1e6), force=(1e6, 1e5, 0.0))),
    "huge load along the rod": lambda: rod(1.0, DistributedLoad(force=(1e7, -1e7, 0.0), axes="body")),
}


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_no_shape_but_an_explanation(name: str) -> None:
    shape = tactr.solve(IMPOSSIBLE[name]())
    assert not shape.converged
    assert shape.status is not Status.CONVERGED
    assert any(word in shape.message for word in ("tension", "load")) and "check" in shape.message
    assert not math.isnan(shape.residual) and not math.isnan(shape.discretisation_error)
    assert shape.status.value in repr(shape) and "nan" not in repr(shape)
    assert shape.solve_time < 20.0


GEOMETRY: dict[str, Callable[[Shape], object]] = {
    "tip_position": lambda shape: shape.tip_position,
    "tip_quaternion": lambda shape: shape.tip_quaternion,
    "tip_orientation": lambda shape: shape.tip_orientation,
    "tip_jacobian": lambda shape: shape.tip_jacobian(),
    "centreline": lambda shape: shape.centreline,
    "theta": lambda shape: shape.theta,
    "tubes": lambda shape: shape.tubes,
    "tendons": lambda shape: shape.tendons,
    "transition_points": lambda shape: shape.transition_points,
    "sample": lambda shape: shape.sample(5),
}


@pytest.fixture(scope="module")
def failed() -> Shape:
    """A shape that did not converge."""
    return tactr.solve(rod(1e4))


@pytest.mark.parametrize("name", GEOMETRY)
def test_geometry_raises(failed: Shape, name: str) -> None:
    with pytest.raises(NotConverged) as caught:
        GEOMETRY[name](failed)
    assert caught.value.shape is failed
    assert str(caught.value) == failed.message


def test_what_is_no_geometry_can_be_read(failed: Shape) -> None:
    assert failed.robot.tendons[0].tension == 1e4
    assert failed.s.shape == (101,)
    assert failed.iterations >= 0


@pytest.mark.parametrize("tension", [300.0, 1e3, 1e6])
def test_a_huge_tension_is_named_as_the_cause(tension: float) -> None:
    shape = tactr.solve(rod(tension))
    assert shape.status in (Status.KINKED, Status.COLLAPSED)
    assert "tension" in shape.message and "unit" in shape.message


def test_a_soft_tube_under_a_fitting_tension_has_a_shape() -> None:
    assert tactr.solve(rod(1e-6, material=SOFT)).converged


@pytest.mark.parametrize("tension", [60.0, 80.0, 87.0])
def test_a_bend_short_of_the_tendons_offset_is_found(tension: float) -> None:
    """The rod closes several circles; the curvature is T r / EI, up to 1 / r at 88.36 N."""
    shape = tactr.solve(rod(tension))
    k = shape.robot.tubes[0].stiffness
    assert shape.converged, shape.message
    assert shape.tubes[0].u[:, 1] == pytest.approx(tension * 0.005 / k.EI_y, rel=1e-6)


def test_the_tube_is_crushed() -> None:
    shape = tactr.solve(rod(0.0, PointLoad("rod", force=(0.0, 0.0, -0.95 * 75e9 * math.pi * 0.0005**2))))
    assert not shape.converged


def test_stability_where_no_section_beside_has_an_equilibrium() -> None:
    """The free end of a sound rod, under a load that crushes it: the kernel's Jacobi field is not found."""
    sound = tactr.solve(rod(1.0))
    crushed = tactr.Prepared(rod(1.0, PointLoad("rod", force=(0.0, 0.0, -1e7))))
    stability = stability_of(crushed._core, sound._solution)
    assert not stability.known and not stability.stable and not stability.near_limit
    assert math.isnan(stability.margin) and stability.s.size == stability.conjugate_points.size == 0
    assert "not known" in str(stability) and "not known" in repr(stability)
    assert sound.stability.known


def test_another_solve_after_a_failure() -> None:
    prepared = tactr.Prepared(rod(1.0))
    before = prepared.solve().tip_position
    assert not prepared.solve(tension=[1e6]).converged
    assert (prepared.solve().tip_position == before).all()


def test_a_robot_that_hangs_like_a_string_says_so() -> None:
    """At 2000 EI/L^2 the base answers the free end cosh(sqrt(2000)) = 1e19 times over."""
    EI = rod(0.0).tubes[0].stiffness.EI_x
    shape = tactr.solve(rod(0.0, PointLoad("rod", force=(2000.0 * EI / 0.2**2, 0.0, 0.0))))
    assert shape.status is Status.TOO_SENSITIVE
    assert "double precision" in shape.message and "EI/L^2" in shape.message and "check" in shape.message
