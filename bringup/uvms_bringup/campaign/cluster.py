"""Runs on the workers of dask.distributed: those of this machine, or of a scheduler elsewhere."""

import logging
import queue
import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

import dask
from distributed import Client, Future, KilledWorker, LocalCluster
from distributed.utils import get_mp_context

from uvms_bringup.campaign.plan import Run
from uvms_bringup.campaign.row import Row, row_of_fault
from uvms_bringup.campaign.worker import Logs, about, make_row
from uvms_bringup.errors import CampaignError

PATIENCE_S = 6.0
"""How long a scheduler elsewhere may take to answer, s; with what has to be imported before, a user
waits for less than 10 s."""

POLL_S = 0.2
"""How often a campaign looks whether it has been stopped, s."""

AHEAD = 20
"""Runs handed out for each worker: enough that none waits, few enough that a scheduler with a
million of them stays small."""

DEATHS = 3
"""Workers of this machine that a run may take with it before it counts as its own fault."""

ONE_THREAD = {
    f"distributed.nanny.pre-spawn-environ.{name}": 1
    for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
}
"""A worker is one process that keeps one core busy; libraries may not start threads beside it."""

_SETTINGS: dict[str, Any] = {
    **ONE_THREAD,
    "distributed.scheduler.allowed-failures": DEATHS,
    "distributed.worker.multiprocessing-method": "forkserver",
    "distributed.worker.profile.enabled": False,  # keeps half a MB a second of call stacks
}
PRELOADED = ("distributed", make_row.__module__, "uvms_bringup.campaign.preload")
"""Imported once, by the server that the worker processes are forked from: it takes seconds."""


class Cluster:
    """Workers; a context manager.

    Args:
        workers: processes on this machine, where no scheduler is given.
        scheduler: address of a scheduler that runs already; "" starts workers here.

    Raises:
        CampaignError: the scheduler does not answer within `PATIENCE_S`, or its workers do not
            have this program.
    """

    def __init__(self, workers: int, scheduler: str = "") -> None:
        self._address = scheduler
        self._local: LocalCluster | None = None
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        self._client = _connected(scheduler) if scheduler else self._start(workers)

    def _start(self, workers: int) -> Client:
        # Ctrl-C goes to all processes of the terminal; workers are stopped by their campaign.
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            dask.config.set(_SETTINGS)  # for good: a worker that is started again needs them, too
            get_mp_context().set_forkserver_preload(list(PRELOADED))
            self._local = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address=None,
                memory_limit=0,
                silence_logs=logging.CRITICAL,
            )
            return Client(self._local)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def check(self, revision: str) -> list[str]:
        """What is to be said about the workers.

        Raises:
            CampaignError: a worker cannot import this program.
        """
        if not self._address:
            return []
        try:
            found = self.call(about)
        except Exception as fault:  # whatever a foreign worker answers
            raise CampaignError(
                f"scheduler {self._address}: its workers cannot run this program: {fault}"
            ) from fault
        if not found:
            return [f"scheduler {self._address} has no workers yet; waiting for the first"]
        others = sorted({one for one in found.values() if one != revision})
        return [f"workers have revision {', '.join(others)}, not {revision}"] if others else []

    @property
    def workers(self) -> Mapping[str, Any]:
        """What the scheduler knows about its workers, by address."""
        return self._client.scheduler_info(n_workers=-1)["workers"]

    def call(self, work: Callable[[], Any]) -> dict[str, Any]:
        """What a function returns in each worker, by the worker's address."""
        return self._client.run(work)

    def rows(
        self, runs: Iterator[Run], folder: Path, logs: Logs, check: Callable[[], None]
    ) -> Iterator[Row]:
        """Make runs; yields their rows as they end, in any order.

        Args:
            check: called several times a second; what it raises ends the work.

        Raises:
            CampaignError: the scheduler is gone.
        """
        done: queue.SimpleQueue[Future] = queue.SimpleQueue()
        pending: dict[Future, Run] = {}

        def hand_out(count: int) -> None:
            for _ in range(count):
                if (run := next(runs, None)) is None:
                    return
                future = self._client.submit(make_row, run, folder, logs, pure=False)
                pending[future] = run
                future.add_done_callback(done.put)

        hand_out(AHEAD * max(len(self.workers), 1))
        while pending:
            check()
            self._check_connection()
            ended = _drained(done)
            for future, row in self._results(ended):
                run = pending.pop(future)
                yield row if isinstance(row, dict) else row_of_fault(run, row)
            hand_out(len(ended))

    def _results(self, ended: Sequence[Future]) -> Iterator[tuple[Future, Row | str]]:
        good = [future for future in ended if future.status == "finished"]
        yield from zip(good, self._client.gather(good), strict=True)
        for future in ended:
            if future.status == "error":
                yield future, _reason(future.exception())
            elif future.status != "finished":
                self._is_gone()

    def _check_connection(self) -> None:
        if self._client.status not in ("running", "connecting"):
            self._is_gone()

    def _is_gone(self) -> None:
        raise CampaignError(
            f"the scheduler {self._address or 'of this machine'} is gone; what was computed is kept"
        )

    def __enter__(self) -> "Cluster":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with suppress(Exception):  # whatever state they are in
            self._client.close(timeout=5)
        if self._local is not None:
            with suppress(Exception):
                self._local.close(timeout=5)


def _connected(address: str) -> Client:
    """A client of the scheduler.

    The connection is made in a thread that is given up when its time is over: dask goes on waiting
    for a peer that takes the connection and says nothing.
    """
    found: list[Client] = []
    faults: list[Exception] = []

    def connect() -> None:
        try:
            found.append(Client(address, timeout=PATIENCE_S, set_as_default=False))
        except Exception as fault:  # of the network, of the address, of dask
            faults.append(fault)

    thread = threading.Thread(target=connect, daemon=True)
    thread.start()
    thread.join(PATIENCE_S)
    if found:
        return found[0]
    raise CampaignError(
        f"--scheduler {address}: {_why_not(faults)}; start one with `dask scheduler`, and its"
        " workers with `dask worker ADDRESS`"
    )


def _why_not(faults: Sequence[Exception]) -> str:
    """Why there is no client, in words."""
    chain = list(_causes(faults[0])) if faults else []
    wrong = next((one for one in chain if isinstance(one, ValueError)), None)
    if wrong is not None:
        return f"this is no address: {wrong}; write tcp://HOST:8786"
    if not chain or any(isinstance(one, TimeoutError) for one in chain):
        return f"no scheduler answers there within {PATIENCE_S:g} s"
    # Of any other program's answer, dask takes the first bytes for a length, and may then ask for
    # more memory than there is.
    why = "" if isinstance(chain[-1], MemoryError) else f" ({chain[-1]})"
    return f"what answers there is no dask scheduler, or one of another version{why}"


def _causes(fault: BaseException) -> Iterator[BaseException]:
    """An error and those that it was raised from."""
    found: BaseException | None = fault
    while found is not None:
        yield found
        found = found.__cause__


def _drained(done: "queue.SimpleQueue[Future]") -> list[Future]:
    """What has ended; waits a moment for the first."""
    found = []
    with suppress(queue.Empty):
        found.append(done.get(timeout=POLL_S))
        while True:
            found.append(done.get_nowait())
    return found


def _reason(fault: BaseException | None) -> str:
    if isinstance(fault, KilledWorker):
        return f"the worker process died in this run, {DEATHS + 1} times"
    return f"{type(fault).__name__}: {fault}"
