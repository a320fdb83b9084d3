"""Points of a path: arrays are checked at once, and mean what the same rows mean one by one."""

import numpy as np
import pytest

from tactr import Annulus, Material, Robot, RobotError, Straight, Tendon, TensionProfile, Tube
from tactr.statics.path import path_points

TUBE = Tube("tube", length=0.2, section=Annulus(2e-3, 1.6e-3), material=Material(E=5e9, nu=0.3), rotation=0.4)


def robot(**fields) -> Robot:
    held = Tendon("held", "tube", Straight(0, -1.2e-3), **fields)
    return Robot([TUBE], [Tendon("up", "tube", Straight(0, 1.2e-3), tension=1.0), held])


@pytest.mark.parametrize(
    "fields", [{}, {"displacement": 1e-3}, {"tension": 2.0}, {"tension": TensionProfile([0.0], [1.0])}]
)
@pytest.mark.parametrize(
    "path",
    [
        {"tension": np.array([[1.0, 2.0], [3.0, 0.0]])},
        {"rotation": [[1], [-2]]},
        {"rotation": np.array([[0.1], [0.2]]), "tension": np.array([[1.0, 2.0], [3.0, 4.0]])},
        {"translation": np.array([[0.0], [-0.05]])},
        {"displacement": np.array([[np.nan, 1e-3], [np.nan, 2e-3]])},
    ],
)
def test_arrays_are_rows(fields, path):
    """The robot at every row, built on its own, says what every point is."""
    one = robot(**fields)
    rows = [{kind: np.asarray(array, dtype=float)[k] for kind, array in path.items()} for k in range(2)]
    if isinstance(one.tendons[1].tension, TensionProfile) and not path.keys() <= {"rotation", "translation"}:
        with pytest.raises(RobotError, match=r"path\[0\]"):
            path_points(one, path)
        return
    points = path_points(one, path)
    assert len(points) == 2 and points.first == one.with_actuation(**rows[0])
    for k, row in enumerate(rows):
        moved = one.with_actuation(**row)
        profiled = [isinstance(t.tension, TensionProfile) for t in moved.tendons]
        assert points.tension[k].tolist() == [
            1.0 if profile else t.tension for t, profile in zip(moved.tendons, profiled, strict=True)
        ]
        assert points.rotation[k].tolist() == [t.rotation for t in moved.tubes]
        assert points.translation[k].tolist() == [t.translation for t in moved.tubes]
        pulls = [None if np.isnan(d) else float(d) for d in points.displacement[k]]
        assert pulls == [t.displacement for t in moved.tendons]


@pytest.mark.parametrize(
    ("path", "field", "found"),
    [
        ({"tension": [[1.0, 1.0], [1.0, -2.0]]}, "path[1].tendons[1].tension", "-2 N"),
        ({"tension": [[1.0, 1.0], [np.nan, 2.0]]}, "path[1].tendons[0].tension", "nan"),
        ({"rotation": [[1.0], [np.inf]]}, "path[1].tubes[0].rotation", "inf"),
        ({"tension": [[1.0], [2.0]]}, "path[0].tension", "1 values for 2 tendons"),
        ({"translation": [[0.0], [-0.2]]}, "path[1].tubes[0].translation", "-0.2 m"),
        ({"displacement": [[np.nan, 1e-3], [np.nan, np.nan]]}, "path[1].tension", "'held'"),
    ],
)
def test_the_wrong_row_is_named(path, field, found):
    with pytest.raises(RobotError, match=found) as caught:
        path_points(robot(), path)
    assert caught.value.field == field


def test_points_do_not_follow_an_array_that_changes():
    tension = np.array([[1.0, 2.0], [3.0, 4.0]])
    points = path_points(robot(), {"tension": tension})
    tension[:] = 9.0
    assert points.tension.tolist() == [[1.0, 2.0], [3.0, 4.0]]
