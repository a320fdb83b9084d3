"""The exact tip Jacobian against central differences of solves on a fixed mesh of steps."""

from __future__ import annotations

import numpy as np
import pytest

from tactr import (
    Annulus,
    DistributedLoad,
    Helix,
    Material,
    PointLoad,
    Robot,
    Rod,
    Straight,
    Tendon,
    Tube,
    _core,
)
from tactr.statics import Prepared
from tactr.statics.frames import rotation_matrices

NITINOL = Material(E=60e9, G=23e9)
STEPS = 8
RELATIVE = 1e-6
SECTIONS = (Annulus(0.0016, 0.0013), Annulus(0.0011, 0.0008), Annulus(0.0007, 0.0004))


def tubes(translations: tuple[float, ...] = (0.0, 0.0, 0.0)) -> list[Tube]:
    """Three precurved tubes, twisted against each other."""
    rows = zip((0.1, 0.15, 0.2), SECTIONS, (2.0, 5.0, 8.0), (0.0, 0.7, -0.9), translations, strict=True)
    return [
        Tube(
            f"tube {i}",
            length=length - b,
            section=section,
            material=NITINOL,
            precurvature=(curvature, 1.0, 0.5),
            rotation=rotation,
            translation=b,
        )
        for i, (length, section, curvature, rotation, b) in enumerate(rows)
    ]


def helical_tendons() -> Robot:
    tendons = [
        Tendon("a", "tube 0", Straight(0.006, 0.0), tension=2.0),
        Tendon("b", "tube 1", Helix(0.005, 20.0), tension=1.5),
        Tendon("c", "tube 2", Helix(0.004, -30.0, 1.0), tension=0.5),
    ]
    return Robot(tubes(), tendons)


def loaded_rod() -> Robot:
    rod = Tube("rod", length=0.2, section=Rod(0.0012), material=NITINOL, rotation=0.4)
    tendons = [
        Tendon("a", "rod", Straight(0.005, 0.0), tension=1.0),
        Tendon("b", "rod", Helix(0.005, 15.0, 2.0), tension=2.0, end=0.15),
    ]
    loads = [
        PointLoad("rod", force=(0.05, 0.02, -0.03), moment=(0.0, 1e-3, 1e-3)),
        DistributedLoad(force=(0.1, 0.0, 0.0), axes="body"),
    ]
    return Robot([rod], tendons, loads)


def outermost_hosts() -> Robot:
    """Every tendon passes from tube to tube, at the angle that the tubes then have."""
    tendons = [
        Tendon("a", "tube 1", Helix(0.005, 12.0), host="outermost", tension=1.5),
        Tendon("b", "tube 2", Straight(0.0, 0.006), host="outermost", tension=1.0),
    ]
    return Robot(tubes(), tendons)


def pushed_back() -> Robot:
    return Robot(
        tubes((-0.05, -0.1, -0.2)),
        [
            Tendon("a", "tube 0", Straight(0.006, 0.0), tension=1.0),
            Tendon("b", "tube 2", Helix(0.005, 10.0), host="outermost", tension=1.0),
        ],
        [PointLoad("tube 2", force=(0.05, -0.02, 0.03))],
    )


def ends_inside_another_tube() -> Robot:
    """Two tendons on the outer tube belong to the inner one and end together inside the outer one."""
    tendons = [
        Tendon("a", "tube 1", Straight(0.006, 0.0), host="outermost", tension=1.5, end=0.07),
        Tendon("b", "tube 1", Helix(0.005, 20.0, 1.0), host="outermost", tension=1.0, end=0.07),
        Tendon("c", "tube 2", Helix(0.004, 15.0, 2.0), host="outermost", tension=0.5, end=0.07),
    ]
    return Robot(tubes(), tendons)


ROBOTS = [helical_tendons, loaded_rod, outermost_hosts, pushed_back, ends_inside_another_tube]


def solved(prepared: Prepared, tension: np.ndarray, rotation: np.ndarray, guess: _core.Solution | None):
    """A solve on so many steps in every section, to rounding."""
    return _core.solve(
        prepared._core, tension, rotation, prepared._translation, 1e-6, 1e-13, guess, steps=STEPS
    )


def differences(prepared: Prepared, what: str, step: float) -> np.ndarray:
    """Central differences of fourth order, (6, inputs)."""
    given = {"tension": prepared._tension, "rotation": prepared._rotation}
    start = solved(prepared, **given, guess=None)
    columns = []
    for k in range(len(given[what])):
        column = np.zeros(6)
        for shift, weight in ((-2, 1), (-1, -8), (1, 8), (2, -1)):
            moved = {name: array.copy() for name, array in given.items()}
            moved[what][k] += shift * step
            at = solved(prepared, **moved, guess=start)
            assert at.status == 0
            column += weight * pose_from(start, at) / (12 * step)
        columns.append(column)
    return np.stack(columns, axis=1)


def pose_from(start: _core.Solution, at: _core.Solution) -> np.ndarray:
    """Shift and rotation vector, world axes, from one tip pose to another near it."""
    turn = rotation_matrices(at.tip_quaternion) @ rotation_matrices(start.tip_quaternion).T
    axis = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    sine = float(np.linalg.norm(axis))
    vector = axis if sine < 1e-12 else axis * (np.arcsin(sine) / sine)
    return np.concatenate([at.tip_position - start.tip_position, vector])


@pytest.mark.parametrize("build", ROBOTS, ids=lambda build: build.__name__)
def test_tip_jacobian_against_differences(build) -> None:
    robot = build()
    exact = Prepared(robot, tolerance=1e-9).solve().tip_jacobian()
    prepared = Prepared(robot)
    for what, columns, step in (("tension", exact.tension, 2e-3), ("rotation", exact.rotation, 2e-3)):
        expected = differences(prepared, what, step)
        assert columns.shape == expected.shape
        for rows in (slice(0, 3), slice(3, 6)):
            size = np.abs(expected[rows]).max()
            np.testing.assert_allclose(columns[rows], expected[rows], rtol=0.0, atol=RELATIVE * size)
