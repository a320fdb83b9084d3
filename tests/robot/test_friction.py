"""Friction and backlash in the description of a robot, and in robot files."""

import math

import pytest

import tactr
from tactr import Annulus, Robot, RobotError, Straight, Tendon, Tube, materials
from tactr.io import loads
from tactr.statics.parameters import value_of, with_value

TEXT = """
tubes:
  - name: a
    length: 100 mm
    outer_diameter: 2 mm
    inner_diameter: 1 mm
    material: nitinol
    rotation_play: 3 deg
    translation_play: 0.2 mm
tendons:
  - name: t
    tube: a
    routing: {kind: straight, x: 0.6 mm, y: 0 mm}
    tension: 1 N
    friction: [{from: 0 mm, coefficient: 0.1}, {from: 50 mm, coefficient: 0.3}]
    contacts: [20 mm, 60 mm]
    play: 0.5 mm
"""


def tendon(**fields):
    return Tendon("t", "a", Straight(6e-4, 0), **fields)


def robot(**fields):
    tube = Tube("a", length=0.1, section=Annulus(2e-3, 1e-3), material=materials.nitinol)
    return Robot([tube], [tendon(**fields)])


def test_a_file_gives_friction_and_backlash():
    read = loads(TEXT)
    (t,), (tube,) = read.tendons, read.tubes
    assert t.friction == ((0.0, 0.1), (0.05, 0.3)) and t.contacts == (0.02, 0.06)
    assert t.play == pytest.approx(5e-4)
    assert (tube.rotation_play, tube.translation_play) == pytest.approx((math.radians(3), 2e-4))
    assert loads(
        TEXT.replace("[{from: 0 mm, coefficient: 0.1}, {from: 50 mm, coefficient: 0.3}]", "0.2")
    ).tendons[0].friction == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("coefficient: 0.3", "coefficient: -0.3", r"tendons\[0\].friction\[1\].coefficient"),
        ("{from: 0 mm,", "{from: 1 mm,", r"friction\[0\]"),
        ("{from: 50 mm,", "{from: 150 mm,", r"friction\[1\].from"),
        ("contacts: [20 mm, 60 mm]", "contacts: [60 mm, 20 mm]", "contacts"),
        ("contacts: [20 mm, 60 mm]", "contacts: [20 mm, 160 mm]", r"contacts\[1\]"),
        ("play: 0.5 mm", "play: -0.5 mm", "play"),
        ("rotation_play: 3 deg", "rotation_play: 3 mm", "rotation_play"),
    ],
)
def test_a_wrong_file_is_told_where(old, new, words):
    assert old in TEXT
    with pytest.raises(tactr.FileError, match=words):
        loads(TEXT.replace(old, new))


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"friction": -0.1}, "friction"),
        ({"friction": math.nan}, "friction"),
        ({"friction": "0.1"}, "friction"),
        ({"friction": []}, "friction"),
        ({"friction": [(0.0, 0.1), (0.0, 0.2)]}, "friction"),
        ({"friction": [0.1, 0.2]}, "friction[0]"),
        ({"contacts": []}, "contacts"),
        ({"contacts": [-0.01]}, "contacts"),
        ({"play": -1e-3}, "play"),
    ],
)
def test_wrong_fields_are_named(fields, field):
    with pytest.raises(RobotError) as caught:
        tendon(**fields)
    assert caught.value.field.startswith(field)


def test_the_coefficient_has_a_path():
    assert value_of(robot(friction=0.2), "tendons.t.friction") == 0.2
    assert with_value(robot(friction=0.2), "tendons.t.friction", 0.3).tendons[0].friction == 0.3
    pieces = with_value(robot(friction=[(0, 0.1), (0.05, 0.2)]), "tendons.t.friction.1.1", 0.4)
    assert pieces.tendons[0].friction == ((0.0, 0.1), (0.05, 0.4))


def test_a_plain_solve_says_what_it_leaves_out():
    plain, rough = (
        tactr.solve(robot(), tension=[2.0]),
        tactr.solve(robot(friction=0.2, play=1e-3), tension=[2.0]),
    )
    assert "without the friction of 't' and the backlash of 't'" in rough.message
    assert "without" not in plain.message
    assert (rough.tip_position == plain.tip_position).all()
