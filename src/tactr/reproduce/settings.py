"""Tubes and tendons of a robot as rows of texts, with marks on what is assumed or fitted."""

from __future__ import annotations

from collections.abc import Mapping

from tactr.reproduce import words
from tactr.reproduce.assumptions import assumed_fields
from tactr.robot import Robot

MARKS = "† not printed: assumed. ‡ not printed: fitted."
ON = {"own": "its own tube", "outermost": "the outermost tube"}


def tube_rows(robot: Robot, replaced: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Name, length, section, material, rest shape."""
    marked = _Marks(robot, replaced)
    return [
        (
            tube.name,
            marked(f"{1e3 * tube.length:.5g}", f"tubes[{k}].length"),
            marked(words.section(tube), f"tubes[{k}].outer_diameter", f"tubes[{k}].inner_diameter",
                   f"tubes[{k}].diameter", f"tubes[{k}].stiffness"),
            words.material(tube),
            marked(words.rest(tube), f"tubes[{k}].precurvature"),
        )
        for k, tube in enumerate(robot.tubes)
    ]  # fmt: skip


def tendon_rows(robot: Robot, replaced: Mapping[str, str]) -> list[tuple[str, ...]]:
    """Name, where it ends, on what it acts, path, tension."""
    marked = _Marks(robot, replaced)
    return [
        (
            tendon.name,
            marked(tendon.tube, f"tendons[{k}].tube"),
            ON[tendon.host],
            marked(words.path(tendon), f"tendons[{k}].routing", f"tendons[{k}].routing.angle"),
            marked(words.tension(tendon), f"tendons[{k}].tension"),
        )
        for k, tendon in enumerate(robot.tendons)
    ]


class _Marks:
    """Puts a mark behind a text whose fields are not printed."""

    def __init__(self, robot: Robot, replaced: Mapping[str, str]) -> None:
        self._assumed = assumed_fields(robot).keys() - replaced.keys()
        self._fitted = replaced.keys()

    def __call__(self, text: str, *fields: str) -> str:
        assumed = "†" if any(name in self._assumed for name in fields) else ""
        fitted = "‡" if any(name in self._fitted for name in fields) else ""
        return f"{text}{assumed}{fitted}"
