"""What every tube carries with its tendons, from a shape's strains: the kernel's own sums are not used."""

from __future__ import annotations

import numpy as np

from tactr import Robot, Tendon
from tactr.statics import Shape

Carried = tuple[np.ndarray, np.ndarray]


def host_at(robot: Robot, tendon: Tendon, s: float) -> int | None:
    """Index of the tube that guides a tendon at s (m); None beyond its end."""
    own = robot.tube(tendon.tube)
    end = own.length if tendon.end is None else tendon.end
    if s - own.translation >= end:
        return None
    if tendon.host == "outermost":
        return next(i for i, tube in enumerate(robot.tubes) if s < tube.tip)
    return [tube.name for tube in robot.tubes].index(tendon.tube)


def pull_at(shape: Shape, tendon: Tendon, host: int, s: float) -> Carried:
    """lambda t and lambda r x t at the station s (m), world axes."""
    tube = shape.tubes[host]
    at = int(np.flatnonzero(tube.s == s)[0])
    xy, slope = tendon.routing.evaluate(s - shape.robot.tube(tendon.tube).translation)
    r, dr = np.append(xy, 0.0), np.append(slope, 0.0)
    q = np.cross(tube.u[at], r) + dr + tube.v[at]
    assert isinstance(tendon.tension, float)
    pull = tendon.tension * q / np.linalg.norm(q)
    return tube.frames[at] @ pull, tube.frames[at] @ np.cross(r, pull)


def carried(shape: Shape, i: int) -> Carried:
    """N_i, M_i of tube i with the tendons it guides, at its stations (none at a breakpoint), world axes."""
    tube = shape.tubes[i]
    force = np.einsum("kab,kb->ka", tube.frames, tube.n)
    moment = np.einsum("kab,kb->ka", tube.frames, tube.m)
    for tendon in shape.robot.tendons:
        for k, s in enumerate(tube.s):
            if host_at(shape.robot, tendon, s) == i:
                pull, turn = pull_at(shape, tendon, i, s)
                force[k] += pull
                moment[k] += turn
    return force, moment


def breakpoints(robot: Robot) -> np.ndarray:
    """All s > 0 (m) where something begins or ends, the tips too."""
    places = [tube.tip for tube in robot.tubes]
    places += [tube.translation + stretch.start for tube in robot.tubes for stretch in tube.stretches]
    places += [robot.tube(t.tube).translation + t.end for t in robot.tendons if t.end is not None]
    return np.unique(np.round([s for s in places if s > 1e-9], 12))


def contact_on(shape: Shape, i: int, points: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """s and what neighbours exert on tube i there: per length, or concentrated; world axes."""
    s = shape.contacts[0].points.s if points else shape.tubes[i].s
    for contact in shape.contacts:
        s = np.union1d(s, contact.points.s) if points else s
    name = shape.robot.tubes[i].name
    force, moment = np.zeros((2, len(s), 3))
    for contact in shape.contacts:
        sign = (contact.inner == name) - (contact.outer == name)
        source = contact.points if points else contact
        at = np.searchsorted(s, source.s)
        if sign:
            force[at] += sign * source.force
            moment[at] += sign * source.moment
    return s, force, moment
