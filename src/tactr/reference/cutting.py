"""From a `tactr.Robot` to `Sections`: the only module that knows the robot description."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from tactr.errors import RobotError
from tactr.reference.algebra import Array
from tactr.reference.paths import Path
from tactr.reference.sections import Section, SectionEnd, Sections, WorldOrBody
from tactr.robot import DistributedLoad, Gravity, PointLoad, Robot, Tendon, TensionProfile, Tube

SAME_PLACE = 1e-11
"""Two breakpoints closer than this (m) are one."""


def cut(robot: Robot) -> Sections:
    """Cut a robot into sections; all tubes must start at s = 0.

    Raises RobotError for a translation other than zero: the published model has no transmission length.
    """
    for i, tube in enumerate(robot.tubes):
        if tube.translation != 0.0:
            raise RobotError(
                f"tubes[{i}].translation",
                f"{tube.translation} m is more than tactr.reference can do: it starts every tube at s = 0",
                "0 m",
                value=tube.translation,
            )
    for i, tube in enumerate(robot.tubes):
        if any(not stretch.constant or any(stretch.powers[0][8:]) for stretch in tube.stretches):
            raise RobotError(
                f"tubes[{i}]",
                f"{tube.name!r} varies smoothly, or has a rest shear, a rest stretch or a neutral axis off "
                "its centreline: more than tactr.reference can do",
                "stiffness and precurvature in constant pieces",
                value=tube,
            )
    places = breakpoints(robot)
    sections = tuple(section_between(robot, start, end) for start, end in pairwise(places))
    return Sections(
        sections,
        tuple(end_of(robot, section) for section in sections),
        np.array([tube.rotation for tube in robot.tubes], dtype=float),
    )


def breakpoints(robot: Robot) -> list[float]:
    """Return all places (m) between which everything is smooth, from 0 to the most distal tip."""
    last = max(tube.length for tube in robot.tubes)
    places = [0.0]
    for place in sorted(p for p in places_of(robot) if 0.0 < p <= last):
        if place - places[-1] > SAME_PLACE:
            places.append(float(place))
    return places


def places_of(robot: Robot) -> Iterator[float]:
    """Yield every arc length at which something starts, ends or jumps."""
    for tube in robot.tubes:
        yield tube.length
        yield from (stretch.start for stretch in tube.stretches)
    for tendon in robot.tendons:
        yield tendon_end(robot, tendon)
        yield from (piece.start for piece in tendon.routing.pieces(tendon_end(robot, tendon)))
        if isinstance(tendon.tension, TensionProfile):
            yield from tendon.tension.sigma
    for load in robot.loads:
        if isinstance(load, PointLoad):
            yield point_of(robot, load)
        elif isinstance(load, DistributedLoad):
            yield load.start
            yield load_end(robot, load)


def tendon_end(robot: Robot, tendon: Tendon) -> float:
    """Return the arc length (m) at which the tendon terminates."""
    return robot.tube(tendon.tube).length if tendon.end is None else tendon.end


def point_of(robot: Robot, load: PointLoad) -> float:
    """Return the arc length (m) at which a point load acts."""
    return robot.tube(load.tube).length if load.at is None else load.at


def load_end(robot: Robot, load: DistributedLoad) -> float:
    """Return the arc length (m) at which a distributed load stops."""
    if load.end is not None:
        return load.end
    if load.tube is None:
        return max(tube.length for tube in robot.tubes)
    return robot.tube(load.tube).length


def section_between(robot: Robot, start: float, end: float) -> Section:
    """Return the section between two neighbouring breakpoints."""
    middle = 0.5 * (start + end)
    present = tuple(i for i, tube in enumerate(robot.tubes) if tube.length > middle)
    names = [robot.tubes[i].name for i in present]
    stretches = np.array([stretch_at(robot.tubes[i], middle) for i in present])
    EI_x, EI_y, GJ, EA, GA = stretches.T[:5]
    tendons = tuple(j for j, tendon in enumerate(robot.tendons) if tendon_end(robot, tendon) > middle)
    hosts = tuple(
        names.index(robot.tendons[j].tube) if robot.tendons[j].host == "own" else 0 for j in tendons
    )
    tension, rate = tensions(robot, tendons, start, end)
    return Section(
        start=start,
        end=end,
        tubes=present,
        K_se=np.array([np.diag(k) for k in zip(GA, GA, EA, strict=True)]),
        K_bt=np.array([np.diag(k) for k in zip(EI_x, EI_y, GJ, strict=True)]),
        u_star=stretches[:, 5:8],
        tendons=tendons,
        paths=tuple(path_at(robot, robot.tendons[j], middle) for j in tendons),
        hosts=hosts,
        tension=tension,
        tension_rate=rate,
        loads=tuple(distributed(robot, present, middle)),
    )


def stretch_at(tube: Tube, s: float) -> tuple[float, ...]:
    """Return the constants of a tube at s, in the order of `Stretch.powers`."""
    return [stretch for stretch in tube.stretches if stretch.start <= s][-1].powers[0]


def path_at(robot: Robot, tendon: Tendon, s: float) -> Path:
    """Return the piece of the tendon's routing that holds at s."""
    pieces = tendon.routing.pieces(tendon_end(robot, tendon))
    return Path.of_piece([piece for piece in pieces if piece.start <= s or piece is pieces[0]][-1])


