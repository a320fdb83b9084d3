"""Loads on a robot whose tubes move after it was prepared."""

from __future__ import annotations

import numpy as np
import pytest

import tactr
from tactr import (
    Annulus,
    DistributedLoad,
    Gravity,
    Material,
    PointLoad,
    Robot,
    RobotError,
    Straight,
    Tendon,
    Tube,
)
from tactr.robot.load import Load
from tactr.statics import Prepared

NITINOL = Material(E=60e9, G=23e9, density=6450.0)
LOADS: dict[str, Load] = {
    "outermost": DistributedLoad(force=(0.3, 0.1, 0.0)),
    "outermost, body axes": DistributedLoad(force=(0.3, 0.1, 0.0), axes="body"),
    "outermost, from a place": DistributedLoad(force=(0.3, 0.1, 0.0), start=0.05),
    "outermost, up to a place": DistributedLoad(force=(0.3, 0.1, 0.0), start=0.02, end=0.08),
    "one tube": DistributedLoad("inner", force=(0.3, 0.1, 0.0)),
    "one tube, part": DistributedLoad("inner", moment=(0.0, 0.02, 0.02), start=0.1, end=0.17),
    "gravity": Gravity((9.81, 0.0, 0.0)),
    "point": PointLoad("inner", force=(0.05, 0.0, 0.02)),
}
MOVES = [(0.0, 0.0), (0.0, -0.03), (-0.04, -0.02), (-0.02, -0.09)]


def robot(load: Load, moved: tuple[float, float] = (-0.01, -0.01)) -> Robot:
    tubes = [
        Tube("outer", length=0.1, section=Annulus(0.0014, 0.0011), material=NITINOL, translation=moved[0]),
        Tube(
            "inner",
            length=0.2,
            section=Annulus(0.001, 0.0007),
            material=NITINOL,
            precurvature=(0, 6, 0),
            translation=moved[1],
        ),
    ]
    return Robot(tubes, [Tendon("t", "inner", Straight(0.005, 0.0), tension=0.5)], [load])


@pytest.mark.parametrize("name", LOADS)
@pytest.mark.parametrize("move", MOVES)
def test_moved_as_built_there(name: str, move: tuple[float, float]) -> None:
    expected = tactr.solve(robot(LOADS[name], move))
    prepared = Prepared(robot(LOADS[name]))
    for given in (np.array(move), list(move), {"outer": move[0], "inner": move[1]}):
        shape = prepared.solve(translation=given)
        assert shape.converged, shape.message
        np.testing.assert_allclose(shape.centreline, expected.centreline, rtol=0.0, atol=1e-12)


def test_a_point_load_drawn_into_the_guide_is_treated_alike() -> None:
    """As an array or as a mapping: one answer, or one error."""
    prepared = Prepared(robot(PointLoad("inner", force=(0.05, 0.0, 0.0), at=0.05)))
    found = []
    for given in (np.array([0.0, -0.08]), {"outer": 0.0, "inner": -0.08}):
        try:
            found.append(tuple(prepared.solve(translation=given).tip_position))
        except RobotError as error:
            found.append(error.field)
    assert found[0] == found[1]
