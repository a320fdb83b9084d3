"""What the actuators put in is what the robot stores."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import tactr
from tactr import PointLoad, Robot, RobotError, Stiffness, Straight, Tendon, TensionProfile, Tube
from tactr.statics import Shape, Work


def section(EI: float) -> Stiffness:
    return Stiffness(EI_x=EI, EI_y=EI, GJ=4e-3, EA=2e7, GA=8e6)


def robot(tension: float | TensionProfile = 1.0, end: float | None = None) -> Robot:
    tubes = [
        Tube("outer", length=0.12, section=section(5e-3), precurvature=(4, 2, 1),
             translation=-0.03),
        Tube("inner", length=0.2, section=section(3e-3), precurvature=(0, 9, 0),
             translation=-0.06),
    ]  # fmt: skip
    tendons = [Tendon("t", "inner", Straight(0.004, 0.001), tension=tension, end=end)]
    return Robot(tubes, tendons, [PointLoad("inner", force=(0.03, -0.02, 0.01))])


PATHS = {
    "tension": ({"tension": [0.0]}, {"tension": [4.0]}),
    "rotation": ({"rotation": [0.0, 0.0]}, {"rotation": [0.4, 1.5]}),
    "insertion": ({"translation": [-0.06, -0.1]}, {"translation": [-0.025, -0.055]}),
}
ALL = ({}, {})
for way in PATHS.values():
    for end, part in zip(ALL, way, strict=True):
        end.update(part)
PATHS["all"] = ALL


def path(name: str, steps: int) -> list[Shape]:
    described, (start, stop) = robot(), PATHS[name]
    shapes = []
    for share in np.linspace(0.0, 1.0, steps + 1):
        actuation = {key: (1 - share) * np.array(start[key]) + share * np.array(stop[key]) for key in start}
        shapes.append(
            tactr.solve(described, tolerance=1e-11, guess=shapes[-1] if shapes else None, **actuation)
        )
        assert shapes[-1].converged
    return shapes


def imbalance(found: Work) -> float:
    return abs(found.imbalance) / (
        abs(found.tension).sum() + abs(found.rotation).sum() + abs(found.translation).sum()
    )


@pytest.mark.parametrize("name", PATHS)
def test_work_is_stored(name: str) -> None:
    coarse, fine = (imbalance(tactr.work(path(name, steps))) for steps in (8, 32))
    assert fine < 1e-4
    assert math.log(coarse / fine, 4) == pytest.approx(2.0, abs=0.15)


def test_work_of_a_tendon_at_an_offset() -> None:
    """Bent by lambda r: lambda^2 r^2 l / (2 EI); straight lines are integrated exactly."""
    rod = Tube("rod", length=0.1, section=section(5e-3))
    described = Robot([rod], [Tendon("t", "rod", Straight(0.005, 0.0))])
    found = tactr.work([tactr.solve(described, tension=[tension]) for tension in (0.0, 1.0, 3.0)])
    expected = 9 * 0.005**2 * 0.1 / (2 * 5e-3) + 9 * 0.1 / (2 * 2e7)
    assert found.tension[0] == pytest.approx(expected, rel=1e-9)
    assert found.stored == pytest.approx(expected, rel=1e-9)
    assert found.imbalance == pytest.approx(0.0, abs=1e-12)


def test_a_closed_path_gives_back_what_it_took() -> None:
    there = path("all", 16)
    found = tactr.work([*there, *there[-2::-1]])
    assert found.total == pytest.approx(0.0, abs=1e-15) and found.stored == 0.0


def wrong_paths() -> list[tuple[Sequence[Shape], str]]:
    shape = tactr.solve(robot())
    profiled = tactr.solve(robot(tension=TensionProfile((0.0, 0.1), (2.0, 1.0))))
    other = tactr.solve(robot(end=0.15))
    loaded = tactr.solve(robot(), loads=[])
    fewer = tactr.solve(robot().replace(tendons=()))
    return [
        ([shape], "shapes"),
        ([profiled, profiled], "tendons[0].tension"),
        ([shape, other], "shapes[1]"),
        ([shape, shape, loaded], "shapes[2]"),
        ([shape, fewer], "shapes[1]"),
    ]


def test_paths_that_are_none() -> None:
    for shapes, field in wrong_paths():
        with pytest.raises(RobotError) as caught:
            tactr.work(shapes)
        assert caught.value.field == field
