"""A small robot to build variants of."""

import pytest

from tactr.materials import nitinol, stainless_steel_215
from tactr.robot import Annulus, Robot, Straight, Tendon, Tube


@pytest.fixture
def outer() -> Tube:
    return Tube("outer", length=0.14, section=Annulus(0.001, 0.0008), material=nitinol)


@pytest.fixture
def inner() -> Tube:
    return Tube("inner", length=0.18, section=Annulus(0.0007, 0.0004), material=stainless_steel_215)


@pytest.fixture
def robot(outer: Tube, inner: Tube) -> Robot:
    tendons = [
        Tendon("pull", "outer", Straight(0.0, 0.0065), tension=3.0),
        Tendon("bend", "inner", Straight(0.0065, 0.0), tension=2.0),
    ]
    return Robot([outer, inner], tendons, name="two tubes")
