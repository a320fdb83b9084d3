"""Robots without a smooth equilibrium: a tendon bends its tubes to a radius as small as its own offset."""

from __future__ import annotations

from dataclasses import replace

from tactr.robot import Gravity, PointLoad, Robot
from tactr.robot.load import Load
from tactr.statics import Prepared, Shape

FIRST, LEAST_STEP = 0.025, 1e-3
KINK = 0.02  # of a tendon's rest length, what is left of it per length where it is shortest


def kink_share(robot: Robot) -> float | None:
    """Where the shape, followed from small tensions and loads, ends because a tendon has no length left.

    The share of tensions and loads; None where the shape does not end so. The tendon's length per length of
    tube, |q|, falls to KINK there at least, and in a straight line to 0 before tensions and loads are whole.
    """
    done, step, shape, falls = 0.0, FIRST, None, []
    while done < 1.0 and step > LEAST_STEP:
        share = min(1.0, done + step)
        found = Prepared(_scaled(robot, share), stations=2).solve(guess=shape)
        if found.converged and (shape is None or _length_left(found) < _length_left(shape) + 0.1):
            done, shape = share, found
            falls.append((share, _length_left(found)))
        else:
            step *= 0.5
    if shape is None or done >= 1.0 or len(falls) < 2 or falls[-1][1] > KINK:
        return None
    (s0, q0), (s1, q1) = falls[-2:]
    return done if q1 < q0 and s1 + q1 * (s1 - s0) / (q0 - q1) < 1.0 else None


def _length_left(shape: Shape) -> float:
    return shape._solution.shortest_tendon


def _scaled(robot: Robot, share: float) -> Robot:
    tension = {t.name: share * t.tension for t in robot.tendons if isinstance(t.tension, float)}
    return robot.replace(loads=[_weaker(load, share) for load in robot.loads]).with_actuation(tension=tension)


def _weaker(load: Load, share: float) -> Load:
    if isinstance(load, PointLoad):
        x, y, z = load.force
        return replace(load, force=(share * x, share * y, share * z))
    assert isinstance(load, Gravity)
    x, y, z = load.acceleration
    return replace(load, acceleration=(share * x, share * y, share * z))
