"""The layout of a tube in a robot file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tactr.io.fields import Block, Coefficients, Items, Text, quantity, vector
from tactr.io.records import Either, Field, Record, Variants, given

LENGTH, ANGLE, MODULUS = quantity("length"), quantity("angle"), quantity("modulus")
CURVATURE = vector("curvature")


def along(base: str) -> Either:
    """A quantity of the kind ``base``, or a mapping that says how it varies along the tube."""
    part = Record(
        "A polynomial from one arc length of the tube on.",
        {
            "from": Field(LENGTH, 'arc length where it begins, such as "60 mm"', required=True),
            "coefficients": Field(
                Coefficients(base), "in ascending powers of the arc length from there on", required=True
            ),
        },
    )
    varying = Record(
        "A quantity that varies along the tube: polynomials, or values at some places.",
        {
            "parts": Field(Items(part), "polynomials one after the other, the first from 0 mm"),
            "end": Field(LENGTH, "arc length where the last of the parts stops being defined"),
            "sigma": Field(Items(LENGTH), 'arc lengths of the values, such as ["0 mm", "140 mm"]'),
            "values": Field(Items(quantity(base)), "the values there"),
            "joined": Field(
                Text(("straight", "smooth")), "how: straight lines (the default) or a cubic spline"
            ),
        },
        given("parts", "parts end", "sigma values", "sigma values joined"),
    )
    return Either(varying, quantity(base))


@dataclass(frozen=True, eq=False, repr=False)
class Pieces:
    """``one`` for the whole length, or a list of mappings, each from one arc length on."""

    one: Block
    pieces: Items

    def _block(self, value: Any) -> Block:
        listed = isinstance(value, list) and value and isinstance(value[0], dict) and "from" in value[0]
        return self.pieces if listed else self.one

    def read(self, value: Any, path: Any, report: Any) -> Any:
        return self._block(value).read(value, path, report)

    def schema(self) -> dict[str, Any]:
        return {"anyOf": [self.one.schema(), self.pieces.schema()]}


MATERIAL = Record(
    "A material given by its constants.",
    {
        "E": Field(MODULUS, 'Young\'s modulus, such as "65 GPa"', required=True),
        "G": Field(MODULUS, 'shear modulus, such as "24.4 GPa"'),
        "nu": Field(quantity("number"), "Poisson's ratio, instead of G"),
        "density": Field(quantity("density"), 'such as "6450 kg/m^3"; needed where gravity acts'),
        "name": Field(Text(), "what people call it"),
        "source": Field(Text(), "where the constants come from"),
    },
    given("G", "nu"),
)
ANY_MATERIAL = Either(MATERIAL, Text())
MATERIAL_PIECE = Record(
    "The material from one arc length of the tube on.",
    {
        "from": Field(LENGTH, 'arc length where it begins, such as "60 mm"', required=True),
        "material": Field(ANY_MATERIAL, "as for a whole tube", required=True),
    },
)
EXTENSION, BENDING = along("axial or shear stiffness"), along("bending or torsional stiffness")
STIFFNESS = Record(
    "The stiffness of a section given directly, for notched, printed or calibrated tubes.",
    {
        "EA": Field(EXTENSION, 'axial stiffness, such as "12 kN"', required=True),
        "GA": Field(EXTENSION, 'shear stiffness, such as "5 kN"', required=True),
        "EI_x": Field(
            BENDING, 'stiffness of bending about the tube\'s own x axis, such as "5000 N mm^2"', required=True
        ),
        "EI_y": Field(
            BENDING, 'stiffness of bending about the tube\'s own y axis, such as "5000 N mm^2"', required=True
        ),
        "GJ": Field(BENDING, 'torsional stiffness, such as "4000 N mm^2"', required=True),
        "neutral_axis": Field(
            Items(along("length"), 2), '(x, y) where an axial force bends nothing, such as [0, "-0.5 mm"]'
        ),
        "linear_density": Field(
            quantity("linear density"), 'mass per length, such as "2 g/m"; needed where gravity acts'
        ),
    },
)


def _notches(kind: str, doc: str) -> Record:
    return Record(
        doc,
        {
            "depth": Field(LENGTH, 'depth of a cut from the outside, such as "0.8 mm"', required=True),
            "cut": Field(LENGTH, 'length of a cut along the tube, such as "0.5 mm"', required=True),
            "uncut": Field(LENGTH, "length between two cuts", required=True),
            "side": Field(Text(("+x", "-x", "+y", "-y")), "where the (first) cut is; default +y"),
        },
        kind=kind,
    )


NOTCHES = Variants(
    "notches",
    lambda: (
        _notches("asymmetric", "Cuts from one side, all in a row."),
        _notches("staggered", "Cuts from one side and the opposite side by turns."),
        _notches("symmetric", "Pairs of opposite cuts."),
    ),
)
SECTION = {
    "outer_diameter": Field(LENGTH, 'outer diameter, such as "1.35 mm"; also allowed beside stiffness'),
    "inner_diameter": Field(LENGTH, 'bore, such as "1.07 mm"; also allowed beside stiffness'),
    "diameter": Field(LENGTH, "diameter of a solid rod"),
    "stiffness": Field(STIFFNESS, "stiffness of the section, instead of diameters and material"),
    "notches": Field(NOTCHES, "cuts in the wall, beside outer_diameter and inner_diameter"),
}
SECTIONS = (
    "outer_diameter inner_diameter",
    "outer_diameter inner_diameter notches",
    "diameter",
    "stiffness",
    "stiffness outer_diameter",
    "stiffness inner_diameter",
    "stiffness outer_diameter inner_diameter",
)
CHOICE = "outer_diameter and inner_diameter (also with notches), or diameter (a solid rod), or stiffness"
SECTION_PIECE = Record(
    "The section from one arc length of the tube on.",
    {"from": Field(LENGTH, 'arc length where it begins, such as "60 mm"', required=True), **SECTION},
    given(*SECTIONS),
    choice=CHOICE,
)
REST_PIECE = Record(
    "The rest shape from one arc length of the tube on.",
    {
        "from": Field(LENGTH, 'arc length where this rest curvature begins, such as "60 mm"', required=True),
        "u": Field(CURVATURE, 'rest curvature and twist, such as ["10 1/m", 0, 0]', required=True),
    },
)
START = Field(LENGTH, "arc length of the tube where it begins, straight before; default 0")
REST = Variants(
    "rest",
    lambda: (
        Record(
            "A helix.",
            {
                "radius": Field(LENGTH, 'radius of the coil, such as "10 mm"', required=True),
                "pitch": Field(LENGTH, "rise of one turn; negative is left-handed", required=True),
                "start": START,
            },
            kind="helix",
        ),
        Record(
            "A smooth curve through points; its frame turns least, or is given.",
            {
                "points": Field(Items(vector("length")), "at least 4 points (x, y, z)", required=True),
                "sigma": Field(Items(LENGTH), "arc length of every point, the first 0; default: as measured"),
                "frames": Field(
                    Items(Items(Items(quantity("number"), 3), 3)),
                    "rotation matrix at every point, rows of numbers, columns the tube's axes; needs sigma",
                ),
                "smoothing": Field(LENGTH, "root mean square distance that the curve may keep; default 0"),
                "start": START,
            },
            kind="points",
        ),
        Record(
            "Rest strains along the tube.",
            {
                "u": Field(Items(along("curvature"), 3), "rest curvature and twist; default none"),
                "v": Field(Items(along("number"), 3), "rest shear and stretch; default [0, 0, 1]"),
            },
            kind="strains",
        ),
    ),
)
TUBE_LIMITS = Record(
    "How far a tube's actuators go: [least, most].",
    {
        "rotation": Field(Items(ANGLE, 2), 'such as ["-180 deg", "180 deg"]'),
        "translation": Field(Items(LENGTH, 2), 'z of the proximal end, such as ["-60 mm", 0]'),
    },
)
TUBE_FRICTION = Either(
    Record(
        "Coulomb friction of the tube that turns in the next body around it.",
        {
            "coefficient": Field(quantity("number"), "of friction, at least 0", required=True),
            "radius": Field(LENGTH, "of the contact; default half the tube's outer diameter"),
            "lever": Field(
                LENGTH,
                "over which a concentrated contact moment is borne by two forces; default two diameters",
            ),
        },
    ),
    quantity("number"),
)
TUBE = Record(
    "One tube: its section is outer_diameter and inner_diameter, or diameter (a solid rod), or stiffness; or "
    "sections, one after the other.",
    {
        "name": Field(Text(), "a text by which tendons, loads and commands refer to the tube", required=True),
        "length": Field(LENGTH, 'length of the whole tube, such as "140 mm"', required=True),
        **SECTION,
        "sections": Field(Items(SECTION_PIECE), "sections one after the other, the first from 0 mm"),
        "material": Field(
            Pieces(ANY_MATERIAL, Items(MATERIAL_PIECE)),
            "the name of a preset such as nitinol, or E and one of G and nu; or pieces",
        ),
        "precurvature": Field(
            Pieces(Either(REST, CURVATURE), Items(REST_PIECE)),
            'rest curvature and twist in the tube\'s own frame, such as ["10 1/m", 0, 0], or pieces, or a '
            "helix, points or strains",
        ),
        "translation": Field(
            LENGTH, "z of the proximal end: 0 at the guide's exit (the default), negative behind it"
        ),
        "rotation": Field(ANGLE, "angle about +z imposed at the proximal end; default 0"),
        "rotation_compliance": Field(
            quantity("torsional compliance"), 'of what turns it, in series, such as "0.1 deg/N/mm"; default 0'
        ),
        "translation_compliance": Field(
            quantity("compliance"), 'of what moves it, in series, such as "0.01 mm/N"; default 0'
        ),
        "limits": Field(TUBE_LIMITS, "how far its actuators go, for sliders"),
        "rotation_play": Field(ANGLE, "whole backlash of its rotation; default 0"),
        "translation_play": Field(LENGTH, "whole backlash of its translation; default 0"),
        "friction": Field(
            TUBE_FRICTION,
            "of the tube that turns in the next outer tube, the outermost one in the guide: a coefficient, "
            "or with radius and lever",
        ),
    },
    given(*SECTIONS, "sections"),
    choice=f"{CHOICE}, or sections",
)
