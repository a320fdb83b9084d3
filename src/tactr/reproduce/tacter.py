"""TACTER: a notched outer tube with one tendon, an inner robot with two."""

from __future__ import annotations

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.consistency import length_of, percentage
from tactr.reproduce.effects import effects
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel
from tactr.robot import Robot
from tactr.statics import solve

SETTING = (
    "Notched nitinol outer tube with one tendon, printed inner robot with a nitinol member and two tendons, "
    "each in its own tube. Outer tube bent (OB), inner robot half (IH) or fully (IF) out, bent left (L) or "
    "right (R). Which three of these poses were measured, and at which tensions, stands in a figure only: "
    "taken are those below."
)
UNCHANGED = 0.5  # mm: lines that lie on each other in a figure of the whole robot
POSES = {
    "OB-IH-L": (0.5, {"left": 0.3, "right": 0.0}),
    "OB-IF-L": (1.0, {"left": 0.3, "right": 0.0}),
    "OB-IF-R": (1.0, {"left": 0.0, "right": 0.3}),
}
"""How far out of the outer tube the inner robot is, as a share, and its tensions in N."""


def run() -> Experiment:
    """Solve it."""
    robot = examples.load("tacter")
    cases = tuple(_case(robot, label, *pose) for label, pose in POSES.items())
    return Experiment(
        "tacter",
        "TACTER",
        SETTING,
        cases,
        (
            tuple(Panel(case.label, "space", (Drawn(case.shape, tendons=True),)) for case in cases),
            (Panel("All three", "side", tuple(Drawn(case.shape, case.label) for case in cases)),),
        ),
        "The three poses one by one, and all in the plane of bending.",
        _checks(robot, cases),
        effects(cases),
        findings=(_length(),),
        printed=f"worst {printed.TACTER_ERROR}",
    )


def _case(robot: Robot, label: str, out: float, tension: dict[str, float]) -> Case:
    outer, inner = robot.tubes
    withdrawn = (1.0 - out) * (inner.length - outer.length)
    return Case(label, solve(robot, tension=tension, translation={"inner": -withdrawn}))


def _checks(robot: Robot, cases: tuple[Case, ...]) -> tuple[Check, ...]:
    ends = [case.shape.sample([robot.tubes[0].tip]).centreline[0] for case in cases]
    moved = max(1e3 * float(sum((a - b) ** 2) ** 0.5) for a in ends for b in ends)
    return (
        percentage(printed.TACTER_ERROR, 1e3 * robot.tubes[1].length, "Worst error", derived=True),
        Check(
            "The outer tube, much stiffer, hardly changes from pose to pose",
            f"its end moves by {moved:.2f} mm at most; the stiffnesses, not printed, were assumed to this "
            "end",
            "fitted" if moved < UNCHANGED else "does not hold",
        ),
        Check(
            f"A worst tip error of {printed.TACTER_ERROR.mm} mm",
            "measured poses, tensions and sections are not public",
            "cannot be checked",
        ),
    )


def _length() -> str:
    least, most, middle = length_of(printed.TACTER_ERROR)
    return (
        f"The robot's length, {middle:.1f} mm ({least:.1f} to {most:.1f}), follows from the printed mm and "
        "per cent."
    )
