"""Random plausible robots, one for each seed; the same seed always gives the same robot.

The distribution, drawn for each robot:

tubes        1 to 4, equally likely. Diameters grow from the inside: bore 0.2 to 0.6 mm (or, 1 in 5, a solid
             rod of 0.3 to 0.8 mm), wall 0.06 to 0.25 mm for metal and 0.2 to 0.5 mm for plastic, clearance
             0.02 to 0.15 mm.
material     4 in 5 metal (E 41 to 83 GPa like nitinol, or 190 to 215 GPa like steel), else plastic (E 1.5 to
             4 GPa); Poisson's ratio 0.28 to 0.42, density 1.1 to 8 g/cm^3 to match.
length       the robot is 60 to 300 mm long. Distal ends are spread evenly at random over it, each at least
             15 % of it from the base; innermost longest, but for 15 % of the robots they are in any order.
translation  a third of the robots has proximal ends 0 to 200 mm behind the guide's exit, else all are there.
rotation     -180 to 180 degrees for every tube.
precurvature 60 % of the robots: every tube curved (3 in 4) over its whole visible length or, 40 %, over a
             distal part, in any direction, sometimes (1 in 5) with a rest twist of up to 5 rad/m. The size is
             up to 1.5 times the limit where two such tubes begin to snap: sqrt(c) L = x with x tan x = L / b,
             c = (1 + nu) k^2, b the straight length before (x = pi/2 without one).
tendons      0 to 4 on every tube, at offsets of 1 to 8 mm, hosted by their own tube or by the outermost one
             present, straight (60 %) or helical with slopes up to 0.5; 1 in 10 ends before its tube does. One
             in five is slack. Tensions are scaled together so that the whole bend (rest curvature and
             tendons, tubes taken as glued together) is a number drawn from 0 to 270 degrees, where the rest
             curvature does not exceed it already; but no tension is above 100 N, or compresses any tube that
             it may be hosted by to less than 99 % of its length, or bends the glued tubes to a radius below
             1.6 times the offset of their outermost pulled tendon (its disks would touch).
loads        40 % of the robots: a force at the tip that alone would turn it by up to 1 rad, and in half of
             these a moment of the same size; any direction, in world axes (3 in 4) or body axes. 30 %:
             gravity in any direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tactr.robot import (
    Annulus,
    Gravity,
    Helix,
    Material,
    PointLoad,
    Robot,
    Rod,
    Straight,
    Tendon,
    Tube,
)
from tactr.robot.load import Load
from tactr.robot.pieces import Pieces, Vector3

LARGEST_BEND = math.radians(270.0)
LARGEST_TENSION = 100.0  # N, about what a steel wire of 0.3 mm holds
LARGEST_COMPRESSION = 0.01
BEYOND_LIMIT = 1.5
STRAIGHT: Pieces[Vector3] = ((0.0, (0.0, 0.0, 0.0)),)
CLOSEST = 1.0 / 1.6  # a tendon's offset in radii of curvature
GRID = 400  # places at which the bend is estimated


@dataclass(frozen=True)
class _Place:
    """Where a tube is: proximal end behind the guide, distal end outside it, m."""

    start: float
    tip: float


def random_robot(seed: int) -> Robot:
    """The robot of this seed, as distributed above."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 5))
    places = _places(rng, count)
    tubes = _tubes(rng, places)
    tendons = _tendons(rng, tubes)
    tendons = _tensioned(rng, tubes, tendons)
    return Robot(tubes, tendons, _loads(rng, tubes), name=f"random {seed}")


def _places(rng: np.random.Generator, count: int) -> list[_Place]:
    length = rng.uniform(0.06, 0.3)
    tips = np.sort(np.append(rng.uniform(0.15, 1.0, count - 1), 1.0)) * length
    if rng.random() < 0.15:
        rng.shuffle(tips)
    starts = -rng.uniform(0.0, 0.2, count) if rng.random() < 1 / 3 else np.zeros(count)
    return [_Place(float(start), float(tip)) for start, tip in zip(starts, tips, strict=True)]


def _tubes(rng: np.random.Generator, places: list[_Place]) -> list[Tube]:
    precurved = rng.random() < 0.6
    bore, tubes = rng.uniform(0.2e-3, 0.6e-3), []
    for i, place in reversed(list(enumerate(places))):
        material, metal = _material(rng)
        if i == len(places) - 1 and rng.random() < 0.2:
            section = Rod(rng.uniform(0.3e-3, 0.8e-3))
        else:
            wall = rng.uniform(0.06e-3, 0.25e-3) if metal else rng.uniform(0.2e-3, 0.5e-3)
            section = Annulus(bore + 2 * wall, bore)
        bore = section.outer_diameter + rng.uniform(0.02e-3, 0.15e-3)
        rest = (
            _precurvature(rng, place, material) if precurved and rng.random() < 0.75 else ((0.0, (0.0,) * 3),)
        )
        tubes.append(
            Tube(
                f"tube {i}",
                length=place.tip - place.start,
                section=section,
                material=material,
                precurvature=rest,
                translation=place.start,
                rotation=rng.uniform(-math.pi, math.pi),
            )
        )
    return tubes[::-1]


