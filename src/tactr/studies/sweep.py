"""Solve all configurations of a study into a store."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator
from contextlib import closing
from pathlib import Path

from tactr.errors import RobotError
from tactr.studies.axes import whole
from tactr.studies.cluster import cluster_chunks
from tactr.studies.local import local_chunks
from tactr.studies.read_study import load_study
from tactr.studies.result import Sweep
from tactr.studies.solving import Arrays, solved
from tactr.studies.store import Store, open_store
from tactr.studies.study import Study

Progress = Callable[[int, int], None]


def sweep(
    study: Study | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    threads: int | None = None,
    workers: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = None,
) -> Sweep:
    """Solve all configurations of a study into a Zarr store; goes on where an earlier run was stopped.

    study: a Study, or a study file. out: the store, a folder; one that holds a part of the same study is gone
    on with, and is the same in the end as without the interruption. Every configuration gets its row, with a
    status. threads: of this process, None for as many as there are cores; or workers: processes on this
    machine, or cluster: the address of a dask scheduler ("tcp://..."), for the extra cluster. progress:
    called with configurations done and their number. Raises FileError for a study file that is wrong and for
    a store of another study; RobotError, MissingExtra, ClusterError. (extra: sweep)
    """
    if not isinstance(study, Study):
        study = load_study(study)
    for name, number in (("threads", threads), ("workers", workers)):
        if number is not None:
            whole(name, number, 1, 4096)
    if sum(given is not None for given in (threads, workers, cluster)) > 1:
        raise RobotError("threads", "more than one of threads, workers, cluster is given", "one of them")
    chosen, path = study, Path(out)
    with open_store(path, chosen, lambda: solved(chosen, 0, 1, 1)) as store:
        missing = store.missing
        if workers is None and cluster is None:
            results = local_chunks(study, missing, threads)
        else:
            results = cluster_chunks(study, missing, cluster=cluster, workers=workers)
        if missing:
            _write_all(store, study, results, progress)
    return Sweep(path)


def _write_all(
    store: Store, study: Study, results: Generator[tuple[int, Arrays], None, None], progress: Progress | None
) -> None:
    done = study.count - sum(stop - start for start, stop in map(study.span, store.missing))
    if progress is not None:
        progress(done, study.count)
    with closing(results):
        for chunk, arrays in results:
            store.write(chunk, arrays)
            start, stop = study.span(chunk)
            done += stop - start
            if progress is not None:
                progress(done, study.count)
