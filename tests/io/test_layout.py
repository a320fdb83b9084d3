"""The layout of robot files: every routing and load, and the JSON Schema that describes them."""

import math

import jsonschema
import pytest
from ruamel.yaml import YAML

from tactr import examples
from tactr.io import loads
from tactr.io.layout import json_schema
from tactr.robot import (
    Annulus,
    DistributedLoad,
    Gravity,
    Helix,
    Piecewise,
    PointLoad,
    PolarPolynomial,
    Polynomial,
    Rod,
    Spline,
    Stiffness,
    Straight,
    TensionProfile,
)

TUBE = "tubes: [{name: a, length: 100 mm, diameter: 1 mm, material: nitinol}]\n"


def plain(text):
    return YAML(typ="safe", pure=True).load(text)


def validator():
    return jsonschema.Draft202012Validator(json_schema())


@pytest.mark.parametrize(
    ("text", "routing"),
    [
        ("{kind: straight, x: 1 mm, y: -2 mm}", Straight(1e-3, -2e-3)),
        ("{kind: straight, radius: 2 mm, angle: 90 deg}", Straight.polar(2e-3, math.pi / 2)),
        ("{kind: helix, radius: 2 mm, rate: 1 rad/m}", Helix(2e-3, 1.0)),
        ("{kind: helix, radius: 2 mm, pitch: 100 mm, phase: 1 rad}", Helix.from_pitch(2e-3, 0.1, 1.0)),
        ("{kind: polynomial, x: [1 mm, 0.01, 2 1/m], y: [0]}", Polynomial((1e-3, 0.01, 2.0), (0.0,))),
        (
            "{kind: polar_polynomial, radius: [1 mm, 0.01], angle: [90 deg, 0, 2 rad/m^2]}",
            PolarPolynomial((1e-3, 0.01), (math.pi / 2, 0.0, 2.0)),
        ),
        (
            "{kind: spline, sigma: [0, 50 mm, 100 mm], points: [[1 mm, 0], [0, 1 mm], [1 mm, 1 mm]]}",
            Spline((0.0, 0.05, 0.1), ((1e-3, 0.0), (0.0, 1e-3), (1e-3, 1e-3))),
        ),
        (
            "{kind: piecewise, parts: [{from: 0, routing: {kind: straight, x: 1 mm, y: 0}},"
            " {from: 50 mm, routing: {kind: polynomial, x: [1 mm], y: [-5 mm, 0.1]}}]}",
            Piecewise(((0.0, Straight(1e-3, 0.0)), (0.05, Polynomial((1e-3,), (-5e-3, 0.1))))),
        ),
    ],
)
def test_routings(text, routing):
    whole = f"{TUBE}tendons: [{{name: t, tube: a, routing: {text}}}]"
    assert loads(whole).tendons[0].routing == routing
    validator().validate(plain(whole))


@pytest.mark.parametrize(
    ("text", "load"),
    [
        ("{kind: point, tube: a, force: [1 N, 0, 0]}", PointLoad("a", force=(1.0, 0.0, 0.0))),
        (
            "{kind: point, tube: a, moment: [0, 5 N mm, 0], at: 50 mm, axes: body}",
            PointLoad("a", moment=(0.0, 5e-3, 0.0), at=0.05, axes="body"),
        ),
        ("{kind: distributed, force: [0.3 N/m, 0, 0]}", DistributedLoad(force=(0.3, 0.0, 0.0))),
        (
            "{kind: distributed, tube: a, moment: [0, 0, 1 N m/m], start: 10 mm, end: 20 mm}",
            DistributedLoad("a", moment=(0.0, 0.0, 1.0), start=0.01, end=0.02),
        ),
        ("{kind: gravity}", Gravity()),
        ("{kind: gravity, acceleration: [9.81 m/s^2, 0, 0]}", Gravity((9.81, 0.0, 0.0))),
    ],
)
def test_loads(text, load):
    whole = f"{TUBE}loads: [{text}]"
    assert loads(whole).loads == (load,)
    validator().validate(plain(whole))


@pytest.mark.parametrize(
    ("text", "section"),
    [
        ("outer_diameter: 1 mm, inner_diameter: 0.5 mm, material: nitinol", Annulus(1e-3, 0.5e-3)),
        ("diameter: 1 mm, material: nitinol", Rod(1e-3)),
        (
            "stiffness: {EA: 1 kN, GA: 2 kN, EI_x: 3 N mm^2, EI_y: 4 N mm^2, GJ: 5 N mm^2},"
            " outer_diameter: 2 mm",
            Stiffness(EA=1e3, GA=2e3, EI_x=3e-6, EI_y=4e-6, GJ=5e-6, outer_diameter=2e-3),
        ),
    ],
)
def test_sections(text, section):
    whole = f"tubes: [{{name: a, length: 100 mm, {text}}}]"
    assert loads(whole).tubes[0].section == section
    validator().validate(plain(whole))


def test_tension_profile():
    text = f"{TUBE}tendons: [{{name: t, tube: a, routing: {{kind: straight, x: 1 mm, y: 0}}, tension: %s}}]"
    profile = loads(text % "{sigma: [0, 0.1 m], values: [2 N, 1 N]}").tendons[0].tension
    assert profile == TensionProfile((0.0, 0.1), (2.0, 1.0))


@pytest.mark.parametrize("name", examples.names())
def test_the_schema_accepts_the_examples(name):
    validator().validate(plain(examples.path(name).read_text()))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("length: 140 mm", "lenght: 140 mm"),
        ("length: 140 mm", "length: 140"),
        ("length: 140 mm", "length: 140 deg"),
        ("length: 140 mm", "length: mm"),
        ("host: outermost", "host: outer"),
        ("kind: straight", "kind: strait"),
        ("    inner_diameter: 0.85 mm\n", ""),
        ("tension: 3 N", "tension: 3 mm"),
        ("tubes:\n", "tube:\n"),
    ],
)
def test_the_schema_refuses_what_load_refuses(old, new):
    text = examples.path("two_tube_90").read_text()
    assert old in text
    assert not validator().is_valid(plain(text.replace(old, new, 1)))


def test_the_schema_describes_every_key():
    def check(schema):
        if isinstance(schema, dict):
            for key, value in schema.get("properties", {}).items():
                assert key == "kind" or value.get("description"), key
            for value in schema.values():
                check(value)
        elif isinstance(schema, list):
            for value in schema:
                check(value)

    validator().check_schema(json_schema())
    check(json_schema())
