"""A tendon that bends its own tube, in closed form.

Without loads the curvature is tension times offset over EI, so that the capstan's law T' = -mu T kappa gives
1/T = 1/T0 + a s with a = mu r / EI while pulling, and 1/T = 1/T0 - a s while letting go. The two meet where
2 a s is the difference of 1/T0.
"""

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import tactr

from .robots import bending, pulled

R, LENGTH, MU = 1.2e-3, 0.2, 0.3


def closed(stiffness, sigma, high, low):
    """Tension after a pull to high and back to low."""
    a = MU * R / stiffness.EI_x
    return np.minimum(1 / (1 / low - a * sigma), 1 / (1 / high + a * sigma))


@pytest.mark.parametrize("low", [8.0, 7.0, 6.0, 3.0])
def test_tension_and_tip(low):
    robot = bending(MU)
    stiffness = robot.tubes[0].stiffness
    driven = tactr.drive(robot, pulled([8.0, low]), tolerance=1e-8)
    sigma = np.linspace(0.0, LENGTH, 4001)
    tension = (
        closed(stiffness, sigma, 8.0, low) if low < 8.0 else 1 / (1 / 8 + MU * R / stiffness.EI_x * sigma)
    )
    assert driven.state.tension("up", sigma) == pytest.approx(tension, rel=2e-7)
    angle = cumulative_simpson(tension * R / stiffness.EI_x, x=sigma, initial=0.0)
    stretch = 1.0 - tension / stiffness.EA
    y, z = (cumulative_simpson(stretch * part, x=sigma)[-1] for part in (np.sin(angle), np.cos(angle)))
    assert angle[-1] > 0.3
    assert driven.tips[-1] == pytest.approx([0.0, y, z], abs=2e-7)


def test_the_front_moves_as_the_tension_falls():
    robot = bending(MU)
    a = MU * R / robot.tubes[0].stiffness.EI_x
    driven = tactr.drive(robot, pulled([8.0, 7.0, 6.5, 6.0]), tolerance=1e-7)
    for state, low in zip(driven.states[1:], (7.0, 6.5, 6.0), strict=True):
        (profile,) = state.profiles
        assert profile is not None
        assert profile.log.edges[1] == pytest.approx((1 / low - 1 / 8) / (2 * a), rel=1e-6)
