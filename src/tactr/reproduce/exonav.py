"""ExoNav II: a helically notched tube whose rest shape is a helix, one tendon."""

from __future__ import annotations

import math
from dataclasses import replace

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.consistency import percentage
from tactr.reproduce.effects import effects, other_reading
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel
from tactr.robot import RestShape, Robot, Straight
from tactr.statics import solve

SETTING = (
    "One helically notched nitinol tube of 75.4 mm with one tendon; the outer tube is passive and left out, "
    "as in the paper (n = 1). At rest the neutral axis is a helix, and the tendon is constant in the frame "
    "that turns with the notches. Sections, helix and tensions are not printed."
)
TENSIONS = (1.0, 2.0, 3.0)  # N
INNER = 1  # the colour of the inner tube, which is the only one here


def run() -> Experiment:
    """Solve it."""
    robot = examples.load("exonav2")
    cases = tuple(
        Case(f"{tension:g} N", solve(robot, tension=[tension]), error)
        for tension, error in zip(TENSIONS, printed.EXONAV_ERRORS, strict=True)
    )
    rest = solve(robot, tension=[0.0])
    drawn = (
        Drawn(rest, "rest", faded=True, colour_from=INNER),
        *(Drawn(case.shape, case.label, colour_from=INNER) for case in cases),
    )
    other = turned_about_z(robot)
    reading = other_reading(
        "frame of the rest shape",
        ("tubes[0].precurvature",),
        "here d3 follows the helix; the paper turns the frame about Z only, so that the tube leaves the "
        "guide askew and is sheared at rest",
        [(case, solve(other, tension=[tension])) for case, tension in zip(cases, TENSIONS, strict=True)],
    )
    return Experiment(
        "exonav",
        "ExoNav II",
        SETTING,
        cases,
        (
            (
                Panel("Three tensions", "space", drawn),
                Panel("Side view", "side", drawn),
                Panel("Top view", "top", drawn),
            ),
        ),
        "At rest (paler) and at three assumed tensions. The tube has the colour of inner tubes.",
        _checks(robot),
        (reading, *effects(cases)),
        findings=(_largest(),),
    )


def turned_about_z(robot: Robot) -> Robot:
    """The same helix with the paper's frame, R* = Rz: u* is a twist, and v* is askew, both constant.

    For p* = (a cos ks, a sin ks, ..) in arc length and R* = Rz(ks), u* = (0, 0, k) and v* = R*^T p*' =
    (0, a k, sqrt(1 - (a k)^2)), with k^2 = u_x^2 + u_z^2 of the helix and a k = u_x / k. Its d1 points away
    from the helix' axis, where d2 does in the robot file: tube and tendon are turned by 90 deg.
    """
    curvature, _, torsion = robot.tubes[0].precurvature[0][1]  # type: ignore[index]
    k = math.hypot(curvature, torsion)
    askew = curvature / k
    rest = RestShape((0.0, 0.0, k), (0.0, askew, math.sqrt(1 - askew**2)))
    tube = replace(robot.tubes[0], precurvature=rest, rotation=math.pi / 2)
    x, y = robot.tendons[0].routing.r(0.0)
    tendon = replace(robot.tendons[0], routing=Straight(y, -x))
    return robot.replace(tubes=(tube,), tendons=(tendon,), assumed=())


def _checks(robot: Robot) -> tuple[Check, ...]:
    length = 1e3 * robot.tubes[0].length
    return (
        *(
            percentage(error, length, f"Tip error {k}")
            for k, error in enumerate(printed.EXONAV_ERRORS, start=1)
        ),
        Check(
            "Three tip errors", "measured shapes, tensions and sections are not public", "cannot be checked"
        ),
    )


def _largest() -> str:
    worst = max((error.percent or "" for error in printed.EXONAV_ERRORS), key=float)
    return (
        f"The abstract's largest errors of around {printed.ELSEWHERE_LIMIT} % on other robots are {worst} % "
        "where this section prints them."
    )
