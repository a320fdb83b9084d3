"""How far actuators go: checked, kept by files, and nothing to a solve."""

import math

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tactr
from tactr import Annulus, Robot, RobotError, Straight, Tendon, TendonLimits, Tube, TubeLimits, materials
from tactr.io import RobotFileError, dumps, loads
from tactr.io.layout import json_schema
from tactr.io.read_yaml import read_yaml

ranges = st.none() | st.tuples(st.floats(-10, 10), st.floats(0.1, 5)).map(lambda p: (p[0], p[0] + p[1]))
FILE = """\
tubes:
  - name: a
    length: 100 mm
    outer_diameter: 1 mm
    inner_diameter: 0.5 mm
    material: nitinol
    limits: {rotation: [-90 deg, 90 deg], translation: [-60 mm, 0]}
tendons:
  - name: t
    tube: a
    routing: {kind: straight, x: 0 mm, y: 3 mm}
    limits: {tension: [0, 5 N], displacement: [-1 mm, 4 mm]}
"""


def _robot(tube: TubeLimits | None, tendon: TendonLimits | None, tension: float = 1.0) -> Robot:
    part = Tube("a", length=0.1, section=Annulus(1e-3, 5e-4), material=materials.nitinol, limits=tube)
    return Robot([part], [Tendon("t", "a", Straight(0, 3e-3), tension=tension, limits=tendon)])


def test_a_file_gives_the_limits():
    robot = loads(FILE)
    assert robot.tubes[0].limits == TubeLimits(rotation=(-math.pi / 2, math.pi / 2), translation=(-0.06, 0.0))
    assert robot.tendons[0].limits == TendonLimits(tension=(0.0, 5.0), displacement=(-0.001, 0.004))
    jsonschema.validate(read_yaml(FILE).data, json_schema())


@given(ranges, ranges)
def test_files_keep_them(rotation, displacement):
    robot = _robot(
        TubeLimits(rotation=rotation, translation=(-0.02, -0.01)), TendonLimits(displacement=displacement)
    )
    for format in ("yaml", "toml"):
        assert loads(dumps(robot, format=format), format=format) == robot


@pytest.mark.parametrize(
    ("make", "field", "words"),
    [
        (lambda: TubeLimits(rotation=(1.0, 1.0)), "rotation", "not below"),
        (lambda: TubeLimits(translation=(-0.1, 0.1)), "translation[1]", "behind it"),
        (lambda: TubeLimits(rotation=(0.0,)), "rotation", "1 entries"),
        (lambda: TendonLimits(tension=(-1.0, 2.0)), "tension[0]", "cannot push"),
        (lambda: TendonLimits(displacement=(0.0, math.nan)), "displacement[1]", "finite"),
        (lambda: TendonLimits(displacement=3.0), "displacement", "not a list"),  # pyright: ignore
        (lambda: _robot((0, 1), None), "limits", "TubeLimits"),  # pyright: ignore[reportArgumentType]
        (lambda: _robot(None, TubeLimits()), "limits", "TendonLimits"),  # pyright: ignore[reportArgumentType]
    ],
)
def test_wrong_limits_are_named(make, field, words):
    with pytest.raises(RobotError) as caught:
        make()
    assert caught.value.field == field
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("right", "wrong", "field", "line"),
    [
        ("[0, 5 N]", "[0, 5 mm]", "tendons[0].limits.tension[1]", 12),
        ("[0, 5 N]", "[6 N, 5 N]", "tendons[0].limits.tension", 12),
        ("[-60 mm, 0]", "[-60 mm, 2 mm]", "tubes[0].limits.translation[1]", 7),
        ("rotation:", "rotatoin:", "tubes[0].limits.rotatoin", 7),
    ],
)
def test_a_file_error_names_field_and_line(right, wrong, field, line):
    with pytest.raises(RobotFileError) as caught:
        loads(FILE.replace(right, wrong))
    assert (caught.value.field, caught.value.line) == (field, line)


def test_a_solve_takes_values_beyond_them():
    free = tactr.solve(_robot(None, None, 2.0))
    limited = tactr.solve(_robot(None, TendonLimits(tension=(0.0, 1.0)), 2.0))
    np.testing.assert_array_equal(limited.tip_position, free.tip_position)
