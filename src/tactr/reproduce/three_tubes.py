"""Three tubes, one tendon each, in three arrangements."""

from __future__ import annotations

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.effects import effects
from tactr.reproduce.published import published_conditions
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel, verdict
from tactr.reproduce.steel_tube import replaced, with_fitted_steel
from tactr.statics import solve
from tactr.statics.parameters import value_of

SETTING = (
    "The two-tube set-up with its steel tube 187 mm long and a steel rod of 246.22 mm inside. Angles of the "
    "outer, middle and inner tendon from +X. Tensions are not printed: those of the two-tube trials, and 0.5 "
    "N on the rod."
)
ARRANGEMENTS = {"a": "90°, 90°, 90°", "b": "90°, 270°, 90°", "c": "90°, 150°, 0°"}


def run() -> Experiment:
    """Solve it."""
    cases = tuple(
        Case(f"{letter}: {angles}", solve(with_fitted_steel(examples.load(f"three_tube_{letter}"))))
        for letter, angles in ARRANGEMENTS.items()
    )
    drawn = {case.label: _stages(case) for case in cases}
    return Experiment(
        "three_tubes",
        "Three tubes",
        SETTING,
        cases,
        (
            tuple(Panel(case.label, "space", drawn[case.label]) for case in cases),
            tuple(Panel("", "top" if case is cases[-1] else "side", drawn[case.label]) for case in cases),
        ),
        "Arrangements (a), (b), (c). Paler: at rest. Below, the plane of bending of (a) and (b), and (c) "
        "from above.",
        _checks(cases),
        effects(cases, replaced()),
        findings=_findings(cases),
        replaced=replaced(),
        printed=f"within {printed.THREE_TUBE_PERCENT} %",
    )


def _stages(case: Case) -> tuple[Drawn, ...]:
    rest = solve(case.robot, tension=[0.0, 0.0, 0.0])
    return (Drawn(rest, "rest", faded=True), Drawn(case.shape, "pulled", tendons=True))


def _checks(cases: tuple[Case, ...]) -> tuple[Check, ...]:
    free = float(printed.ROD_LENGTH) - float(printed.MIDDLE_LENGTH)
    x, y, _ = 1e3 * cases[0].shape.tip_position + 0.0
    limit = float(printed.THREE_TUBE_PERCENT) / 100 * float(printed.ROD_LENGTH)
    return (
        Check(
            f"{printed.ROD_FREE} mm of the rod extend from the middle tube",
            f"{printed.ROD_LENGTH} mm - {printed.MIDDLE_LENGTH} mm = {free:.2f} mm",
            verdict(abs(free - float(printed.ROD_FREE)) < 5e-3),
        ),
        Check(
            "a: all tendons at 90° bend the robot along the Y axis",
            f"tip at x = {x:.3f} mm, y = {y:.1f} mm",
            verdict(abs(x) < 1e-3 < y),
        ),
        Check(
            f"Tip errors within {printed.THREE_TUBE_PERCENT} % of the length, or {limit:.2f} mm",
            "measured shapes and tensions are not public",
            "cannot be checked",
        ),
    )


def _findings(cases: tuple[Case, ...]) -> tuple[str, ...]:
    share = 1 - float(printed.ROD_COVERED) / float(printed.ROD_FREE)
    E, G = (1e-9 * value_of(cases[0].robot, f"tubes.inner.material.{name}") for name in "EG")
    return (
        f"The rod's moduli were raised because disks cover {printed.ROD_COVERED} of {printed.ROD_FREE} mm. "
        "If the covered part did not bend at all, the rest of the rod would have "
        f"E = {share * E:.1f} GPa and G = {share * G:.1f} GPa: near usual values of stainless steel "
        "(about 193 and 75), below those printed for the steel tube (215 and 80).",
        published_conditions(cases[-1].shape),
    )
