"""The tables of the report, as texts; both its forms show the same ones."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from tactr.reproduce.records import VERDICTS, Case, Experiment, Move, Verdict
from tactr.reproduce.settings import MARKS, tendon_rows, tube_rows
from tactr.reproduce.words import actuation, unique

NOT_PRINTED = "not printed"


@dataclass(frozen=True)
class Table:
    """A title, the head, and rows of as many texts; a line break in a text parts it from a remark."""

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def tables(experiment: Experiment) -> tuple[Table, ...]:
    """All tables of an experiment that have rows."""
    found = (
        _checks(experiment),
        _poses(experiment),
        _of_robots(experiment, "Tubes", ("tube", "length (mm)", "section", "material", "at rest"), tube_rows),
        _of_robots(
            experiment, "Tendons", ("tendon", "ends on", "acts on", "path", "tension (N)"), tendon_rows
        ),
        _fits(experiment),
        _effects(experiment),
    )
    return tuple(table for table in found if table.rows)


def summary(experiments: Iterable[Experiment]) -> Table:
    """One row for every experiment."""
    rows = []
    for experiment in experiments:
        counts = [f"{experiment.count(v)} {COUNTED[v]}" for v in VERDICTS if experiment.count(v)]
        rows.append((experiment.title, printed_errors(experiment), "; ".join(counts), _most(experiment)))
    head = (
        "experiment",
        "the paper's tip error",
        "statements of the paper",
        "assumption that moves the tip most",
    )
    return Table("Overview", head, tuple(rows))


COUNTED: dict[Verdict, str] = {
    "holds": "hold",
    "fitted": "fitted",
    "does not hold": "do not hold",
    "cannot be checked": "cannot be checked",
}


def printed_errors(experiment: Experiment) -> str:
    """The errors that the paper prints, in order."""
    return experiment.printed or ", ".join(str(case.printed) for case in experiment.cases if case.printed)


def _most(experiment: Experiment) -> str:
    if not experiment.effects:
        return "as for the two tubes"
    worst = max(experiment.effects, key=lambda effect: effect.largest)
    return f"{worst.what}, {worst.change}: {mm(worst.largest)} mm"


def _checks(experiment: Experiment) -> Table:
    rows = tuple((check.statement, check.found, check.verdict) for check in experiment.checks)
    return Table("What can be checked, and what cannot", ("the paper", "found", "verdict"), rows)


def _poses(experiment: Experiment) -> Table:
    rows = tuple((case.label, actuation(case.robot), _tip(case), _printed(case)) for case in experiment.cases)
    head = ("pose", "pulled, turned, withdrawn", "the model's tip x, y, z (mm)", "the paper's tip error")
    return Table("Poses", head, rows)


def _tip(case: Case) -> str:
    return ", ".join(f"{1e3 * value:z.2f}" for value in case.shape.tip_position)


def _printed(case: Case) -> str:
    return str(case.printed) if case.printed else NOT_PRINTED


def _of_robots(experiment: Experiment, title: str, head: tuple[str, ...], rows_of: Callable) -> Table:
    """Rows of all poses' robots in one; where they differ, all values."""
    each = [rows_of(case.robot, experiment.replaced) for case in experiment.cases]
    rows = tuple(tuple(map(unique, zip(*rows, strict=True))) for rows in zip(*each, strict=True))
    return Table(title, head, rows, MARKS if any("†" in c or "‡" in c for row in rows for c in row) else "")


def _fits(experiment: Experiment) -> Table:
    rows = []
    for fit in experiment.fits:
        unit, scale = ("GPa", 1e-9) if fit.path.endswith(".E") else ("mm", 1e3)
        low, high = (f"{scale * value:.4g}" for value in fit.span)
        use = "used for all shapes with this tube" if fit.used else "for comparison only"
        value = f"{scale * fit.start:.4g} → {scale * fit.value:.5g} {unit}"
        rows.append((fit.what, value, f"{mm(fit.met)} mm", f"{low} to {high} {unit}", use))
    if not rows:
        return Table("", (), ())
    first = experiment.fits[0]
    return Table(
        f"Fitted to the printed {mm(first.target)} mm, one number at a time",
        ("number", "file → fitted", "tip moves", f"for {mm(first.target)} ± {mm(first.within)} mm", "use"),
        tuple(rows),
    )


def _effects(experiment: Experiment) -> Table:
    rows = []
    for effect in experiment.effects:
        moves = [_move(move) for move in effect.moves]
        rows.append((f"{effect.what}\n{effect.reason}", effect.value, effect.change, *moves))
    head = ("assumption", "value", "change", *(case.label for case in experiment.cases))
    note = (
        "How far the tip moves, in mm: to first order by the exact derivative, and in brackets solved again "
        "with the number less and more by its change. A dash: that is no robot, as where tubes no longer fit "
        "in each other."
    )
    return Table("What was assumed, and how much it matters", head, tuple(rows), note)


def _move(move: Move) -> str:
    if move.first_order is None:
        return mm(move.more)
    return f"{mm(move.first_order)}\n({mm(move.less)} | {mm(move.more)})"


def mm(length: float | None) -> str:
    """A length in mm, as text; a dash for none."""
    return "-" if length is None else f"{1e3 * length:.2f}"
