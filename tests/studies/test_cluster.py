"""The same study on dask.distributed, for real and on loopback: workers are killed, nothing is missing."""

from __future__ import annotations

import os
import signal
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from tactr import Range, Samples, Study, TactrError, examples
from tactr.studies import cluster, sweep

from .conftest import files_of

# Of distributed's own: sockets of workers that were killed are closed by the garbage collector.
pytestmark = [pytest.mark.filterwarnings("ignore::ResourceWarning"), pytest.mark.filterwarnings("default")]
STUDY = Study(
    examples.load("two_tube_90"),
    [
        Range("tendons.outer.tension", 0.0, 4.0),
        Range("tendons.inner.tension", 0.0, 4.0),
        Range("tubes.inner.material.E", 100e9, 215e9),
    ],
    samples=Samples(3000, method="latin_hypercube", seed=1),
    outputs=["tip", "stability"],
    chunk=50,
)


@pytest.fixture
def scheduler():
    distributed = pytest.importorskip("distributed", reason="no distributed: pip install 'tactr[cluster]'")
    from dask import config

    with (
        config.set(
            {"distributed.scheduler.allowed-failures": 20, "distributed.logging.distributed": "error"}
        ),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
        ) as running,
    ):
        yield running


def test_workers_killed_at_random(scheduler, tmp_path):
    from distributed import Status

    sweep(STUDY, tmp_path / "alone.zarr", threads=1)
    random, killed, over = np.random.default_rng(os.getpid()), [], threading.Event()
    begun = threading.Event()

    def kill() -> None:
        begun.wait(60)
        while not over.is_set() and len(killed) < 3:
            # dask gives up a worker that is killed while it starts
            running = [
                n.pid for n in scheduler.workers.values() if n.process and n.process.status == Status.running
            ]
            if running:
                victim = int(random.choice(running))
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)
            over.wait(random.uniform(0.3, 1.0))

    killer = threading.Thread(target=kill)
    killer.start()
    try:

        def progress(done: int, count: int) -> None:
            if done > 0:
                begun.set()
            if len(killed) < 3 and done > count // 2:
                time.sleep(0.1)  # leave it time to kill

        found = sweep(STUDY, tmp_path / "x.zarr", cluster=scheduler.scheduler_address, progress=progress)
    finally:
        begun.set()
        over.set()
        killer.join(60)
    assert len(killed) >= 2
    assert found.complete
    assert files_of(tmp_path / "x.zarr") == files_of(tmp_path / "alone.zarr")


def test_an_address_where_nothing_answers(tmp_path, monkeypatch):
    pytest.importorskip("distributed", reason="no distributed: pip install 'tactr[cluster]'")
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with pytest.raises(TactrError, match="no scheduler of dask answers at tcp://127.0.0.1:1"):
        sweep(STUDY, tmp_path / "x.zarr", cluster="tcp://127.0.0.1:1")


@pytest.mark.parametrize("address", ["nonsense", "tcp://host", "foo://host:1"])
def test_what_is_no_address(address, tmp_path):
    pytest.importorskip("distributed", reason="no distributed: pip install 'tactr[cluster]'")
    with pytest.raises(TactrError, match=f"no scheduler of dask answers at {address}"):
        sweep(STUDY, tmp_path / "x.zarr", cluster=address)


def test_workers_that_never_come_back_are_told(tmp_path, monkeypatch):
    """Nannies give up a worker that cannot start; without them nothing would ever come."""
    distributed = pytest.importorskip("distributed", reason="no distributed: pip install 'tactr[cluster]'")
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with (
        distributed.LocalCluster(n_workers=0, dashboard_address=None, processes=False) as empty,
        distributed.Client(empty, set_as_default=False) as client,
        pytest.raises(TactrError, match="all workers have died"),
    ):
        list(cluster._gathered(distributed, client, STUDY, [0, 1], own=True))


def test_dask_of_the_caller_is_left_alone(scheduler, tmp_path):
    from dask import config
    from distributed import default_client

    def progress(done: int, count: int) -> None:
        seen.append(config.get("scheduler", None))
        with pytest.raises(ValueError, match="No clients found"):
            default_client()

    seen: list[object] = []
    chosen = replace(STUDY, chunk=1500)
    sweep(chosen, tmp_path / "x.zarr", cluster=scheduler.scheduler_address, progress=progress)
    assert seen
    assert {*seen, config.get("scheduler", None)} == {None}


def test_workers_of_another_version_are_refused():
    with pytest.raises(TactrError, match="use the same everywhere"):
        cluster.work(STUDY, 0, "99.0")


def test_without_the_extra(monkeypatch, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(TactrError, match=r"pip install 'tactr\[cluster\]'"):
        sweep(STUDY, tmp_path / "x.zarr", workers=2)
