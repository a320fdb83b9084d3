"""Tendons that end early, share a channel or change their host, against the published model by SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, PointLoad, Robot, Straight, Tendon, Tube
from tactr.materials import nitinol
from tactr.robot import Routing
from tactr.robot.tendon import Host

CHANNEL = Straight(0.004, 0.002)


def tubes(twist: float = 0.0) -> list[Tube]:
    """twist: rest twist (1/m) of the inner tube, also rotated, so that they are turned where one ends."""
    return [
        Tube("outer", length=0.1, section=Annulus(0.0018, 0.0014), material=nitinol, precurvature=(0, 4, 0)),
        Tube("inner", length=0.16, section=Annulus(0.0012, 0.0009), material=nitinol,
             precurvature=(5, 0, twist), rotation=0.1 * twist),
    ]  # fmt: skip


def agrees(robot: Robot) -> None:
    shape = tactr.solve(robot, tolerance=1e-10)
    assert shape.converged, shape.message
    base = [tube.u[0] for tube in shape.tubes], [tube.v[0] for tube in shape.tubes]
    printed = tactr.reference.solve(robot, stations=2, guess=(np.array(base[0]), np.array(base[1])))
    np.testing.assert_allclose(shape.tip_position, printed.tip, rtol=0.0, atol=2e-8)


@pytest.mark.parametrize("host", ["own", "outermost"])
@pytest.mark.parametrize("end", [0.06, 0.13])
@pytest.mark.parametrize("routing", [CHANNEL, Helix(0.004, 25.0)], ids=["straight", "helix"])
def test_ends_before_the_tip(host: Host, end: float, routing: Routing) -> None:
    tendons = [
        Tendon("a", "inner", routing, host=host, tension=1.0, end=end),
        Tendon("b", "outer", Straight(0.0, 0.005), tension=0.8, end=0.07),
    ]
    agrees(Robot(tubes(5.0), tendons))


@pytest.mark.parametrize("host", ["own", "outermost"])
def test_several_on_one_channel(host: Host) -> None:
    tendons = [
        Tendon(str(k), "inner", CHANNEL, host=host, tension=tension, end=end)
        for k, (tension, end) in enumerate([(0.5, 0.05), (0.9, 0.12), (0.4, 0.12), (0.6, None)])
    ]
    robot = Robot(tubes(5.0), tendons)
    agrees(robot)
    joined = [tendons[0], Tendon("12", "inner", CHANNEL, host=host, tension=1.3, end=0.12), tendons[3]]
    np.testing.assert_allclose(
        tactr.solve(robot, tolerance=1e-10).tip_position,
        tactr.solve(robot.replace(tendons=joined), tolerance=1e-10).tip_position,
        rtol=0.0,
        atol=1e-10,
    )


@pytest.mark.parametrize("twist", [0.0, 8.0, -15.0])
@pytest.mark.parametrize(
    "loads", [(), (PointLoad("inner", force=(0.03, -0.02, 0.01)),)], ids=["free", "loaded"]
)
def test_host_changes_between_turned_tubes(twist: float, loads: tuple[PointLoad, ...]) -> None:
    """The route is that of the host of each section, so it jumps sideways where the hosts are turned; the
    pull beyond passes to the outer tube's end as it is, lambda t with its moment about the axis."""
    tendons = [Tendon("t", "inner", Helix(0.004, 12.0), host="outermost", tension=1.2)]
    robot = Robot(tubes(twist), tendons, loads)
    if twist:
        assert abs(tactr.solve(robot).sample([0.0999999]).theta[1, 0]) > 0.2
    agrees(robot)


@pytest.mark.parametrize("twist", [0.0, 8.0])
def test_what_the_host_leaves_the_inner_tube_does_not_feel(twist: float) -> None:
    """Across the change of host the inner tube's elastic axial force and torque go on; the end of the outer
    one has the tendon's lambda t_3 and lambda (r x t)_3 of the far side, read in the inner tube's frame."""
    tension, helix, step = 1.2, Helix(0.004, 12.0), 1e-9
    robot = Robot(tubes(twist), [Tendon("t", "inner", helix, host="outermost", tension=tension)])
    outer, inner = tactr.solve(robot, tolerance=1e-11).sample([0.1 - step, 0.1 + step]).tubes
    np.testing.assert_allclose(inner.n[1, 2], inner.n[0, 2], rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(inner.m[1, 2], inner.m[0, 2], rtol=0.0, atol=1e-9)

    def pull(u: np.ndarray, v: np.ndarray) -> tuple[float, float]:
        xy, slope = helix.evaluate(0.1)
        r = np.append(xy, 0.0)
        q = np.cross(u, r) + np.append(slope, 0.0) + v
        along = tension * q / np.linalg.norm(q)
        return along[2], np.cross(r, along)[2]

    near, far = pull(outer.u[0], outer.v[0]), pull(inner.u[1], inner.v[1])
    assert outer.n[0, 2] + near[0] == pytest.approx(far[0], abs=1e-6)
    assert outer.m[0, 2] + near[1] == pytest.approx(far[1], abs=1e-8)


def test_length_of_tendons_on_one_channel() -> None:
    """Bent to kappa = lambda r / EI before the nearer end, to less beyond."""
    r, near, far = 0.005, 0.06, 0.1
    rod = Tube("rod", length=far, section=Annulus(0.0012, 0.0), material=nitinol)
    tendons = [
        Tendon("near", "rod", Straight(r, 0.0), tension=1.0, end=near),
        Tendon("far", "rod", Straight(r, 0.0), tension=0.7),
    ]
    shape, k = tactr.solve(Robot([rod], tendons)), rod.stiffness
    first = near * (1 - 1.7 / k.EA - r * 1.7 * r / k.EI_y)
    rest = (far - near) * (1 - 0.7 / k.EA - r * 0.7 * r / k.EI_y)
    assert shape.tendons[0].length == pytest.approx(first, rel=1e-10)
    assert shape.tendons[1].length == pytest.approx(first + rest, rel=1e-10)
    turn = (near * 1.7 + (far - near) * 0.7) * r / k.EI_y
    assert math.atan2(*shape.tip_orientation[[0, 2], 2]) == pytest.approx(turn, rel=1e-9)
