"""The kind of quantity that a path of a robot names, and so the units it is written in."""

from __future__ import annotations

import re

from tactr.io.unit_table import KINDS, Kind
from tactr.robot import DistributedLoad, Robot

KIND_OF = {  # by the last word of a path; lengths otherwise
    "modulus": ("E", "G"),
    "number": ("nu", "neutral_axis", "friction", "coefficient"),
    "density": ("density",),
    "linear density": ("linear_density",),
    "force": ("tension", "pretension"),
    "compliance": ("compliance", "translation_compliance"),
    "torsional compliance": ("rotation_compliance",),
    "angle": ("rotation", "rotation_play", "phase", "rx", "ry", "rz"),
    "angle rate": ("rate",),
    "bending or torsional stiffness": ("EI_x", "EI_y", "GJ"),
    "axial or shear stiffness": ("EA", "GA"),
}
PIECE_OF_FRICTION = re.compile(r".*\.friction\.\d+\.1")
INSIDE = {"precurvature": "curvature", "force": "force", "moment": "moment", "acceleration": "acceleration"}


def last_word(path: str) -> str:
    """Of a path; "coefficient" for that of a piece of a tendon's friction."""
    return "coefficient" if PIECE_OF_FRICTION.fullmatch(path) else path.rpartition(".")[2]


def kind_of(robot: Robot, path: str) -> Kind:
    """The kind of quantity that a path of the robot names, which may hold *."""
    last = last_word(path)
    for step, kind in INSIDE.items():
        if f".{step}." in path:
            return KINDS[f"{kind} per length" if _is_along(robot, path) else kind]
    for kind, words in KIND_OF.items():
        if last in words and not path.startswith("marker"):
            return KINDS[kind]
    return KINDS["length"]


def _is_along(robot: Robot, path: str) -> bool:
    """Whether a path is of a load along a length, not at a point."""
    group, _, rest = path.partition(".")
    index = rest.partition(".")[0]
    if group != "loads" or not index.isdigit() or int(index) >= len(robot.loads):
        return False
    return isinstance(robot.loads[int(index)], DistributedLoad)
