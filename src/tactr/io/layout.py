"""The layout of a robot file: what `tactr.load` accepts and `tactr schema` prints."""

from __future__ import annotations

from typing import Any

from tactr.io.fields import Coefficients, Items, Text, quantity, vector
from tactr.io.layout_tube import NOTCHES, REST, TUBE, Pieces
from tactr.io.records import Either, Field, Record, Texts, Variants, given

LENGTH, ANGLE, FORCE = quantity("length"), quantity("angle"), quantity("force")
AXES = Text(("world", "body"))


def _routings() -> tuple[Record, ...]:
    return (STRAIGHT, HELIX, POLYNOMIAL, POLAR_POLYNOMIAL, SPLINE, PIECEWISE)


ROUTING = Variants("routing", _routings)

STRAIGHT = Record(
    "Parallel to the tube, at (x, y) or at a radius and an angle.",
    {
        "x": Field(LENGTH, "offset along the tube's own x axis"),
        "y": Field(LENGTH, "offset along the tube's own y axis"),
        "radius": Field(LENGTH, "distance from the tube's axis"),
        "angle": Field(ANGLE, "angle from the tube's own x axis towards y"),
    },
    given("x y", "radius angle"),
    kind="straight",
)
HELIX = Record(
    "Wound round the tube: angle = rate * arc length + phase.",
    {
        "radius": Field(LENGTH, 'distance from the tube\'s axis, such as "6.5 mm"', required=True),
        "rate": Field(quantity("angle rate"), 'angle per arc length, such as "0.5 deg/mm"'),
        "pitch": Field(LENGTH, "arc length of one turn, instead of rate; negative is left-handed"),
        "phase": Field(ANGLE, "angle at the tube's proximal end; default 0"),
    },
    given("rate", "pitch"),
    kind="helix",
)
POLYNOMIAL = Record(
    "x and y as polynomials of the arc length, ascending powers.",
    {
        "x": Field(
            Coefficients("length"), 'coefficients of x, such as ["6.5 mm", 0.01, "2 1/m"]', required=True
        ),
        "y": Field(
            Coefficients("length"), 'coefficients of y, such as ["6.5 mm", 0.01, "2 1/m"]', required=True
        ),
    },
    kind="polynomial",
)
POLAR_POLYNOMIAL = Record(
    "Radius and angle as polynomials of the arc length, ascending powers.",
    {
        "radius": Field(
            Coefficients("length"), 'coefficients of the radius, such as ["6.5 mm"]', required=True
        ),
        "angle": Field(
            Coefficients("angle"), 'coefficients of the angle, such as ["90 deg", "2 rad/m"]', required=True
        ),
    },
    kind="polar_polynomial",
)
SPLINE = Record(
    "A smooth curve (cubic spline) through points.",
    {
        "sigma": Field(Items(LENGTH), 'arc lengths of the points, such as ["0 mm", "140 mm"]', required=True),
        "points": Field(
            Items(Items(LENGTH, 2)),
            '(x, y) at each of them, such as [["6 mm", 0], [0, "6 mm"]]',
            required=True,
        ),
    },
    kind="spline",
)
PART = Record(
    "One part of a piecewise routing.",
    {
        "from": Field(LENGTH, 'arc length where the part begins, such as "60 mm"', required=True),
        "routing": Field(
            ROUTING, "its routing, a function of the arc length of the whole tube", required=True
        ),
    },
)
PIECEWISE = Record(
    "Routings one after the other, each meeting the one before; the direction may jump.",
    {"parts": Field(Items(PART), "the parts, in order, the first from 0 mm", required=True)},
    kind="piecewise",
)

