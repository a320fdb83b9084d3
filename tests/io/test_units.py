"""Quantities with units: exact conversion, exact writing, and what is refused."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tactr.io.unit_table import KINDS, coefficient_kind
from tactr.io.units import UnitError, format_quantity, kind, parse_quantity

FINITE = st.floats(
    allow_nan=False, allow_infinity=False, allow_subnormal=False, min_value=-1e200, max_value=1e200
)
USUAL = FINITE.filter(lambda value: value == 0 or abs(value) > 1e-200)


@pytest.mark.parametrize(
    ("text", "name", "value"),
    [
        ("140 mm", "length", 0.14),
        ("0.14m", "length", 0.14),
        ("1.07 mm", "length", 1.07e-3),
        ("-3.5e2 um", "length", -3.5e-4),
        ("1 µm", "length", 1e-6),
        ("1 inch", "length", 0.0254),
        ("65 GPa", "modulus", 65e9),
        ("500 N/mm^2", "modulus", 500e6),
        ("180 deg", "angle", math.pi),
        ("90°", "angle", math.pi / 2),
        ("1 turn", "angle", 2 * math.pi),
        ("0.5 deg/mm", "angle rate", math.radians(500)),
        ("10 1/m", "curvature", 10.0),
        ("0.01 1/mm", "curvature", 10.0),
        ("10 rad/m", "curvature", 10.0),
        ("5 N mm", "moment", 5e-3),
        ("5 Nmm", "moment", 5e-3),
        ("5 N*mm", "moment", 5e-3),
        ("5 N·mm", "moment", 5e-3),
        ("0.3 N/m", "force per length", 0.3),
        ("0.1 N m/m", "moment per length", 0.1),
        ("6450 kg/m^3", "density", 6450.0),
        ("6.45 g/cm³", "density", 6450.0),
        ("5000 N mm^2", "bending or torsional stiffness", 5e-3),
        ("9.81 m/s^2", "acceleration", 9.81),
        (0, "length", 0.0),
        ("0", "force", 0.0),
        (0.3, "number", 0.3),
    ],
)
def test_reads(text, name, value):
    assert parse_quantity(text, kind(name)) == value


@pytest.mark.parametrize(
    ("value", "name", "words"),
    [
        (140, "length", ["140 has no unit", 'a length such as "140 mm"', 'perhaps "140 mm"']),
        ("140", "length", ['"140" has no unit']),
        ("3 s", "length", ["is a time", "expected a length"]),
        ("5 N mm", "force", ["is a moment", "expected a force"]),
        ("5 N", "moment", ["is a force", "expected a moment"]),
        ("30 deg", "length", ["is an angle"]),
        ("30 mm", "angle", ["is a length", "expected an angle"]),
        ("5 m/s", "length", ["is a quantity in length^1 time^-1"]),
        ("10 1/m", "angle rate", ["is a curvature", "expected an angle rate"]),
        ("140 MM", "length", ["unknown unit 'MM'", "did you mean 'mm'"]),
        ("140 furlong", "length", ["unknown unit 'furlong'"]),
        ("mm", "length", ["does not start with a number"]),
        ("1,5 mm", "length", ["unknown unit"]),
        ("2*3 mm", "length", ["unknown unit"]),
        ("nan mm", "length", ["does not start with a number"]),
        ("inf mm", "length", ["does not start with a number"]),
        (math.nan, "number", ["not a finite number"]),
        (math.inf, "number", ["not a finite number"]),
        ("1e400 mm", "length", ["out of range"]),
        ("1e999999999 mm", "length", ["out of range"]),
        ("1e-399 mm", "length", ["out of range"]),
        ("1" * 100 + " mm", "length", ["too long"]),
        (True, "number", ["found True"]),
        (None, "length", ["found nothing"]),
        ([1], "length", ["found a list"]),
        ({}, "length", ["found a mapping"]),
    ],
)
def test_refuses(value, name, words):
    with pytest.raises(UnitError) as caught:
        parse_quantity(value, kind(name))
    for word in words:
        assert word in str(caught.value)


def test_bare_number_where_it_is_allowed():
    assert parse_quantity("3", kind("force"), bare="N") == 3.0


@pytest.mark.parametrize("name", list(KINDS))
def test_the_example_of_every_kind_is_right(name):
    assert math.isfinite(parse_quantity(kind(name).example, kind(name)))


@given(value=USUAL, name=st.sampled_from(list(KINDS)))
def test_writing_and_reading_is_the_identity(value, name):
    assert parse_quantity(format_quantity(value, kind(name)), kind(name)) == value


@given(value=USUAL, base=st.sampled_from(["length", "angle"]), power=st.integers(0, 15))
def test_coefficients_too(value, base, power):
    wanted = coefficient_kind(base, power)
    assert parse_quantity(format_quantity(value, wanted), wanted) == value


@pytest.mark.parametrize(
    ("value", "name", "text"),
    [
        (0.14, "length", "140 mm"),
        (math.pi / 2, "angle", "90 deg"),
        (math.radians(500), "angle rate", "0.5 deg/mm"),
        (45e9, "modulus", "45 GPa"),
        (1e-6, "force", "1e-6 N"),
        (-0.0, "length", "0 mm"),
    ],
)
def test_writes_as_people_do(value, name, text):
    assert format_quantity(value, kind(name)) == text
