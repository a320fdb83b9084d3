"""Robots whose numbers are known, and what a sensor would have measured of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import tactr
from tactr import Frame, Material, Measurements, Robot, Rod, Straight, Tendon, Tube
from tactr.calibration.model import Model
from tactr.calibration.parameters import expanded

ANGLES = (0.0, 2.1, 4.2)
NOISE = 3e-4  # m


def tension_robot(E: float = 55e9) -> Robot:
    """One rod, three tendons."""
    rod = Tube("rod", length=0.2, section=Rod(1e-3), material=Material(E=E, nu=0.3))
    return Robot([rod], [Tendon(f"t{k}", "rod", Straight.polar(5e-3, a)) for k, a in enumerate(ANGLES)])


def displacement_robot(compliance: float = 4e-4, pretension: float = 0.5) -> Robot:
    """The same, its tendons elastic, pretensioned and pulled by motors."""
    rod = tension_robot().tubes[0]
    return Robot(
        [rod],
        [
            Tendon(
                f"t{k}",
                "rod",
                Straight.polar(5e-3, a),
                displacement=0.0,
                compliance=compliance,
                pretension=pretension,
            )
            for k, a in enumerate(ANGLES)
        ],
    )


def pulls(kind: str, rows: int, seed: int) -> dict[str, np.ndarray]:
    """Of every tendon: tensions of 0 to 2 N, or displacements of -3 to 4 mm, which leave some slack."""
    rng = np.random.default_rng(seed)
    low, high = (0.0, 2.0) if kind == "tension" else (-3e-3, 4e-3)
    return {f"t{k}": rng.uniform(low, high, rows) for k in range(len(ANGLES))}


def measured(
    robot: Robot,
    kind: str,
    rows: int,
    *,
    seed: int = 0,
    frame: Frame | None = None,
    zeros: dict[str, float] | None = None,
    places: tuple[float | None, ...] = (None,),
) -> Measurements:
    """Without noise. zeros: of the motors, m, by tendon."""
    given = pulls(kind, rows, seed)
    blank = Measurements(np.zeros((rows, len(places), 3)), places=places)
    blank = replace(blank, tension=given) if kind == "tension" else replace(blank, displacement=given)
    names = list(blank.displacement)
    frees = expanded(robot, [f"tendons.{name}.zero" for name in zeros or {}], names)
    points = Model(robot, frame or Frame(), blank, frees, 1e-9).predict(
        np.array(list((zeros or {}).values()))
    )
    assert np.isfinite(points).all()
    return replace(blank, points=points)


def noisy(data: Measurements, rng: np.random.Generator, noise: float = NOISE) -> Measurements:
    """With normal noise on every coordinate."""
    return replace(data, points=data.points + rng.normal(0.0, noise, data.points.shape))


def solved(robot: Robot, **actuation: float) -> np.ndarray:
    """Tip at an actuation by displacement."""
    return tactr.solve(robot, displacement=actuation).tip_position
