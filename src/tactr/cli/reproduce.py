"""The command `reproduce`."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from tactr.cli.inputs import UsageError
from tactr.cli.progress import progress_bar
from tactr.cli.report import aligned
from tactr.errors import MissingExtra

if TYPE_CHECKING:
    from tactr.reproduce import Reproduction


def run_reproduce(out: Path) -> int:
    """Solve all experiments, write the report into the folder `out` and print a summary.

    Raises UsageError for an `out` that is no folder, MissingExtra without matplotlib, FileError.
    """
    if find_spec("matplotlib") is None:
        raise MissingExtra("matplotlib", "plot", "a report with figures")
    _make(out)
    from tactr import reproduce

    with progress_bar("solving") as bar:
        reproduction = reproduce.run(progress=bar)
    with progress_bar("drawing") as bar:
        paths = reproduction.save(out, progress=bar)
    _print_summary(reproduction)
    for path in paths:
        print(f"wrote {path}")
    return 0


def _make(folder: Path) -> None:
    """Before the work, so that a wrong folder is not found out after it."""
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"--out: {folder} is a file; expected a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"--out: {folder} cannot be made: {error.strerror or error}") from None


def _print_summary(reproduction: Reproduction) -> None:
    from tactr.reproduce.records import VERDICTS
    from tactr.reproduce.tables import printed_errors

    head = ["experiment", "the paper's tip error", "hold", "fitted", "do not hold", "cannot be checked"]
    rows = [head]
    for each in reproduction.experiments:
        counts = [str(each.count(verdict) or "-") for verdict in VERDICTS]
        rows.append([each.title, printed_errors(each), *counts])
    print("Statements of the paper, checked without its measurements, which are not public:\n")
    print(aligned(rows) + "\n")
    for each in reproduction.experiments:
        for check in each.checks:
            if check.verdict == "does not hold":
                print(f"does not hold: {each.title}: {check.statement}: {check.found}\n")
