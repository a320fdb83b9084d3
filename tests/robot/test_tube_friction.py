"""Friction of tubes as a description: checked, kept by files, its numbers found by their paths."""

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tactr
from tactr import Annulus, Robot, RobotError, Tube, TubeFriction, materials
from tactr.io import RobotFileError, dumps, loads
from tactr.io.layout import json_schema
from tactr.io.read_yaml import read_yaml
from tactr.robot import Stiffness
from tactr.statics.parameters import value_of, with_value

FILE = """\
tubes:
  - name: outer
    length: 100 mm
    outer_diameter: 1.5 mm
    inner_diameter: 1.1 mm
    material: nitinol
    friction: 0.2
  - name: inner
    length: 150 mm
    outer_diameter: 1 mm
    inner_diameter: 0.5 mm
    material: nitinol
    friction: {coefficient: 0.1, radius: 0.52 mm, lever: 4 mm}
"""
positive = st.floats(1e-6, 1e3)


def _tube(friction: TubeFriction | float | None) -> Tube:
    return Tube("a", length=0.1, section=Annulus(1e-3, 5e-4), material=materials.nitinol, friction=friction)


def test_a_file_gives_it():
    robot = loads(FILE)
    assert robot.tubes[0].friction == TubeFriction(0.2)
    assert robot.tubes[1].friction == TubeFriction(0.1, radius=0.52e-3, lever=4e-3)
    jsonschema.validate(read_yaml(FILE).data, json_schema())


@given(st.builds(TubeFriction, st.just(0.0) | positive, st.none() | positive, st.none() | positive))
def test_files_keep_it(friction):
    robot = Robot([_tube(friction)])
    for format in ("yaml", "toml"):
        assert loads(dumps(robot, format=format), format=format) == robot


def test_paths_name_its_numbers():
    robot = loads(FILE)
    assert value_of(robot, "tubes.inner.friction.coefficient") == 0.1
    moved = with_value(robot, "tubes.outer.friction.coefficient", 0.3)
    assert moved.tubes[0].friction == TubeFriction(0.3)


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        (-0.1, "friction: -0.1 is too small"),
        ("rough", "friction: 'rough' is text, not a number"),
        ([0.1], "is not a number"),
        (float("nan"), "is not a finite number"),
    ],
)
def test_bad_coefficients(friction, words):
    with pytest.raises(RobotError, match="a coefficient of at least 0") as error:
        _tube(friction)
    assert words in str(error.value)


@pytest.mark.parametrize("field", ["radius", "lever"])
def test_bad_lengths(field):
    with pytest.raises(RobotError, match=f"{field}: 0 m is too small"):
        TubeFriction(0.1, **{field: 0.0})


def test_a_radius_is_needed_somewhere():
    section = Stiffness(EA=1e5, GA=1e5, EI_x=1e-2, EI_y=1e-2, GJ=1e-2)
    with pytest.raises(RobotError, match=r"friction\.radius: the tube's outer diameter is not known"):
        Tube("a", length=0.1, section=section, friction=0.1)
    assert Tube("a", length=0.1, section=section, friction=TubeFriction(0.1, 1e-3)).friction


def test_a_file_error_names_its_place():
    with pytest.raises(RobotFileError, match=r"tubes\[0\]\.friction"):
        loads(FILE.replace("friction: 0.2", "friction: -0.2"))
    with pytest.raises(RobotFileError, match="coefficient"):
        loads(FILE.replace("coefficient: 0.1, ", ""))


def test_a_plain_solve_has_no_friction():
    robot = loads(FILE)
    bare = robot.replace(tubes=tuple(_without(tube) for tube in robot.tubes))
    assert (tactr.solve(robot).tip_position == tactr.solve(bare).tip_position).all()


def _without(tube: Tube) -> Tube:
    return Tube(tube.name, length=tube.length, section=tube.section, material=tube.material)
