"""Two precurved tubes without tendons, the inner one turned."""

from __future__ import annotations

import math

import numpy as np

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.consistency import percentage
from tactr.reproduce.effects import effects
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel, verdict
from tactr.robot import Robot
from tactr.statics import branches, solve

SETTING = (
    "Two precurved tubes after Dupont et al. 2009, of stiffness ratio 1.01, the outer one bent to a radius "
    "of 219 mm; the inner one turned by 0, 45, 90, 135 and 180°. The inner radius and straight parts are not "
    "printed: equal radii and none, a balanced pair."
)


def run() -> Experiment:
    """Solve it."""
    robot = examples.load("ctr")
    cases = tuple(
        Case(f"{angle}°", solve(robot, rotation={"inner": math.radians(angle)}))
        for angle in printed.CTR_ANGLES
    )
    drawn = tuple(Drawn(case.shape, case.label) for case in cases)
    return Experiment(
        "ctr",
        "Concentric tube robot",
        SETTING,
        cases,
        ((Panel("Five angles", "space", drawn), Panel("Top view", "top", drawn)),),
        "The inner tube turned by five angles. The tubes are equally long, so that the inner one ends with "
        "the outer.",
        _checks(robot, cases),
        effects(cases),
        findings=(_half_way(cases),),
        printed=f"{printed.CTR_ERRORS[0].mm} to {printed.CTR_ERRORS[1]}",
    )


def _checks(robot: Robot, cases: tuple[Case, ...]) -> tuple[Check, ...]:
    least, most = printed.CTR_ERRORS
    counts = [len(branches(case.robot)) for case in cases]
    return (
        _mirror(robot),
        Check(
            "All five alignments were held, none snapped",
            f"equilibria found at each angle: {', '.join(map(str, counts))}; all stable: no snap at this "
            "length",
            verdict(
                all(count == 1 for count in counts) and all(case.shape.stability.stable for case in cases)
            ),
        ),
        percentage(most, 1e3 * max(tube.tip for tube in robot.tubes), "Largest error", derived=True),
        Check(
            f"Tip errors of {least.mm} to {most.mm} mm", "measured shapes are not public", "cannot be checked"
        ),
    )


def _mirror(robot: Robot) -> Check:
    """Eight alignments of the octagonal base, three of them mirror images."""
    worst = 0.0
    for angle in (45, 90, 135):
        right, left = (
            solve(robot, rotation={"inner": sign * math.radians(angle)}).tip_position for sign in (1, -1)
        )
        worst = max(worst, float(np.linalg.norm(right * [-1, 1, 1] - left)))
    return Check(
        "Five of the eight alignments of the octagonal base are representative",
        f"the other three are mirror images, to {1e9 * worst:.1g} nm",
        verdict(worst < 1e-6),
    )


def _half_way(cases: tuple[Case, ...]) -> str:
    """How far from half way between its tubes, of which the outer one bends along -y, the pair bends."""
    off = []
    for case, angle in list(zip(cases, printed.CTR_ANGLES, strict=True))[1:-1]:
        x, y, _ = case.shape.tip_position
        off.append(abs(math.degrees(math.atan2(x, -y)) - angle / 2))
    return (
        "The assumed pair of equal curvatures bends half way between its tubes, to within "
        f"{max(off):.1f}°, as a stiffness ratio near 1 lets expect."
    )