def _material(rng: np.random.Generator) -> tuple[Material, bool]:
    kind = rng.choice(["nitinol", "steel", "plastic"], p=[0.5, 0.3, 0.2])
    E, density = {
        "nitinol": (rng.uniform(41e9, 83e9), 6450.0),
        "steel": (rng.uniform(190e9, 215e9), 8000.0),
        "plastic": (rng.uniform(1.5e9, 4e9), rng.uniform(1100.0, 1400.0)),
    }[kind]
    return Material(E=E, nu=rng.uniform(0.28, 0.42), density=density), kind != "plastic"


def _precurvature(rng: np.random.Generator, place: _Place, material: Material) -> Pieces[Vector3]:
    reach = place.tip * (rng.uniform(0.2, 0.9) if rng.random() < 0.4 else 1.0)
    behind = place.tip - reach - place.start
    size = rng.uniform(0.0, BEYOND_LIMIT) * snapping_limit(reach, behind)
    curvature = size / (reach * math.sqrt(1.0 + material.poisson_ratio))
    direction = rng.uniform(-math.pi, math.pi)
    twist = rng.uniform(-5.0, 5.0) if rng.random() < 0.2 else 0.0
    rest = (curvature * math.cos(direction), curvature * math.sin(direction), twist)
    return ((0.0, rest),) if behind <= 0.0 else ((0.0, (0.0, 0.0, 0.0)), (behind, rest))


def snapping_limit(curved: float, straight: float) -> float:
    """sqrt(c) L at which two equal tubes begin to snap, a straight part before: x tan x = L / b."""
    low, high = 0.0, math.pi / 2
    for _ in range(60):
        x = 0.5 * (low + high)
        low, high = (low, x) if x * math.sin(x) * straight > curved * math.cos(x) else (x, high)
    return low


def _tendons(rng: np.random.Generator, tubes: list[Tube]) -> list[Tendon]:
    tendons = []
    for tube in tubes:
        for _ in range(int(rng.integers(0, 5))):
            radius, phase = rng.uniform(1e-3, 8e-3), rng.uniform(-math.pi, math.pi)
            helical = rng.random() < 0.4
            routing = (
                Helix(radius, rng.uniform(-0.5, 0.5) / radius, phase)
                if helical
                else Straight.polar(radius, phase)
            )
            early = rng.random() < 0.1
            tendons.append(
                Tendon(
                    f"tendon {len(tendons)}",
                    tube.name,
                    routing,
                    host="outermost" if rng.random() < 0.5 else "own",
                    tension=0.0 if rng.random() < 0.2 else rng.exponential(1.0),
                    end=-tube.translation + tube.tip * rng.uniform(0.3, 1.0) if early else None,
                )
            )
    return tendons


def _tensioned(rng: np.random.Generator, tubes: list[Tube], tendons: list[Tendon]) -> list[Tendon]:
    target = rng.uniform(0.0, LARGEST_BEND)
    highest = min((_limit(tubes, t) / _newtons(t) for t in tendons if _newtons(t) > 0.0), default=0.0)
    everywhere = np.concatenate([_grid(tubes), _middles(tubes, tendons)])
    reach = _largest_offset(tubes, tendons, everywhere)
    curvature, on_grid = (_glued(tubes, tendons, s) for s in (everywhere, _grid(tubes)))

    def fits(scale: float) -> bool:
        tightest = np.max(np.abs(curvature(scale)) * reach)
        return bool(_bend(tubes, on_grid(scale)) <= target and tightest <= CLOSEST)

    low, high = (highest if fits(highest) else 0.0), highest
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return [
        Tendon(t.name, t.tube, t.routing, host=t.host, tension=_newtons(t) * low, end=t.end) for t in tendons
    ]


def _limit(tubes: list[Tube], tendon: Tendon) -> float:
    names = [tube.name for tube in tubes]
    hosts = tubes[: names.index(tendon.tube) + 1] if tendon.host == "outermost" else [_own(tubes, tendon)]
    return min(LARGEST_TENSION, LARGEST_COMPRESSION * min(tube.stiffness.EA for tube in hosts))


def _own(tubes: list[Tube], tendon: Tendon) -> Tube:
    return next(tube for tube in tubes if tube.name == tendon.tube)


def _newtons(tendon: Tendon) -> float:
    assert isinstance(tendon.tension, float)
    return tendon.tension


