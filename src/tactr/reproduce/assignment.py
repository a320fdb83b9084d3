"""Three tubes, tendons guided by the outermost tube (A) or each by its own (B)."""

from __future__ import annotations

from collections.abc import Mapping

from tactr import examples
from tactr.reproduce import printed
from tactr.reproduce.effects import distance, effects
from tactr.reproduce.records import Case, Check, Drawn, Experiment, Panel, verdict
from tactr.reproduce.steel_tube import replaced, with_fitted_steel
from tactr.statics import solve

SETTING = (
    "The three-tube set-up modelled twice: A, all tendons act on the outermost tube of each section; B, each "
    "acts on the tube where it ends. Arrangement and tensions are not printed: those of the three-tube trial "
    "c."
)
ONLY_OUTER = {"middle": 0.0, "inner": 0.0}


def run() -> Experiment:
    """Solve it."""
    robots = {
        letter: with_fitted_steel(examples.load(f"tendon_assignment_{letter.lower()}")) for letter in "AB"
    }
    cases = tuple(Case(letter, solve(robots[letter]), printed.ASSIGNMENT_ERRORS[letter]) for letter in "AB")
    alone = {letter: solve(robots[letter], tension=ONLY_OUTER) for letter in "AB"}
    return Experiment(
        "assignment",
        "Tendon assignment",
        SETTING,
        cases,
        (
            tuple(
                Panel(
                    f"{case.label}: {words}",
                    "top",
                    (Drawn(alone[case.label], "only the outermost", faded=True), Drawn(case.shape, "all")),
                )
                for case, words in zip(cases, ("on the outermost tube", "each on its own tube"), strict=True)
            ),
        ),
        "Top view. Paler: only the outermost tendon pulled.",
        _checks(cases, alone),
        effects(cases, replaced()),
        replaced=replaced(),
    )


def _checks(cases: tuple[Case, ...], alone: Mapping) -> tuple[Check, ...]:
    apart = 1e3 * distance(cases[0].shape, cases[1].shape)
    a, b = (float(error.mm) for error in printed.ASSIGNMENT_ERRORS.values())
    alike = 1e3 * distance(alone["A"], alone["B"])
    return (
        Check(
            "A and B are alike when only the outermost tendon is pulled",
            f"their tips are {1e6 * alike:.2g} nm apart",
            verdict(alike < 1e-3),
        ),
        Check(
            f"All pulled, A misses the measured tip by {a} mm and B by {b} mm, so that they are "
            f"{b - a:.2f} to {b + a:.2f} mm apart",
            f"with the assumed tensions and arrangement {apart:.2f} mm",
            verdict(b - a <= apart <= b + a),
        ),
        Check("Which of the two is nearer", "the measured shape is not public", "cannot be checked"),
    )
