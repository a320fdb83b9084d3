"""One tube without loads goes a way of its own, without a march: it has to lead where the march leads."""

import numpy as np
import pytest

import tactr
from tactr import Annulus, Helix, PointLoad, Robot, Straight, Tendon, Tube

from .robots import SOFT

OFF_AXIS, BACK, HELIX = Straight(1.2e-3, 0.5e-3), Straight(-0.3e-3, 1.3e-3), Helix(1.2e-3, 40.0)
SECTION = Annulus(2e-3, 1.6e-3)
TENDONS = {
    "channels": [
        Tendon("a", "tube", OFF_AXIS, friction=[(0.0, 0.1), (0.06, 0.3)]),
        Tendon("b", "tube", HELIX, friction=0.2, end=0.15),
    ],
    "disks": [
        Tendon("a", "tube", OFF_AXIS, friction=0.3, contacts=[0.03, 0.08, 0.15]),
        Tendon("b", "tube", BACK, friction=0.2, contacts=[0.05], end=0.16),
    ],
    "disks, helical": [
        Tendon("a", "tube", OFF_AXIS, friction=0.2, contacts=[0.05, 0.1]),
        Tendon("b", "tube", HELIX, friction=0.2, contacts=[0.02, 0.09, 0.17]),
    ],
    "channel and disks": [
        Tendon("a", "tube", OFF_AXIS, friction=0.2),
        Tendon("b", "tube", BACK, friction=0.3, contacts=[0.03, 0.11]),
    ],
}


def lone_tube(tendons, precurvature, loads=()):
    tube = Tube("tube", length=0.2, section=SECTION, material=SOFT, rotation=0.7, precurvature=precurvature)
    return Robot([tube], tendons, loads)


@pytest.mark.parametrize("precurvature", [(0.0, 0.0, 0.0), (3.0, -2.0, 6.0)])
@pytest.mark.parametrize("name", TENDONS)
def test_it_leads_where_the_march_leads(name, precurvature):
    phase = np.linspace(0.0, 3 * np.pi, 16)
    path = {"tension": np.stack([4.0 + 3.0 * np.sin(phase), 4.0 + 2.0 * np.sin(phase + 1.0)], axis=1)}
    load = PointLoad("tube", axes="body")  # nothing, but it asks for the march
    robots = (lone_tube(TENDONS[name], precurvature, loads) for loads in ([], [load]))
    lone, marched = (tactr.drive(robot, path, tolerance=1e-8) for robot in robots)
    assert lone.converged
    assert marched.converged
    assert lone.tips == pytest.approx(marched.tips, abs=2e-8)
    assert lone.lengths == pytest.approx(marched.lengths, abs=1e-8)
    for k in range(len(lone)):
        assert lone[k].tip_orientation == pytest.approx(marched[k].tip_orientation, abs=2e-7)


def test_one_long_bend_between_disks_is_an_arc():
    """EI kappa = T d and stretch 1 - T / EA in both spans, exactly; their turn makes the tension fall."""
    robot = lone_tube([Tendon("a", "tube", Straight(0.0, 1.2e-3), friction=0.2, contacts=[0.19])], (0, 0, 0))
    driven = tactr.drive(robot, {"tension": [[5.0], [20.0]]})
    stiffness, shape = SECTION.stiffness(SOFT), driven[1]
    EI, EA = stiffness.EI_x, stiffness.EA
    position, angle = np.zeros(2), 0.0  # in the plane of the bend
    for tension, length in zip(driven.state.tension("a", [0.1, 0.195]), (0.19, 0.01), strict=True):
        turn, stretch = tension * 1.2e-3 / EI * length, 1.0 - tension / EA
        chord = stretch * length * np.sinc(turn / (2 * np.pi))
        position = position + chord * np.array([np.sin(angle + turn / 2), np.cos(angle + turn / 2)])
        angle += turn
    assert angle > 2.0
    tip = shape.tip_position
    assert [np.hypot(*tip[:2]), tip[2]] == pytest.approx(position, abs=1e-9)
    assert np.linalg.norm(shape.centreline[-1] - tip) <= shape.discretisation_error + 1e-12
