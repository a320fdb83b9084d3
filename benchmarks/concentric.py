"""A concentric tube robot of three tubes over its whole workspace: cold solves, and one long path.

    python benchmarks/concentric.py [--count 1000] [--points 1000]

Published tubes (E 65 GPa, nu 0.32), innermost first: straight 190, 120, 90 mm, curved 60, 80, 40 mm, radii of
curvature 40, 100, 140 mm, diameters 0.92/0.80, 1.10/0.97, 1.40/1.20 mm. A random configuration is feasible:
every proximal end behind the guide's exit, distal ends in order and outside; rotations -180 to 180 degrees;
every second one carries 0.05 N in a random direction at the tip. The path goes straight from one such
configuration to the next, 50 points each: the feasible ones are a convex set.
"""

from __future__ import annotations

import argparse
import math
import time
from dataclasses import dataclass

import numpy as np

import tactr
from tactr import Annulus, Material, PointLoad, Robot, Shape, Tube
from tactr.statics import Followed, Prepared

ROWS = (  # name, straight, curved, radius of curvature, outer diameter, inner diameter (mm); outermost first
    ("outer", 90, 40, 140, 1.40, 1.20),
    ("middle", 120, 80, 100, 1.10, 0.97),
    ("inner", 190, 60, 40, 0.92, 0.80),
)
LENGTHS = np.array([(straight + curved) * 1e-3 for _, straight, curved, *_ in ROWS])
FORCE = 0.05  # N
REACH = 1e-3  # m: least length outside, and least distance between distal ends
POINTS_EACH = 50


@dataclass(frozen=True)
class Configuration:
    """Translations (m) and rotations (rad) of the tubes, outermost first, and the force at the tip (N)."""

    translation: np.ndarray
    rotation: np.ndarray
    force: np.ndarray

    def robot(self) -> Robot:
        """The robot there."""
        return concentric(self.force).with_actuation(translation=self.translation, rotation=self.rotation)


def concentric(force: np.ndarray | tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Robot:
    """The robot with all tubes at the exit of the guide, where they begin."""
    tubes = [
        Tube(
            name,
            length=(straight + curved) * 1e-3,
            section=Annulus(outer * 1e-3, inner * 1e-3),
            material=Material(E=65e9, nu=0.32),
            precurvature=[(0.0, (0.0, 0.0, 0.0)), (straight * 1e-3, (1e3 / radius, 0.0, 0.0))],
        )
        for name, straight, curved, radius, outer, inner in ROWS
    ]
    return Robot(tubes, loads=[PointLoad("inner", force=tuple(force))] if np.any(force) else [])


def random_configuration(rng: np.random.Generator, *, loaded: bool) -> Configuration:
    """Uniform over the feasible ones."""
    while True:
        translation = -rng.uniform(0.0, 1.0, 3) * LENGTHS
        tips = translation + LENGTHS
        if tips[0] > REACH and np.all(np.diff(tips) > REACH):
            break
    direction = rng.standard_normal(3)
    force = FORCE * direction / np.linalg.norm(direction) if loaded else np.zeros(3)
    return Configuration(translation, rng.uniform(-math.pi, math.pi, 3), force)


def cold_solves(count: int, *, seed: int = 0) -> list[Shape]:
    """Random configurations, every second one loaded, each solved from cold."""
    rng = np.random.default_rng(seed)
    return [tactr.solve(random_configuration(rng, loaded=k % 2 == 1).robot()) for k in range(count)]


def random_path(points: int, *, seed: int = 0, loaded: bool = False) -> Followed:
    """One solution followed along a random path."""
    rng = np.random.default_rng(seed)
    corners = [random_configuration(rng, loaded=loaded) for _ in range(points // POINTS_EACH + 2)]
    part = np.arange(points) / POINTS_EACH
    path = {
        name: np.array([np.interp(part, np.arange(len(corners)), row) for row in np.array(rows).T]).T
        for name, rows in (
            ("translation", [corner.translation for corner in corners]),
            ("rotation", [corner.rotation for corner in corners]),
        )
    }
    return tactr.follow(concentric(corners[0].force), path)


def unstable_without_need(shape: Shape) -> bool:
    """Whether a converged shape is unstable although a stable one is found by a wide search."""
    if shape.stability.stable:
        return False
    return any(other.stability.stable for other in Prepared(shape.robot).branches())


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=1000, help="cold solves")
    parser.add_argument("--points", type=int, default=1000, help="points of each path")
    arguments = parser.parse_args()
    shapes = cold_solves(arguments.count)
    good = [shape for shape in shapes if shape.converged]
    stable = sum(shape.stability.stable for shape in good)
    missed = sum(unstable_without_need(shape) for shape in good)
    times = 1e3 * np.array([shape.solve_time for shape in shapes])
    print(f"cold: {len(good)} of {len(shapes)} converged, {stable} stable, {missed} unstable without need")
    print(f"      median {np.median(times):.2f} ms, mean {times.mean():.2f} ms, longest {times.max():.1f} ms")
    for loaded in (False, True):
        start = time.perf_counter()
        followed = random_path(arguments.points, loaded=loaded)
        elapsed = time.perf_counter() - start
        print(f"path{', loaded' if loaded else ''}: {followed!r} in {elapsed:.1f} s")


if __name__ == "__main__":
    main()
