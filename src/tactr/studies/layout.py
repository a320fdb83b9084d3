"""The layout of a study file: what `tactr sweep` accepts and `tactr schema study` prints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tactr.io.document import DataPath
from tactr.io.fields import Items, Report, Text, quantity
from tactr.io.records import Field, Record, given
from tactr.io.units import show
from tactr.studies.axes import MOST_SAMPLES
from tactr.studies.study import OUTPUTS
from tactr.studies.unit_samples import METHODS


@dataclass(frozen=True, eq=False, repr=False)
class Whole:
    """A whole number from least to most; 1e5 is one, too."""

    least: int
    most: int

    def read(self, value: Any, path: DataPath, report: Report) -> int:
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        if isinstance(value, bool) or not isinstance(value, int) or not self.least <= value <= self.most:
            report(path, f"found {show(value)}", f"a whole number from {self.least} to {self.most}")
            return self.least
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.least, "maximum": self.most}


@dataclass(frozen=True, eq=False, repr=False)
class Written:
    """A quantity as it is written: of which kind is known with the robot."""

    def read(self, value: Any, path: DataPath, report: Report) -> Any:
        return value

    def schema(self) -> dict[str, Any]:
        return {"type": ["string", "number"], "examples": ["30 deg", "2 N", "-20 mm", "60 GPa"]}


AXIS = Record(
    "A number of the robot that varies.",
    {
        "path": Field(
            Text(),
            "which one: tubes.NAME.rotation, tubes.NAME.translation, tendons.NAME.tension, "
            "tendons.NAME.displacement, or any other, such as tubes.NAME.material.E or loads.0.force.x",
            required=True,
        ),
        "from": Field(Written(), 'least value, with unit, such as "-20 mm"'),
        "to": Field(Written(), 'largest value, with unit, such as "30 deg"'),
        "points": Field(Whole(2, 10_000), "so many values, even between from and to, instead of samples"),
        "values": Field(Items(Written()), 'these values, such as ["1 N", "2 N"], instead of samples'),
    },
    given("from to", "from to points", "values"),
    choice="from and to (sampled); from, to and points; or values",
)
SAMPLES = Record(
    "How what has from and to, but no points, is sampled.",
    {
        "count": Field(Whole(1, MOST_SAMPLES), "number of samples, such as 100000", required=True),
        "method": Field(Text(METHODS), "sobol (default): evenly spread, scrambled; or another of these"),
        "seed": Field(Whole(0, 2**48), "the same seed gives the same samples; default 0"),
    },
)
INSERTION = Record(
    "Rules between the translations of neighbouring tubes; samples are uniform over all that meet them.",
    {
        "exposed": Field(
            quantity("length"),
            "every tube reaches at least this much further out than the next outer one, such as 0 mm",
        ),
        "carriages": Field(
            quantity("length"), "every tube's proximal end is at least this far behind the next outer one's"
        ),
    },
)
STUDY = Record(
    "A study: a robot at many configurations.",
    {
        "name": Field(Text(), "a short name"),
        "description": Field(Text(), "what it is for"),
        "robot": Field(
            Text(), "a robot file, from the folder of this file, or the name of an example", required=True
        ),
        "vary": Field(Items(AXIS), "a list of what varies", required=True),
        "samples": Field(SAMPLES, "such as {count: 100000, method: sobol, seed: 1}"),
        "insertion": Field(INSERTION, "such as {exposed: 0 mm, carriages: 10 mm}"),
        "outputs": Field(Items(Text(OUTPUTS)), "what is kept of every shape; default [tip, stability]"),
        "stations": Field(Whole(2, 10_000), "points of a centreline for the output shape; default 21"),
        "tolerance": Field(quantity("length"), "largest discretisation error at the tip; default 1 um"),
        "chunk": Field(
            Whole(1, 10_000_000),
            "configurations that are solved and stored at a time; default by their number",
        ),
    },
)


def json_schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of a study file, for editors and other programs."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "tactr study file",
        **STUDY.schema(),
    }
