"""Robots for the tests of `tactr.reference`: those of the shared cases, and random straight-routed ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tactr.robot import (
    Annulus,
    DistributedLoad,
    Gravity,
    Helix,
    Material,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Robot,
    Straight,
    Tendon,
    TensionProfile,
    Tube,
)

CASES = Path(__file__).resolve().parents[3] / "shared" / "cases.json"
CASE_NAMES = (
    "one_tube_helical_loaded",
    "two_tubes_orthogonal_own",
    "two_tubes_orthogonal_outermost",
    "two_precurved_tubes_no_tendon",
    "three_tubes_mixed",
)


def case_robot(case: dict[str, Any]) -> Robot:
    """Build the robot of one entry of cases.json."""
    tubes = [
        Tube(
            f"tube {i}",
            length=tube["length"],
            section=Annulus(tube["outer_diameter"], tube["inner_diameter"]),
            material=Material(E=tube["youngs_modulus"], G=tube["shear_modulus"]),
            precurvature=tube["precurvature"],
            rotation=rotation,
        )
        for i, (tube, rotation) in enumerate(zip(case["tubes"], case["base_rotation"], strict=True))
    ]
    tendons = [
        Tendon(
            f"tendon {j}", f"tube {t['tube']}", routing(t["routing"]), host=t["host"], tension=t["tension"]
        )
        for j, t in enumerate(case["tendons"])
    ]
    loads: list[PointLoad | DistributedLoad] = []
    if "tip_force" in case:
        loads.append(PointLoad(tubes[-1].name, force=case["tip_force"], moment=case["tip_moment"]))
    if "distributed_force" in case:
        loads.append(DistributedLoad(force=case["distributed_force"]))
    return Robot(tubes, tendons, loads)


def routing(entry: dict[str, Any]) -> Straight | Helix:
    """Build the routing of one tendon of cases.json."""
    if entry["kind"] == "straight":
        return Straight(entry["x"], entry["y"])
    return Helix(entry["radius"], entry["rate"], entry["phase"])


def random_straight_robot(seed: int) -> Robot:
    """Return a plausible robot: 1 to 4 precurved tubes, straight tendons and, half of the time, loads."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 5))
    tips = np.sort(rng.uniform(0.04, 0.2, n))
    if n > 1 and rng.random() < 0.2:
        rng.shuffle(tips)
    tubes, bore = [], rng.uniform(0.3e-3, 0.6e-3)
    for i in reversed(range(n)):
        outer = bore + rng.uniform(0.15e-3, 0.4e-3)
        G = (E := rng.uniform(30e9, 210e9)) / rng.uniform(2.4, 2.8)
        direction = rng.uniform(-np.pi, np.pi)
        curvature = rng.uniform(0.0, 8.0) * np.array([np.cos(direction), np.sin(direction), 0.0])
        tubes.append(
            Tube(
                f"tube {i}",
                length=tips[i],
                section=Annulus(outer, bore),
                material=Material(E=E, G=G, density=6500.0),
                precurvature=curvature,
                rotation=rng.uniform(-np.pi, np.pi),
            )
        )
        bore = outer + rng.uniform(0.05e-3, 0.15e-3)
    tubes.reverse()
    radius = rng.uniform(2e-3, 7e-3)
    count = int(rng.integers(0, 2 * n + 1))
    tendons = []
    for j in range(count):
        tube = tubes[rng.integers(n)]
        most = 2.5 / (radius * bending_compliance(tubes, tube.length))
        tendons.append(
            Tendon(
                f"tendon {j}",
                tube.name,
                Straight.polar(radius, rng.uniform(-np.pi, np.pi)),
                host="own" if rng.random() < 0.6 else "outermost",
                tension=rng.uniform(0.0, most / count),
            )
        )
    loads = random_loads(rng, tubes) if rng.random() < 0.5 else []
    return Robot(tubes, tendons, loads)


def bending_compliance(tubes: list[Tube], s: float) -> float:
    """Return the bend from 0 to s (m) under a moment of 1 N m, in rad."""
    cuts = np.unique([0.0, s, *(tube.length for tube in tubes if tube.length < s)])
    middles = 0.5 * (cuts[:-1] + cuts[1:])
    stiffness = [sum(tube.stiffness.EI_x for tube in tubes if tube.length > middle) for middle in middles]
    return float(np.sum(np.diff(cuts) / stiffness))


def random_loads(rng: np.random.Generator, tubes: list[Tube]) -> list[Any]:
    """Return a wrench on one tube's tip and a distributed force.

    Each bends the robot by up to about half a radian.
    """
    tube = tubes[rng.integers(len(tubes))]
    length = max(tube.length for tube in tubes)
    moment = 0.3 / bending_compliance(tubes, length)
    return [
        PointLoad(
            tube.name,
            force=random_vector(rng, moment / length),
            moment=random_vector(rng, moment),
            axes="world" if rng.random() < 0.5 else "body",
        ),
        DistributedLoad(force=random_vector(rng, moment / length**2)),
    ]


def random_vector(rng: np.random.Generator, most: float) -> tuple[float, float, float]:
    """Return three numbers between -most and most."""
    x, y, z = rng.uniform(-most, most, 3)
    return float(x), float(y), float(z)


def random_varied_robot(seed: int) -> Robot:
    """Return a random robot with everything that a straight-routed one lacks.

    Helical, polynomial and kinked routings, tension profiles, tendons that end before their tube, stepped
    rest curvature with twist, gravity, and loads in between.
    """
    plain = random_straight_robot(seed)
    rng = np.random.default_rng([seed, 1])
    tubes = [
        replace(
            tube, precurvature=[(0.0, random_vector(rng, 6.0)), (0.6 * tube.length, random_vector(rng, 6.0))]
        )
        for tube in plain.tubes
    ]
    tendons = [varied(rng, tendon, plain.tube(tendon.tube).length) for tendon in plain.tendons]
    longest = max(tubes, key=lambda tube: tube.length)
    small = 0.2 / (bending_compliance(tubes, longest.length) * longest.length)
    loads = [
        *plain.loads,
        Gravity((3.0, -2.0, -9.0)),
        PointLoad(longest.name, force=random_vector(rng, small), at=0.4 * longest.length, axes="body"),
        DistributedLoad(
            longest.name,
            force=random_vector(rng, small / longest.length),
            moment=random_vector(rng, small),
            start=0.2 * longest.length,
            end=0.7 * longest.length,
            axes="body",
        ),
    ]
    return Robot(tubes, tendons, loads)


def varied(rng: np.random.Generator, tendon: Tendon, length: float) -> Tendon:
    """Return the tendon on another path, in half of the cases with a varying tension, or ending early."""
    x, y = tendon.routing.r(0.0)
    radius, angle = float(np.hypot(x, y)), float(np.arctan2(y, x))
    rate = float(rng.uniform(-10.0, 10.0))
    kink = 0.55 * length
    routings = [
        Helix(radius, rate, angle),
        Polynomial((x, 0.01, -0.2), (y, -0.02, 0.1)),
        PolarPolynomial((radius, 0.01), (angle, rate, 20.0)),
        Piecewise([(0.0, Helix(radius, rate, angle)), (kink, Helix(radius, -rate, angle + 2 * rate * kink))]),
    ]
    tension = tendon.tension
    if rng.random() < 0.5 and not isinstance(tension, TensionProfile):
        tension = TensionProfile((0.0, 0.3 * length, length), (tension, tension, 0.6 * tension))
    end = 0.8 * length if rng.random() < 0.3 else None
    return replace(tendon, routing=routings[rng.integers(4)], tension=tension, end=end)
