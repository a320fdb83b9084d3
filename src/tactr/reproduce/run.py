"""All experiments, one after the other."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tactr.reproduce import assignment, ctr, exonav, helical, loading, tacter, three_tubes, two_tubes
from tactr.reproduce.records import Experiment

RUNS: tuple[Callable[[], Experiment], ...] = (
    two_tubes.run,
    helical.run,
    loading.run,
    three_tubes.run,
    assignment.run,
    ctr.run,
    tacter.run,
    exonav.run,
)

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Reproduction:
    """The paper's experiments, solved, in its order."""

    experiments: tuple[Experiment, ...]

    def __getitem__(self, key: str) -> Experiment:
        """The experiment of a key, such as "two_tubes"; KeyError lists the keys there are."""
        for experiment in self.experiments:
            if experiment.key == key:
                return experiment
        raise KeyError(f"{key!r}; there are {', '.join(each.key for each in self.experiments)}")

    def save(self, folder: str | os.PathLike[str], *, progress: Progress | None = None) -> tuple[Path, Path]:
        """Write report.html and report.md into a folder, made where it is missing; returns their paths.

        progress: called with figures drawn and their number. Raises MissingExtra without matplotlib,
        FileError where something cannot be written.
        """
        from tactr.reproduce.report import save

        return save(self, Path(folder), progress)

    def __repr__(self) -> str:
        checks = [check for experiment in self.experiments for check in experiment.checks]
        return f"<Reproduction: {len(self.experiments)} experiments, {len(checks)} checks>"


def run(*, progress: Progress | None = None) -> Reproduction:
    """Solve all experiments of the paper; takes a few seconds.

    progress: called with experiments done and their number. Raises NotConverged.
    """
    done = []
    for k, each in enumerate(RUNS):
        if progress is not None:
            progress(k, len(RUNS))
        done.append(each())
    if progress is not None:
        progress(len(RUNS), len(RUNS))
    return Reproduction(tuple(done))
