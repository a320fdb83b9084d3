"""Tendons, tension profiles and loads: what is stored."""

import numpy as np
import pytest

from tactr.robot import DistributedLoad, Gravity, PointLoad, Straight, Tendon, TensionProfile


def test_tendon_defaults() -> None:
    tendon = Tendon("t", "a", Straight(0.01, 0))
    assert (tendon.host, tendon.tension, tendon.end) == ("own", 0.0, None)
    assert hash(tendon) == hash(Tendon("t", "a", Straight(0.01, 0)))


def test_numbers_become_plain() -> None:
    tendon = Tendon("t", "a", Straight(0.01, 0), tension=np.int32(3), end=np.float32(0.5))  # type: ignore[arg-type]
    assert type(tendon.tension) is float
    assert (tendon.tension, tendon.end) == (3.0, 0.5)


def test_profile_is_straight_between_samples_and_constant_beyond() -> None:
    profile = TensionProfile(np.array([0.1, 0.2]), [4, 2])
    assert profile.sigma == (0.1, 0.2)
    np.testing.assert_allclose(profile.evaluate([0, 0.1, 0.15, 0.2, 0.3]), [4, 4, 3, 2, 2])
    assert profile.evaluate(0.15).shape == ()
    assert Tendon("t", "a", Straight(0, 0), tension=profile).tension is profile


def test_loads_store_plain_tuples() -> None:
    point = PointLoad("a", force=np.array([1, 2, 3]), moment=[0, 0, 1], at=0)  # type: ignore[arg-type]
    assert point.force == (1.0, 2.0, 3.0)
    assert point.moment == (0.0, 0.0, 1.0)
    assert (point.at, point.axes) == (0.0, "world")
    spread = DistributedLoad(force=(0, 1, 0), start=0.01, end=0.02, axes="body")
    assert (spread.tube, spread.start, spread.end, spread.axes) == (None, 0.01, 0.02, "body")
    assert Gravity().acceleration == (0.0, 0.0, -9.81)
    assert len({point, spread, Gravity()}) == 3


@pytest.mark.parametrize("kind", [PointLoad, DistributedLoad])
def test_a_load_of_nothing_is_allowed(kind: type) -> None:
    assert kind("a").force == (0.0, 0.0, 0.0)
