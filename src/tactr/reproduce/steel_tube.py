"""The steel tube of the two- and three-tube set-ups: its diameter is fitted to the one printed motion."""

from __future__ import annotations

from functools import cache

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.fitting import fit
from tactr.reproduce.records import Fit
from tactr.robot import Robot
from tactr.statics.parameters import with_value

FITTED_FIELD = "tubes[1].outer_diameter"


@cache
def fits() -> tuple[Fit, ...]:
    """The fit that is used, then what else could have been fitted instead, one number at a time."""
    robot = examples.load("two_tube_0")
    target = 1e-3 * float(printed.TWO_TUBE_DISPLACEMENT)
    within = 1e-3 * float(printed.TWO_TUBE_ERRORS["0"].mm)
    offsets = ["tendons.outer.routing.y", "tendons.inner.routing.y"]
    moduli = [f"tubes.{tube}.material.{name}" for tube in ("outer", "inner") for name in "EG"]
    return (
        fit(robot, "outer diameter of the steel tube", ["tubes.inner.section.outer_diameter"], target,
            within=within, used=True),
        fit(robot, "outer diameter of the nitinol tube", ["tubes.outer.section.outer_diameter"], target,
            within=within),
        fit(robot, "offset of both tendons", offsets, target, within=within),
        fit(robot, "moduli of both tubes, times one factor (E of the nitinol tube is shown)", moduli, target,
            within=within),
    )  # fmt: skip


def with_fitted_steel(robot: Robot) -> Robot:
    """A robot of the two- or three-tube set-up with the fitted diameter; its second tube is the steel one."""
    return with_value(robot, f"tubes.{robot.tubes[1].name}.section.outer_diameter", fits()[0].value)


def replaced() -> dict[str, str]:
    """The reason that takes the place of the robot file's."""
    value = 1e3 * fits()[0].value
    return {
        FITTED_FIELD: f"not printed; {value:.4f} mm is fitted: the tip of the two-tube trial a moves "
        f"{printed.TWO_TUBE_DISPLACEMENT} mm from rest"
    }