def _bend(tubes: list[Tube], curvature: np.ndarray) -> float:
    """Total bend in rad by the curvature on the grid."""
    return float(np.mean(np.abs(curvature)) * max(tube.tip for tube in tubes))


def _grid(tubes: list[Tube]) -> np.ndarray:
    return (np.arange(GRID) + 0.5) * max(tube.tip for tube in tubes) / GRID


def _middles(tubes: list[Tube], tendons: list[Tendon]) -> np.ndarray:
    """Between neighbouring ends of tubes, tendons and curved parts, which may all fall between two places of
    the grid: there a thin tube alone can be bent tighter than anywhere else."""
    ends = [0.0, *(tube.tip for tube in tubes)]
    ends += [tube.translation + start for tube in tubes for start, _ in tube.precurvature]
    ends += [_own(tubes, t).translation + t.end for t in tendons if t.end is not None]
    ends = np.unique([s for s in ends if s >= 0.0])
    return 0.5 * (ends[1:] + ends[:-1])


def _glued(tubes: list[Tube], tendons: list[Tendon], s: np.ndarray) -> Callable[[float], np.ndarray]:
    """Curvature ux + i uy at s by the scale of the tensions, were the tubes glued together and unable to
    twist."""
    stiffness, rest = np.zeros(len(s)), np.zeros(len(s), dtype=complex)
    for tube in tubes:
        here, EI = s < tube.tip, tube.stiffness.EI_x
        stiffness += EI * here
        rest += EI * here * _rest(tube, s)
    pulls = [_pull(tubes, tendon, s) for tendon in tendons]

    def curvature(scale: float) -> np.ndarray:
        moment = rest.copy()
        for pull in pulls:
            moment += scale * pull
        return moment / stiffness

    return curvature


def _largest_offset(tubes: list[Tube], tendons: list[Tendon], s: np.ndarray) -> np.ndarray:
    """Offset of the outermost pulled tendon at s, m."""
    reach = np.zeros(len(s))
    for tendon in tendons:
        own = _own(tubes, tendon)
        here = s < (own.tip if tendon.end is None else own.translation + tendon.end)
        xy, _ = tendon.routing.evaluate(np.where(here, s, 0.0) - own.translation)
        reach = np.maximum(reach, np.linalg.norm(xy, axis=-1) * here * (_newtons(tendon) > 0.0))
    return reach


def _rest(tube: Tube, s: np.ndarray) -> np.ndarray:
    """Rest curvature at s as a complex number ux + i uy, turned into world axes."""
    starts = [start for start, _ in tube.precurvature]
    piece = np.clip(np.searchsorted(starts, s - tube.translation, side="right") - 1, 0, None)
    u = np.array([complex(u[0], u[1]) for _, u in tube.precurvature])[piece]
    return u * np.exp(1j * tube.rotation)


def _pull(tubes: list[Tube], tendon: Tendon, s: np.ndarray) -> np.ndarray:
    """Bending moment of a tendon at s, -lambda r x e3 as Mx + i My, in world axes."""
    own = _own(tubes, tendon)
    end = own.tip if tendon.end is None else own.translation + tendon.end
    here = s < end
    xy, _ = tendon.routing.evaluate(np.where(here, s, 0.0) - own.translation)
    turn = np.full(len(s), own.rotation)
    if tendon.host == "outermost":
        for tube in reversed(tubes):
            turn[s < tube.tip] = tube.rotation
    return _newtons(tendon) * here * (-xy[:, 1] + 1j * xy[:, 0]) * np.exp(1j * turn)


def _loads(rng: np.random.Generator, tubes: list[Tube]) -> list[Load]:
    loads: list[Load] = []
    if rng.random() < 0.4:
        loads.append(_tip_load(rng, tubes))
    if rng.random() < 0.3:
        x, y, z = 9.81 * _direction(rng)
        loads.append(Gravity((x, y, z)))
    return loads


def _tip_load(rng: np.random.Generator, tubes: list[Tube]) -> PointLoad:
    last = max(tubes, key=lambda tube: tube.tip)
    s = (np.arange(GRID) + 0.5) * last.tip / GRID
    flexibility = last.tip / GRID / sum(tube.stiffness.EI_x * (s < tube.tip) for tube in tubes)
    force = rng.uniform(0.0, 1.0) / np.sum(flexibility * (last.tip - s)) * _direction(rng)
    moment = rng.uniform(0.0, 1.0) / np.sum(flexibility) * _direction(rng) * (rng.random() < 0.5)
    axes = "world" if rng.random() < 0.75 else "body"
    return PointLoad(last.name, force=tuple(force), moment=tuple(moment), axes=axes)


def _direction(rng: np.random.Generator) -> np.ndarray:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)