def tensions(robot: Robot, tendons: tuple[int, ...], start: float, end: float) -> tuple[Array, Array]:
    """Return the tensions at `start` (N) and their rates (N/m): linear on a section."""
    # Sampled inside the section, so that a profile that jumps at a breakpoint is read on the right side.
    inside = start + (end - start) * np.array([0.25, 0.75])
    at_start, rates = np.zeros((2, len(tendons)))
    for k, j in enumerate(tendons):
        tension = robot.tendons[j].tension
        if isinstance(tension, TensionProfile):
            near, far = np.interp(inside, tension.sigma, tension.values)
            rates[k] = (far - near) / (inside[1] - inside[0])
            at_start[k] = near - rates[k] * (inside[0] - start)
        else:
            at_start[k] = tension
    return at_start, rates


def distributed(robot: Robot, present: tuple[int, ...], s: float) -> Iterator[WorldOrBody]:
    """Yield the distributed loads that act at s."""
    names = [robot.tubes[i].name for i in present]
    for load in robot.loads:
        if isinstance(load, Gravity):
            for k, i in enumerate(present):
                part = [part for part in robot.tubes[i].parts if part.start <= s][-1]
                weight = (part.stiffness.linear_density or 0.0) * np.array(load.acceleration)
                yield WorldOrBody(k, weight, np.zeros(3), world=True)
        elif isinstance(load, DistributedLoad) and load.start <= s < load_end(robot, load):
            k = 0 if load.tube is None else names.index(load.tube)
            yield WorldOrBody(k, np.array(load.force), np.array(load.moment), load.axes == "world")


def end_of(robot: Robot, section: Section) -> SectionEnd:
    """Return what ends and what acts at the section's end."""
    s = section.end
    names = [robot.tubes[i].name for i in section.tubes]
    tubes = tuple(k for k, i in enumerate(section.tubes) if abs(robot.tubes[i].length - s) <= SAME_PLACE)
    tendons = tuple(
        k for k, j in enumerate(section.tendons) if abs(tendon_end(robot, robot.tendons[j]) - s) <= SAME_PLACE
    )
    loads = tuple(
        WorldOrBody(names.index(load.tube), np.array(load.force), np.array(load.moment), load.axes == "world")
        for load in robot.loads
        if isinstance(load, PointLoad) and abs(point_of(robot, load) - s) <= SAME_PLACE
    )
    anchors = tuple(names.index(robot.tendons[section.tendons[k]].tube) for k in tendons)
    return SectionEnd(tubes, tendons, anchors, loads)
