"""Tubes whose stiffness and rest shape vary along them, against closed forms."""

import math
from typing import Any

import numpy as np
import pytest

import tactr
from tactr import Along, PointLoad, RestShape, Robot, Stiffness, Straight, Tendon, Tube, VaryingStiffness

LENGTH = 0.1
EI = 2e-3
TOLERANCE = 1e-12
STIFF: dict[str, Any] = {"EA": 3e4, "GA": 1.2e4, "EI_x": EI, "EI_y": EI, "GJ": 1.6e-3}


def tube(*, length: float = LENGTH, rest: Any = (0.0, 0.0, 0.0), **changes: Any) -> Tube:
    varies = any(isinstance(q, Along) for q in changes.values())
    section = (VaryingStiffness if varies else Stiffness)(**{**STIFF, **changes})
    return Tube("beam", length=length, section=section, precurvature=rest)


def solved(*tubes: Tube, tendons: Any = (), loads: Any = ()) -> tactr.Shape:
    shape = tactr.solve(Robot(tubes, tendons, loads), tolerance=TOLERANCE)
    assert shape.converged, shape.message
    return shape


def tip_deflection(beam: Tube, force: float = 1e-5) -> float:
    """d(x of the tip)/d(force) for a small force along x."""
    return solved(beam, loads=[PointLoad("beam", force=(force, 0.0, 0.0))]).tip_position[0] / force


def test_linearly_tapered_cantilever() -> None:
    # EI(s) = EI (1 - s/(2L)): w = int (L-s)^2/EI ds = L^3/EI int x^2 2/(1+x) dx = L^3/EI (2 ln 2 - 1); shear
    # adds L/GA
    beam = tube(EI_y=Along.linear([0.0, LENGTH], [EI, EI / 2]))
    expected = LENGTH**3 / EI * (2 * math.log(2) - 1) + LENGTH / STIFF["GA"]
    assert tip_deflection(beam) == pytest.approx(expected, rel=1e-7)


def test_conical_cantilever_from_a_function() -> None:
    # a cone of diameters D to D/2: I = I0 (1 - s/2L)^4, w = F int (L-s)^2 / EI ds = F L^3/(3 EI0) * 2 (D/d)
    material = tactr.Material(E=50e9, G=20e9)
    base = 1e-3
    cone = VaryingStiffness.function(
        lambda s: tactr.Rod(base * (1 - s / (2 * LENGTH))), LENGTH, material=material
    )
    beam = Tube("beam", length=LENGTH, section=cone)
    stiffness = 50e9 * math.pi * base**4 / 64
    bent = LENGTH**3 / (3 * stiffness) * 2
    sheared = 2 * LENGTH / (20e9 * math.pi * base**2 / 4)
    assert tip_deflection(beam) == pytest.approx(bent + sheared, rel=1e-7)
    assert (cone.outer_diameter, cone.inner_diameter) == (base, 0.0)


def test_stepped_cantilever() -> None:
    soft, stiff = Stiffness(**{**STIFF, "EI_y": EI / 3}), Stiffness(**STIFF)
    beam = Tube("beam", length=LENGTH, section=[(0.0, stiff), (0.06, soft)])
    expected = (LENGTH**3 - 0.04**3) / (3 * EI) + 0.04**3 / EI + LENGTH / STIFF["GA"]
    assert tip_deflection(beam) == pytest.approx(expected, rel=1e-7)


def test_stepped_material_stretches_and_twists() -> None:
    one, two = tactr.Material(E=50e9, G=20e9), tactr.Material(E=5e9, G=2e9)
    rod = tactr.Rod(1e-3)
    beam = Tube("beam", length=LENGTH, section=rod, material=[(0.0, one), (0.07, two)])
    shape = solved(beam, loads=[PointLoad("beam", force=(0, 0, 0.1), moment=(0, 0, 1e-3))])
    k, weak = rod.stiffness(one), rod.stiffness(two)
    assert shape.tip_position[2] - LENGTH == pytest.approx(0.1 * (0.07 / k.EA + 0.03 / weak.EA), rel=1e-8)
    d1 = shape.tubes[0].frames[-1][:, 0]
    assert math.atan2(d1[1], d1[0]) == pytest.approx(1e-3 * (0.07 / k.GJ + 0.03 / weak.GJ), rel=1e-8)


def test_fine_steps_converge_to_the_smooth_taper() -> None:
    def stiffness(s: Any) -> Any:
        return EI * np.exp(-8.0 * s)

    pull = [Tendon("pull", "beam", Straight(5e-3, 0.0), tension=2.0)]
    load = [PointLoad("beam", force=(0.0, 0.05, 0.0))]
    smooth = Along.function(stiffness, LENGTH)
    exact = solved(tube(EI_x=smooth, EI_y=smooth), tendons=pull, loads=load).tip_position
    errors = []
    for count in (8, 16, 32):
        starts = np.arange(count) * LENGTH / count
        steps = Along.steps(starts.tolist(), stiffness(starts + LENGTH / (2 * count)))
        found = solved(tube(EI_x=steps, EI_y=steps), tendons=pull, loads=load).tip_position
        errors.append(float(np.linalg.norm(found - exact)))
    # second order: the midpoint rule
    assert errors[0] < 1e-4
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.05)