PROFILE = Record(
    "A tension that varies along the tendon, straight between samples.",
    {
        "sigma": Field(Items(LENGTH), 'arc lengths, such as ["0 mm", "140 mm"]', required=True),
        "values": Field(Items(FORCE), 'tensions there, such as ["3 N", "2.5 N"]', required=True),
    },
)
TENDON_LIMITS = Record(
    "How far a tendon's actuator goes: [least, most].",
    {
        "tension": Field(Items(FORCE, 2), 'such as [0, "5 N"]'),
        "displacement": Field(Items(LENGTH, 2), 'such as ["-2 mm", "5 mm"]'),
    },
)
FRICTION_PIECE = Record(
    "The friction from one arc length of the tube on.",
    {
        "from": Field(LENGTH, 'arc length where it begins, such as "60 mm"', required=True),
        "coefficient": Field(quantity("number"), "as for a whole tendon", required=True),
    },
)
TENDON = Record(
    "One tendon.",
    {
        "name": Field(Text(), "a text by which commands refer to the tendon", required=True),
        "tube": Field(Text(), "the name of the tube on which it ends", required=True),
        "routing": Field(
            ROUTING, "where it runs, such as {kind: straight, x: 0 mm, y: 6.5 mm}", required=True
        ),
        "host": Field(
            Text(("own", "outermost")),
            "what guides it: its own tube (the default), or the outermost tube present",
        ),
        "tension": Field(
            Either(PROFILE, FORCE), 'pull, such as "2 N", or a profile along the tendon; default 0'
        ),
        "displacement": Field(
            LENGTH,
            'what its motor pulls instead of a tension, such as "2 mm"; it never pushes: it goes slack',
        ),
        "compliance": Field(
            quantity("compliance"), 'of tendon and transmission in series, such as "0.1 mm/N"; default 0'
        ),
        "pretension": Field(
            FORCE, 'at zero displacement, no loads and all tendons pretensioned, such as "0.5 N"; default 0'
        ),
        "rest_length": Field(
            LENGTH,
            "its length at zero displacement and its pretension, wherever the tubes are; default: its length "
            "in the robot without loads at the present rotations and translations",
        ),
        "end": Field(LENGTH, "arc length of the tube where it ends; default: the tube's tip"),
        "limits": Field(TENDON_LIMITS, "how far its actuator goes, for sliders"),
        "friction": Field(
            Pieces(quantity("number"), Items(FRICTION_PIECE)),
            "Coulomb's coefficient between tendon and channel, or pieces; default 0",
        ),
        "contacts": Field(
            Items(LENGTH),
            'arc lengths of the disks on which it rubs, such as ["20 mm", "40 mm"]; default: all along',
        ),
        "play": Field(LENGTH, "whole backlash of its motor; default 0"),
    },
)
POINT_LOAD = Record(
    "A force and a moment at one place of a tube.",
    {
        "tube": Field(Text(), "the name of a tube", required=True),
        "force": Field(vector("force"), 'such as ["0.1 N", 0, 0]'),
        "moment": Field(vector("moment"), 'such as ["5 N mm", 0, 0]'),
        "at": Field(LENGTH, "arc length of the tube; default: its tip"),
        "axes": Field(
            AXES, "axes of force and moment: fixed in the world (the default) or turning with the body"
        ),
    },
    kind="point",
)
DISTRIBUTED_LOAD = Record(
    "A force and a moment per length.",
    {
        "tube": Field(Text(), "the name of a tube; default: the outermost tube present"),
        "force": Field(vector("force per length"), 'such as ["0.3 N/m", 0, 0]'),
        "moment": Field(vector("moment per length"), 'such as ["0.1 N m/m", 0, 0]'),
        "start": Field(
            LENGTH, "arc length where it starts (of the tube, or from the guide's exit); default 0"
        ),
        "end": Field(LENGTH, "arc length where it ends; default: as far as there is a tube"),
        "axes": Field(
            AXES, "axes of force and moment: fixed in the world (the default) or turning with the body"
        ),
    },
    kind="distributed",
)
GRAVITY = Record(
    "The weight of every tube; each needs a density.",
    {"acceleration": Field(vector("acceleration"), "default: [0, 0, -9.81 m/s^2], the robot points up")},
    kind="gravity",
)
LOAD = Variants("load", lambda: (POINT_LOAD, DISTRIBUTED_LOAD, GRAVITY))

ROBOT = Record(
    "A tendon-actuated concentric tube robot.",
    {
        "name": Field(Text(), "a short name"),
        "description": Field(Text(), "what it is and where the numbers come from"),
        "assumed": Field(
            Either(Texts(), Items(Text())),
            "fields that are guesses, such as tubes[0].outer_diameter: reason; or remarks",
        ),
        "tubes": Field(Items(TUBE), "a list of tubes, outermost first", required=True),
        "tendons": Field(Items(TENDON), "a list of tendons"),
        "loads": Field(Items(LOAD), "a list of loads"),
    },
)


def json_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a robot file, for editors and other programs."""
    variants = {
        variant.what: {"oneOf": [record.schema() for record in variant.records()]}
        for variant in (ROUTING, LOAD, NOTCHES, REST)
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "tactr robot file",
        **ROBOT.schema(),
        "$defs": variants,
    }
