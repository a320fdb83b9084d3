"""The chunks of a study solved on a cluster of dask.distributed: on this machine, or anywhere.

A chunk is a pure function of the study and its number: a worker that dies loses work, never results, and the
chunk goes to another one. Workers send arrays; only the process that asked writes.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from tactr.errors import MissingExtra, TactrError
from tactr.studies.solving import Arrays, solved
from tactr.studies.versions import versions

if TYPE_CHECKING:
    from tactr.studies.study import Study

AHEAD = 3  # chunks for each thread of the cluster that are asked for at a time
MOST_TRIES = 20  # of one chunk on workers that died under it
PATIENCE = 30.0  # s to wait for a scheduler, and for the first worker
OWN_CLUSTER = {
    "distributed.scheduler.allowed-failures": MOST_TRIES,
    "distributed.logging.distributed": "error",
    # a dashboard would show these; without one they only cost a tenth of a core
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "500ms",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.worker.memory.monitor-interval": "2s",
}


class ClusterError(TactrError):
    """A cluster that cannot be used."""


def cluster_chunks(
    study: Study, chunks: Sequence[int], *, cluster: str | None = None, workers: int | None = None
) -> Generator[tuple[int, Arrays], None, None]:
    """Every chunk's number and arrays, as they come. cluster: address of a scheduler; workers: or so many
    processes on this machine. Raises ClusterError, MissingExtra."""
    distributed = _import()
    with _client(distributed, cluster, workers) as client:
        yield from _gathered(distributed, client, study, list(chunks), own=cluster is None)


def work(study: Study, chunk: int, wanted: str) -> Arrays:
    """What a worker does; wanted: the versions of whoever asks."""
    if versions() != wanted:
        raise ClusterError(f"a worker has {versions()}, this process {wanted}: use the same everywhere")
    return solved(study, *study.span(chunk), 1)


def _gathered(
    distributed: Any, client: Any, study: Study, waiting: list[int], *, own: bool
) -> Generator[tuple[int, Arrays], None, None]:
    waiting.reverse()
    tries: dict[int, int] = {}
    running: dict[Any, int] = {}
    arrived: SimpleQueue[Any] = SimpleQueue()

    def ask(chunk: int) -> None:
        future = client.submit(work, study, chunk, versions(), pure=False, retries=0)
        running[future] = chunk
        future.add_done_callback(arrived.put)

    while waiting or running:
        while waiting and len(running) < AHEAD * max(1, sum(client.nthreads().values())):
            ask(waiting.pop())
        future = _waited_for(client, lambda patience: arrived.get(timeout=patience), own)
        chunk = running.pop(future)
        try:
            arrays = _waited_for(client, future.result, own)  # from a worker that may be dead by now
        except (distributed.KilledWorker, distributed.CancelledError, distributed.comm.CommClosedError):
            tries[chunk] = tries.get(chunk, 0) + 1
            if tries[chunk] >= MOST_TRIES:
                raise ClusterError(
                    f"{MOST_TRIES} workers died over chunk {chunk}: if they lack memory, make chunks smaller"
                ) from None
            ask(chunk)
            continue
        future.release()
        yield chunk, arrays


def _waited_for(client: Any, get: Callable[[float], Any], own: bool) -> Any:
    """What get gives, however long it takes: to a cluster from elsewhere workers may come back at any time.
    But nothing brings them back to our own once dask has given up starting them."""
    while True:
        try:
            return get(PATIENCE)
        except (TimeoutError, Empty):
            if not own:
                continue
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise ClusterError(
                "all workers have died and did not come back; the same command goes on with what is done"
            ) from None


# A default client would send the caller's own dask work, also what xarray saves, to this cluster.
@contextmanager
def _client(distributed: Any, cluster: str | None, workers: int | None) -> Iterator[Any]:
    if cluster is None:
        from dask import config

        with (
            config.set(OWN_CLUSTER),
            distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None, host="127.0.0.1"
            ) as own,
            distributed.Client(own, set_as_default=False) as client,
        ):
            yield client
        return
    try:
        distributed.comm.get_address_host_port(cluster)  # a Client that stumbles over it leaves a traceback
        client = distributed.Client(cluster, timeout=PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise ClusterError(f"no scheduler of dask answers at {cluster}: {error}") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise ClusterError(
                f"the scheduler at {cluster} has no workers: start dask worker {cluster}"
            ) from None
        yield client


def _import() -> Any:
    try:
        import distributed
    except ImportError:
        raise MissingExtra("distributed", "cluster", "a sweep on several workers") from None
    return distributed
