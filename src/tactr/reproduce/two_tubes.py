"""Two tubes, one tendon each, 0, 90 and 180 deg apart."""

from __future__ import annotations

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.consistency import percentage
from tactr.reproduce.effects import effects
from tactr.reproduce.fitting import displacement
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel, View, verdict
from tactr.reproduce.steel_tube import fits, replaced, with_fitted_steel
from tactr.robot import Robot
from tactr.statics import solve
from tactr.statics.parameters import value_of

SETTING = (
    "Nitinol outer tube of 140 mm, stainless steel inner tube of 180 mm, a tendon to the tip of each. Drawn "
    "as in the paper: the robot at rest, then the outer tube's tendon at 3 N, then the inner tube's at 2 N "
    "as well."
)
LETTERS = {"0": "a", "90": "b", "180": "c"}


def run() -> Experiment:
    """Solve it."""
    robots = {angle: with_fitted_steel(examples.load(f"two_tube_{angle}")) for angle in LETTERS}
    cases = tuple(
        Case(f"{LETTERS[angle]}: {angle}°", solve(robot), printed.TWO_TUBE_ERRORS[angle])
        for angle, robot in robots.items()
    )
    stages = {case.label: _stages(case) for case in cases}
    return Experiment(
        "two_tubes",
        "Two tubes",
        SETTING,
        cases,
        (
            tuple(Panel(case.label, "space", stages[case.label]) for case in cases),
            tuple(Panel("", _plane(case), stages[case.label]) for case in cases),
        ),
        "Tendons (a) 0°, (b) 90° and (c) 180° apart. Paler: at rest, and with the outer tube's tendon alone. "
        "Below, the plane in which the inner tube's tendon bends.",
        _checks(cases, robots["0"]),
        effects(cases, replaced()),
        fits=fits(),
        findings=_findings(robots["0"]),
        replaced=replaced(),
    )


def _stages(case: Case) -> tuple[Drawn, ...]:
    rest = solve(case.robot, tension={"outer": 0.0, "inner": 0.0})
    outer = solve(case.robot, tension={"inner": 0.0})
    return (
        Drawn(rest, "rest", faded=True),
        Drawn(outer, "3 N, 0 N", faded=True),
        Drawn(case.shape, "3 N, 2 N", tendons=True),
    )


def _plane(case: Case) -> View:
    return "front" if case.label.startswith("b") else "side"


def _checks(cases: tuple[Case, ...], planar: Robot) -> tuple[Check, ...]:
    length = 1e3 * planar.tubes[1].tip
    reached = 1e3 * displacement(cases[0].shape)
    return (
        Check(
            f"a: the tip moved {printed.TWO_TUBE_DISPLACEMENT} mm from rest",
            f"{reached:.2f} mm, because the steel tube's diameter was chosen for it",
            "fitted" if abs(reached - float(printed.TWO_TUBE_DISPLACEMENT)) < 5e-3 else "does not hold",
        ),
        _bends(cases),
        *(percentage(case.printed, length, case.label) for case in cases if case.printed),
        Check("Tip errors of 4.34, 5.78 and 4.20 mm", "measured shapes are not public", "cannot be checked"),
    )


def _bends(cases: tuple[Case, ...]) -> Check:
    """a in +Y, b also towards X, c in opposite directions."""
    turned = [1e3 * _turn(case) for case in cases]
    (xa, ya), (xb, yb), (xc, yc) = turned
    small = 1e-3
    holds = abs(xa) < small < ya and xb > 1.0 and abs(yb) < xb and abs(xc) < small < -yc
    return Check(
        "The inner tube's tendon bends a further in Y, b in X, c back against the outer tube",
        f"it moves the tip by (x, y) = a ({xa:.1f}, {ya:.1f}), b ({xb:.1f}, {yb:.1f}), c ({xc:.1f}, "
        f"{yc:.1f}) mm",
        verdict(holds),
    )


def _turn(case: Case):
    before = solve(case.robot, tension={"inner": 0.0})
    return (case.shape.tip_position - before.tip_position)[:2] + 0.0


def _findings(robot: Robot) -> tuple[str, ...]:
    ratios = ", ".join(f"{_poisson(robot, tube.name):.2f} ({tube.name} tube)" for tube in robot.tubes)
    error = printed.TWO_TUBE_ERRORS["0"].mm
    return (
        f"The paper does not say whether the {printed.TWO_TUBE_DISPLACEMENT} mm are measured or its model's. "
        f"The table of fits shows what {error} mm less and more, its tip error, do to the fitted numbers.",
        f"The printed E and G fit isotropic materials: Poisson's ratio {ratios}.",
    )


def _poisson(robot: Robot, tube: str) -> float:
    E, G = (value_of(robot, f"tubes.{tube}.material.{name}") for name in "EG")
    return E / (2 * G) - 1
