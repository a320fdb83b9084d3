"""Robot files with tubes that vary along their length."""

import math
import warnings
from typing import Any

import jsonschema
import pytest
from ruamel.yaml import YAML

from tactr import materials
from tactr.errors import FileError
from tactr.io import dumps, loads
from tactr.io.layout import json_schema
from tactr.robot import (
    Along,
    Annulus,
    AsymmetricNotches,
    Material,
    RestShape,
    Robot,
    Rod,
    Stiffness,
    SymmetricNotches,
    Tube,
    VaryingStiffness,
)

STIFF: dict[str, Any] = {"EA": 1e4, "GA": 3e3, "EI_x": 1e-3, "EI_y": 1e-3, "GJ": 8e-4}
NOTCHES: dict[str, Any] = {
    "outer_diameter": 1.6e-3,
    "inner_diameter": 1.4e-3,
    "depth": 1.1e-3,
    "cut": 0.3e-3,
    "uncut": 0.7e-3 / 3,
}
POLYNOMIAL = Along([(0.0, (1e-3, -0.002 / 3, 1.7e-2)), (0.05, (9e-4,)), (0.07, (1e-3, 0, 0, 0.1, -1 / 3))])
CURVE = [(2e-3 * k**2, 1e-3 * math.sin(k), 1e-2 * k) for k in range(8)]

TUBES = {
    "polynomials": {
        "section": VaryingStiffness(**{**STIFF, "EI_x": POLYNOMIAL, "GJ": Along([(0.0, (1e-3,))], 0.2)})
    },
    "function": {
        "section": VaryingStiffness.function(
            lambda s: Rod(1e-3 * math.exp(-s)), 0.1, material=Material(E=5e10, nu=0.3)
        )
    },
    "offset": {
        "section": VaryingStiffness(
            **STIFF, neutral_axis=(Along.linear([0, 0.1], [0, 1e-4 / 3]), -1e-4), outer_diameter=1e-3
        )
    },
    "sections": {
        "section": [
            (0.0, Annulus(1.6e-3, 1.4e-3)),
            (0.03, AsymmetricNotches(**NOTCHES, side="-x")),
            (0.06, SymmetricNotches(**{**NOTCHES, "depth": 0.6e-3})),
            (0.07, Stiffness(**STIFF)),
        ],
        "material": [(0.0, materials.nitinol), (0.02, Material(E=2e11, G=8e10, name="steel"))],
    },
    "staggered": {"section": AsymmetricNotches(**NOTCHES, staggered=True), "material": materials.nitinol},
    "helix": {
        "section": Rod(1e-3),
        "material": materials.nitinol,
        "precurvature": RestShape.helix(1e-2, 0.03),
    },
    "late helix": {
        "section": Rod(1e-3),
        "material": materials.nitinol,
        "precurvature": RestShape.helix(1e-2, 0.03, start=0.06),
    },
    "stretch": {
        "section": Stiffness(**STIFF),
        "precurvature": RestShape(v=(0.1, 0, Along.spline([0, 0.05, 0.1], [1, 1.1, 1.05]))),
    },
    "points": {"section": Stiffness(**STIFF), "precurvature": RestShape.from_points(CURVE, start=0.02)},
}


def robot_of(values: dict[str, Any]) -> Robot:
    length = 0.08 if "precurvature" in values else 0.1
    return Robot([Tube("a", length=length, **values)])


@pytest.mark.parametrize("format", ["yaml", "toml"])
@pytest.mark.parametrize("name", TUBES)
def test_round_trip(name: str, format: Any) -> None:
    robot = robot_of(TUBES[name])
    text = dumps(robot, format=format)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read = loads(text, format=format)
    assert read == robot
    assert dumps(read, format=format) == text


@pytest.mark.parametrize("name", TUBES)
def test_what_is_saved_fits_the_schema(name: str) -> None:
    data = YAML(typ="safe").load(dumps(robot_of(TUBES[name]), format="yaml"))
    jsonschema.Draft202012Validator(json_schema()).validate(data)


HEAD = "tubes:\n  - name: a\n    length: 100 mm\n"
STIFFNESS = "    stiffness: {EA: 10 kN, GA: 3 kN, EI_x: %s, EI_y: 1000 N mm^2, GJ: 800 N mm^2}\n"
ROD = "    diameter: 1 mm\n    material: nitinol\n"


def tube_in(text: str) -> Tube:
    return loads(HEAD + text, format="yaml").tubes[0]


def test_values_joined() -> None:
    values = "sigma: [0 mm, 50 mm, 100 mm], values: [1000 N mm^2, 900 N mm^2, 700 N mm^2]"
    straight, smooth = (
        Along.linear([0, 0.05, 0.1], [1e-3, 9e-4, 7e-4]),
        Along.spline([0, 0.05, 0.1], [1e-3, 9e-4, 7e-4]),
    )
    for joined, expected in (("", straight), (", joined: straight", straight), (", joined: smooth", smooth)):
        assert tube_in(STIFFNESS % f"{{{values}{joined}}}").parts[0].stiffness.EI_x == expected


