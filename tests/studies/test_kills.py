"""A sweep that is killed at any moment and run again ends as one that was not: nothing lost or done twice."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import tactr
from tactr import FileError, Range, Samples, Study, examples
from tactr.studies import store as store_module
from tactr.studies import sweep
from tactr.studies.store import open_store

from .conftest import files_of

KILLS = 3
STUDY = Study(
    examples.load("two_tube_90"),
    [Range("tendons.outer.tension", 0.0, 4.0), Range("tendons.inner.tension", 0.0, 4.0)],
    samples=Samples(240, seed=1),
    outputs=["tip", "stability"],
    chunk=4,
)
CHILD = """
import sys
from pathlib import Path
from tactr import Range, Samples, Study, examples
from tactr.studies import local, sweep
solved, out, log = local.solved, Path(sys.argv[1]), open(sys.argv[2], "a", buffering=1)

def logged(study, start, stop, threads):
    print(start // 4, file=log)
    return solved(study, start, stop, threads)

local.solved = logged
study = Study(
    examples.load("two_tube_90"),
    [Range("tendons.outer.tension", 0.0, 4.0), Range("tendons.inner.tension", 0.0, 4.0)],
    samples=Samples(240, seed=1),
    outputs=["tip", "stability"],
    chunk=4,
)
sweep(study, out, threads=1)
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "x.zarr"
    sweep(STUDY, path, threads=1)
    return files_of(path)


def chunks_done(path):
    return tactr.Sweep(path).dataset["chunk_done"].values if path.exists() else np.zeros(STUDY.chunks)


def test_killed_at_random_moments(whole, tmp_path):
    path, log, random = tmp_path / "x.zarr", tmp_path / "log", np.random.default_rng(os.getpid())
    log.touch()
    repeated, killed = 0, 0
    for _ in range(KILLS):
        done, logged = chunks_done(path), len(log.read_text().split())
        if done.all():
            break
        child = subprocess.Popen([sys.executable, "-c", CHILD, str(path), str(log)])
        try:
            while child.poll() is None and len(log.read_text().split()) < logged + 2:
                time.sleep(0.002)
            time.sleep(random.uniform(0.0, 0.15))
        finally:
            child.kill()
            status = child.wait()
        killed += status == -signal.SIGKILL
        fresh = log.read_text().split()[logged:]
        assert not np.any(done[[int(chunk) for chunk in fresh]])  # nothing that was there is done again
        repeated += len(fresh) - int(chunks_done(path).sum() - done.sum())
    assert killed >= 2
    assert 0 <= repeated <= killed  # at most the chunk that was under way
    found = sweep(STUDY, path, threads=1)
    assert found.complete
    assert (found.dataset.status.values >= 0).all()
    assert files_of(path) == whole


def test_stopped_before_and_after_every_file(tmp_path, tendon_study, monkeypatch):
    """Each write to the disk, and each of its ends, as the place where the process dies."""

    class Died(BaseException):
        pass

    whole = tmp_path / "whole.zarr"
    sweep(tendon_study, whole, threads=1)
    expected, path = files_of(whole), tmp_path / "x.zarr"
    sync, writes = store_module._sync, 0
    for last in range(0, 40, 3):
        count = 0

        def dying(place, last=last):
            nonlocal count, writes
            count, writes = count + 1, writes + 1
            if count > last:
                raise Died
            sync(place)

        monkeypatch.setattr(store_module, "_sync", dying)
        with pytest.raises(Died):
            sweep(tendon_study, path, threads=1)
        monkeypatch.undo()
        (path / "status" / "c" / "left.partial").parent.mkdir(exist_ok=True)
        (path / "status" / "c" / "left.partial").write_bytes(b"half of a file")
        done = chunks_done(path)
        rows = tactr.Sweep(path).dataset.status.values.reshape(-1, 10)
        assert (rows[done == 1] >= 0).all()
        if done.sum() > 9:
            break
    assert writes > 100
    sweep(tendon_study, path, threads=1)
    assert files_of(path) == expected


def test_killed_while_the_store_is_made(tmp_path, tendon_study, monkeypatch):
    def dies(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(store_module, "_add", dies)
    with pytest.raises(KeyboardInterrupt):
        sweep(tendon_study, tmp_path / "x.zarr")
    assert list(tmp_path.iterdir()) == []
    monkeypatch.undo()
    (tmp_path / ".x.zarr.new" / "status").mkdir(parents=True)  # left by SIGKILL
    assert sweep(tendon_study, tmp_path / "x.zarr").complete
    assert [path.name for path in tmp_path.iterdir()] == ["x.zarr"]


def test_two_at_a_time_are_refused(tmp_path, tendon_study):
    path = tmp_path / "x.zarr"
    sweep(tendon_study, path)
    with (
        open_store(path, tendon_study, dict),
        pytest.raises(FileError, match="is being written by another sweep"),
    ):
        sweep(tendon_study, path)
    assert sweep(tendon_study, path).complete
