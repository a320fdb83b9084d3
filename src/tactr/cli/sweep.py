"""The command `sweep`."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from tactr.cli.inputs import UsageError, read_length
from tactr.cli.progress import progress_bar
from tactr.cli.solve import PICTURES, check_target

if TYPE_CHECKING:
    from tactr.studies import Sweep

ENDING = ".zarr"


@dataclass(frozen=True)
class Request:
    """What the command line asks for, as it was typed."""

    file: Path
    out: Path | None
    threads: int | None
    workers: int | None
    cluster: str | None
    voxel: str | None
    colour: str
    json: bool
    plot: Path | None


def run_sweep(request: Request) -> int:
    """Solve what is missing, or take results that are there; print a summary. Returns the exit code."""
    check_target("plot", request.plot, PICTURES)
    voxel = None if request.voxel is None else read_length("voxel", request.voxel)
    if request.file.is_dir():
        return _report(_opened(request), request, voxel)
    out = request.out or Path(request.file.name).with_suffix(ENDING)
    if out.suffix != ENDING:
        raise UsageError(f"--out: {out} does not end in {ENDING}; expected a name such as results{ENDING}")
    from tactr.studies import load_study, sweep

    study = load_study(request.file)
    began = perf_counter()
    counts: list[int] = []  # of configurations that are there: at first, and after each chunk
    options = {"threads": request.threads, "workers": request.workers, "cluster": request.cluster}
    try:
        with progress_bar("solving") as bar:

            def show(done: int, count: int) -> None:
                if not counts:  # the store is made, nothing is solved yet
                    _check_colour(out, request)
                counts.append(done)
                if bar is not None:
                    bar(done, count)

            found = sweep(study, out, **options, progress=show)
    except KeyboardInterrupt:
        if not counts:
            raise
        print(f"tactr: stopped; {counts[-1]} of {study.count} configurations are in {out}", file=sys.stderr)
        print("the same command goes on from there", file=sys.stderr)
        return 130
    fresh = counts[-1] - counts[0] if counts else 0
    return _report(found, request, voxel, fresh, perf_counter() - began)


def _check_colour(store: Path, request: Request) -> None:
    """Before the work, so that a wrong name is not found out after it. Raises RobotError."""
    if request.plot is not None:
        from tactr.studies import Sweep
        from tactr.studies.derived import named

        named(Sweep(store), request.colour)


def _opened(request: Request) -> Sweep:
    from tactr.studies import Sweep

    for option in ("out", "threads", "workers", "cluster"):
        if getattr(request, option) is not None:
            raise UsageError(
                f"--{option}: {request.file} holds results; expected a study file with this option"
            )
    return Sweep(request.file)


def _report(found: Sweep, request: Request, voxel: float | None, solved: int = 0, time: float = 0.0) -> int:
    summary = found.summary(voxel=voxel)
    if request.json:
        import json

        print(json.dumps(summary.to_dict(), indent=2))
    else:
        print(summary)
        if solved:
            print(f"\nsolved {solved} in {time:.3g} s: {solved / time:.4g} a second")
    if request.plot is not None:
        found.plot(request.plot, colour=request.colour)
    written = [path for path in (found.path if solved else None, request.plot) if path is not None]
    for path in written if not request.json else []:
        print(f"wrote {path}")
    return 0