def test_rest_shapes() -> None:
    helix = "    precurvature: {kind: helix, radius: 10 mm, pitch: 30 mm, start: 20 mm}\n"
    assert tube_in(ROD + helix).precurvature == RestShape.helix(0.01, 0.03, start=0.02)
    points = [(0.0, 0.0, 0.03 * k) for k in range(5)]
    listed = ", ".join(f"[{x:g} mm, {y:g} mm, {z * 1e3:g} mm]" for x, y, z in points)
    rest = tube_in(f"{ROD}    precurvature: {{kind: points, points: [{listed}]}}\n").precurvature
    assert rest == RestShape()
    frames = ", ".join(["[[1, 0, 0], [0, 1, 0], [0, 0, 1]]"] * 5)
    framed = f"sigma: [0 mm, 30 mm, 60 mm, 90 mm, 120 mm], frames: [{frames}]"
    assert (
        tube_in(f"{ROD}    precurvature: {{kind: points, points: [{listed}], {framed}}}\n").precurvature
        == RestShape()
    )
    strains = "    precurvature: {kind: strains, u: [10 1/m, 0, 0], v: [0, 0, 1.1]}\n"
    assert tube_in(ROD + strains).precurvature == RestShape((10.0, 0.0, 0.0), (0.0, 0.0, 1.1))


WRONG = [
    (
        STIFFNESS % "{parts: [{from: 0 mm, coefficients: [1 N]}]}",
        "tubes[0].stiffness.EI_x.parts[0].coefficients[0]",
        "force",
    ),
    (
        STIFFNESS % "{parts: [{from: 1 mm, coefficients: [1 N m^2]}]}",
        "tubes[0].stiffness.EI_x.parts[0]",
        "first start of 0",
    ),
    (
        STIFFNESS % "{parts: [{from: 0 mm, coefficients: [1 N m^2, 1 N]}]}",
        "tubes[0].stiffness.EI_x.parts[0].coefficients[1]",
        "N m",
    ),
    (
        STIFFNESS % "{parts: [{from: 0 mm, coefficients: [1e-3 N m^2, -0.02 N m]}]}",
        "tubes[0].stiffness.EI_x",
        "falls to",
    ),
    (
        STIFFNESS % "{sigma: [0 mm, 50 mm], values: [1 N m^2, 1 N m^2]}",
        "tubes[0].stiffness.EI_x",
        "used to 0.1 m",
    ),
    (STIFFNESS % "{sigma: [0 mm, 50 mm], values: [1 N m^2]}", "tubes[0].stiffness.EI_x.values", "1 entries"),
    (STIFFNESS % "{sigma: [0 mm, 50 mm]}", "tubes[0].stiffness.EI_x", "has sigma"),
    ("    sections: []\n", "tubes[0].sections", "empty"),
    (
        "    sections: [{from: 1 mm, diameter: 1 mm}]\n    material: nitinol\n",
        "tubes[0].sections[0]",
        "starts at 0",
    ),
    ("    sections: [{from: 0 mm}]\n    material: nitinol\n", "tubes[0].sections[0]", "none of the keys"),
    ("    sections: [{from: 0 mm, diameter: 1 mm}]\n    diameter: 1 mm\n", "tubes[0]", "diameter"),
    (
        "    diameter: 1 mm\n    material: [{from: 0 mm, material: nylon}, {from: 0.2 m, material: nylon}]\n",
        "tubes[0].material[1]",
        "tube's end",
    ),
    (
        "    diameter: 1 mm\n    material: [{from: 0 mm, material: butter}]\n",
        "tubes[0].material[0].material",
        "butter",
    ),
    (
        "    outer_diameter: 1 mm\n    inner_diameter: 0.8 mm\n    material: nitinol\n"
        "    notches: {kind: asymmetric, depth: 2 mm, cut: 1 mm, uncut: 1 mm}\n",
        "tubes[0].notches.depth",
        "too large",
    ),
    (
        ROD + "    precurvature: {kind: helix, radius: 0 mm, pitch: 1 mm}\n",
        "tubes[0].precurvature.radius",
        "above 0",
    ),
    (ROD + "    precurvature: {kind: spiral}\n", "tubes[0].precurvature.kind", "spiral"),
    (ROD + "    precurvature: {kind: strains, v: [0, 0, -1]}\n", "tubes[0].precurvature.v[2]", "above 0"),
    (
        ROD + "    precurvature: {kind: points, points: [[0, 0, 0], [0, 0, 1 mm]]}\n",
        "tubes[0].precurvature.points",
        "at least 4",
    ),
]


@pytest.mark.parametrize(("text", "field", "words"), WRONG)
def test_errors_name_the_field(text: str, field: str, words: str) -> None:
    with pytest.raises(FileError) as caught:
        tube_in(text)
    assert words in str(caught.value)
    assert f"{field}: " in str(caught.value)