def test_rest_helix_without_load_is_the_helix() -> None:
    radius, pitch, length = 0.012, 0.05, 0.15
    rise = pitch / (2 * math.pi)
    shape = solved(tube(length=length, rest=RestShape.helix(radius, pitch)))
    s = shape.s
    phase = s / math.hypot(radius, rise)
    axis = np.column_stack((radius * np.cos(phase), radius * np.sin(phase), rise * phase))
    # columns x (binormal), y (minus the normal), z (tangent) of the helix at its start
    c, h = radius / math.hypot(radius, rise), rise / math.hypot(radius, rise)
    frame = np.array([[0.0, 1.0, 0.0], [-h, 0.0, c], [c, 0.0, h]])
    np.testing.assert_allclose(shape.centreline, (axis - axis[0]) @ frame, atol=1e-10)
    np.testing.assert_allclose(shape.tubes[0].m, 0.0, atol=1e-12)


def test_two_precurved_pieces_are_two_arcs() -> None:
    shape = solved(tube(rest=[(0.0, (0.0, 8.0, 0.0)), (0.04, (0.0, -5.0, 0.0))]))
    first, second = 8.0 * 0.04, -5.0 * 0.06
    x = (1 - math.cos(first)) / 8.0 - (math.cos(first + second) - math.cos(first)) / -5.0
    z = math.sin(first) / 8.0 + (math.sin(first + second) - math.sin(first)) / -5.0
    np.testing.assert_allclose(shape.tip_position, (x, 0.0, z), atol=1e-10)


def test_rest_shear_and_stretch() -> None:
    rest = RestShape((0.0, 0.0, 0.0), (0.1, -0.05, Along.linear([0.0, LENGTH], [1.0, 1.2])))
    shape = solved(tube(rest=rest))
    np.testing.assert_allclose(shape.tip_position, (0.1 * LENGTH, -0.05 * LENGTH, 1.1 * LENGTH), atol=1e-10)
    np.testing.assert_allclose(shape.tubes[0].n, 0.0, atol=1e-8)


def test_tendon_pulls_a_tube_with_its_neutral_axis_off_the_centreline() -> None:
    offset, lever, tension = 0.4e-3, -1.1e-3, 3.0
    beam = tube(neutral_axis=(0.0, offset))
    shape = solved(beam, tendons=[Tendon("pull", "beam", Straight(0.0, lever), tension=tension)])
    # a single arc: N = -tension at y = lever about the neutral axis; stretch of the centreline from that of
    # the axis
    curvature = -tension * (lever - offset) / EI
    axis_stretch = -tension / STIFF["EA"]
    found = shape.tubes[0]
    np.testing.assert_allclose(found.u[:, 0], curvature, rtol=1e-9)
    np.testing.assert_allclose(found.u[:, 1:], 0.0, atol=1e-9)
    np.testing.assert_allclose(found.v[:, 2] - 1.0, axis_stretch - curvature * offset, rtol=1e-9)
    np.testing.assert_allclose(found.n[:, 2], -tension, rtol=1e-9)
    np.testing.assert_allclose(found.m[:, 0], -tension * lever, rtol=1e-9)


def test_neutral_axis_in_both_directions_and_turned() -> None:
    axis, pull = np.array([0.3e-3, -0.2e-3]), np.array([0.8e-3, 0.5e-3])
    beam = Tube(
        "beam",
        length=LENGTH,
        section=Stiffness(**{**STIFF, "EI_x": 3 * EI}, neutral_axis=tuple(axis)),
        rotation=0.7,
    )
    shape = solved(beam, tendons=[Tendon("pull", "beam", Straight(*pull), tension=2.0)])
    lever = pull - axis
    np.testing.assert_allclose(shape.tubes[0].u[:, 0], -2.0 * lever[1] / (3 * EI), rtol=1e-9)
    np.testing.assert_allclose(shape.tubes[0].u[:, 1], 2.0 * lever[0] / EI, rtol=1e-9)


def test_wound_neutral_axis_in_two_tubes_balances() -> None:
    """Everything at once converges, and every cut carries what is beyond it."""
    wavy = Along.function(lambda s: 2e-4 * math.cos(60 * s), 0.14)
    taper = Along.linear([0.0, 0.14], [EI, EI / 4])
    inner = Tube(
        "inner",
        length=0.14,
        section=VaryingStiffness(**{**STIFF, "EI_x": taper, "EI_y": taper}, neutral_axis=(wavy, 1e-4)),
        precurvature=RestShape.from_centreline(lambda s: (20 * s**3, 3 * s**2, s - 10 * s**3), 0.14),
        translation=-0.03,
    )
    outer = tube(rest=(6.0, 0.0, 0.0))
    tendons = [Tendon("pull", "inner", Straight(1e-3, 0.0), tension=1.0)]
    force = (0.02, -0.03, 0.01)
    shape = solved(outer, inner, tendons=tendons, loads=[PointLoad("inner", force=force)])
    tip = shape.tubes[1]
    beyond = shape.s > LENGTH + 1e-9
    r = np.array([1e-3, 0.0, 0.0])
    q = np.cross(tip.u, r) + tip.v
    t = q / np.linalg.norm(q, axis=1)[:, None]
    world_force = np.einsum("nij,nj->ni", tip.frames, tip.n + t)
    world_moment = np.einsum("nij,nj->ni", tip.frames, tip.m + np.cross(r, t))
    np.testing.assert_allclose(world_force[beyond], np.tile(force, (beyond.sum(), 1)), atol=1e-7)
    arm = np.cross(shape.tip_position - shape.centreline, force)
    np.testing.assert_allclose(world_moment[beyond], arm[beyond], atol=1e-9)
