"""Robots with friction, and paths to drive them along."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

import tactr
from tactr import Annulus, Material, Robot, Straight, Tendon, Tube
from tactr.robot.friction import FrictionLike

SOFT, STIFF = Material(E=5e9, nu=0.3), Material(E=1e20, nu=0.3)
STRAIGHT = (0.0, 0.0, 0.0)


def bending(
    friction: FrictionLike = 0.2, *, both=False, material=SOFT, precurvature=STRAIGHT, loads=(), **fields
):
    """One tube of 200 mm that a tendon, or two opposite ones, bend far."""
    tube = Tube(
        "tube", length=0.2, section=Annulus(2e-3, 1.6e-3), material=material, precurvature=precurvature
    )
    tendons = [Tendon("up", "tube", Straight(0, 1.2e-3), friction=friction, **fields)]
    if both:
        tendons.append(Tendon("down", "tube", Straight(0, -1.2e-3), friction=friction, **fields))
    return Robot([tube], tendons, loads)


def rubbing_tubes(friction: float, disks: int | None):
    """Three tubes with a tendon each, in channels or over so many disks."""
    robot = tactr.examples.load("three_tube_a")
    tendons = []
    for tendon in robot.tendons:
        end = next(tube.length for tube in robot.tubes if tube.name == tendon.tube)
        contacts = None if disks is None else np.linspace(0.0, end, disks + 1)[1:] * 0.999
        tendons.append(replace(tendon, friction=friction, contacts=contacts))
    return robot.replace(tendons=tuple(tendons))


def twisting_tubes():
    """Three curved tubes that tendons twist: that changes paths where no tension changes."""
    tubes = [
        _curved("outer", 0.125, Annulus(1.39e-3, 1.08e-3), 81e9, 0.41, (0.0, (4.28, -1.42, 0.0))),
        _curved("middle", 0.244, Annulus(1.03e-3, 0.68e-3), 49e9, 2.31, (0.178, (4.0, -1.03, 0.0))),
        _curved("inner", 0.297, Annulus(0.63e-3, 0.35e-3), 61e9, -1.35, (0.0, (-3.81, 2.37, -1.29))),
    ]
    tendons = [
        Tendon("near", "outer", Straight(-0.3e-3, -5.9e-3), end=0.06, friction=0.48),
        Tendon("strong", "middle", Straight(3.0e-3, -2.05e-3), end=0.225, friction=0.48),
        Tendon("weak", "middle", Straight(-1.6e-3, -3.0e-3), friction=0.48),
    ]
    return Robot(tubes, tendons)


def two_curved_tubes():
    """With two tendons on the inner one, whose fronts come by near to each other on the way back."""
    tubes = [
        _curved("outer", 0.12, Annulus(1.39e-3, 1.08e-3), 81e9, 0.4, (0.0, (4.3, -1.4, 0.0))),
        _curved("inner", 0.24, Annulus(1.03e-3, 0.68e-3), 49e9, 2.3, (0.0, (-4.0, 1.0, 0.0))),
    ]
    tendons = [
        Tendon("strong", "inner", Straight(3.0e-3, -2.0e-3), friction=0.48),
        Tendon("weak", "inner", Straight(-1.6e-3, -3.0e-3), friction=0.48),
    ]
    return Robot(tubes, tendons)


def _curved(name, length, section, modulus, rotation, last):
    """Of a tube: straight, but from a place on."""
    pieces = (last,) if last[0] == 0.0 else ((0.0, STRAIGHT), last)
    material = Material(E=modulus, nu=0.33)
    return Tube(
        name, length=length, section=section, material=material, precurvature=pieces, rotation=rotation
    )


def legs(corners, cuts):
    """Along corners, every way cut into so many."""
    parts = [np.linspace(a, b, cuts + 1)[1:] for a, b in pairwise(corners)]
    return np.concatenate([[corners[0]], *parts])


def pulled(values):
    """A path of the tension of one tendon."""
    return {"tension": np.asarray(values, dtype=float)[:, None]}
