"""Two nitinol tubes and one helical tendon."""

from __future__ import annotations

import math
from dataclasses import replace

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.consistency import length_of, percentage
from tactr.reproduce.effects import effects, other_reading
from tactr.reproduce.published import published_conditions
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel, verdict
from tactr.robot import Robot
from tactr.statics import solve

SETTING = (
    "A nitinol tube of 280 mm and the 140 mm tube of the first set-up inside it; one tendon at 2 N, wound by "
    "10° from disk to disk. Reading used: the 280 mm tube is outermost all along, so that it carries the "
    "distal half and the tendon ends at its tip. The paper calls the tendon's tube number 2, which would be "
    "the inner one."
)


def run() -> Experiment:
    """Solve it."""
    robot = examples.load("helical")
    case = Case("2 N", solve(robot), printed.HELICAL_ERROR)
    rest, other = solve(robot, tension=[0.0]), solve(telescoped(robot))
    drawn = (
        Drawn(rest, "rest", faded=True),
        Drawn(other, "other reading", dashed=True),
        Drawn(case.shape, "2 N", tendons=True),
    )
    reading = other_reading(
        "which tube carries the distal half",
        ("tendons[0].tube",),
        "the lengths and the routing say the 280 mm tube; the paper's tube number says the inner one. Other "
        "reading: the outer tube ends at 140 mm, the 140 mm tube's section goes on to 280 mm and holds the "
        "tendon",
        [(case, other)],
    )
    return Experiment(
        "helical",
        "Helical tendon",
        SETTING,
        (case,),
        ((Panel("a: isometric view", "isometric", drawn), Panel("b: top view", "top", drawn)),),
        "(a) isometric view, (b) top view. Paler: at rest. Dashed: the other reading, in which the inner "
        "tube carries the distal half.",
        _checks(case, robot),
        (reading, *effects((case,))),
        findings=(published_conditions(case.shape),),
    )


def telescoped(robot: Robot) -> Robot:
    """The other reading: the outer tube ends half way, the inner one goes on and holds the tendon."""
    outer, inner = robot.tubes
    half = inner.length
    return robot.replace(
        tubes=(replace(outer, length=half), replace(inner, length=outer.length)),
        tendons=(replace(robot.tendons[0], tube=inner.name, host="outermost"),),
        assumed=(),
    )


def _checks(case: Case, robot: Robot) -> tuple[Check, ...]:
    end = robot.tubes[0].tip
    x, y = robot.tendons[0].routing.r(end)
    angle = math.degrees(math.atan2(y, x))
    length = 1e3 * end
    spaced = printed.HELICAL_DISKS * printed.DISK_SPACING
    step = 360 * printed.DISK_SPACING / 720
    return (
        Check(
            "The tendon starts at the tip along d2",
            f"the printed routing is {angle:.2f}° from d1 at s = {length:.0f} mm",
            verdict(abs(angle - 90) < 1e-6),
        ),
        Check(
            f"{printed.HELICAL_DISKS} disks {printed.DISK_SPACING} mm apart, turned by {printed.DISK_ANGLE}° "
            "each",
            f"they reach {spaced} mm; the printed routing turns by {step:g}° in {printed.DISK_SPACING} mm",
            verdict(spaced == length and step == printed.DISK_ANGLE),
        ),
        _length(length),
        Check(
            f"Tip errors below {printed.OWN_LIMIT} % of the length on the paper's own set-up",
            f"{printed.HELICAL_ERROR.mm} mm of {length:.0f} mm is"
            f" {100 * float(printed.HELICAL_ERROR.mm) / length:.2f} %",
            verdict(float(printed.HELICAL_ERROR.mm) < float(printed.OWN_LIMIT) / 100 * length),
        ),
        Check("A tip error of 11.36 mm", "the measured shape is not public", "cannot be checked"),
    )


def _length(length: float) -> Check:
    """The percentage, and what its failure may mean."""
    check = percentage(printed.HELICAL_ERROR, length, "Helical trial")
    if check.verdict == "holds":
        return check
    beyond = length_of(printed.HELICAL_ERROR)[2] - length
    return replace(
        check,
        found=f"{check.found}. Either {beyond:.0f} mm beyond the end of tube and routing were counted, or "
        "the percentage is of another length",
    )
