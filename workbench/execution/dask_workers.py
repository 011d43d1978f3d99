"""Workers of a Dask cluster, given by the address of its scheduler. The one module that imports Dask.

Nothing is shared but the network: a job takes along the files it needs and brings its own back, into the local store. A
worker must have the same source text and libraries; it compares them before it computes. Where it sees the store's
folder at the same path (this machine, a shared disk), a task killed with it goes on from its last checkpoint. A task
runs in the worker's own process, one at a time: start workers with ``--nthreads 1``.

What is lost on the way is handed in again: a result whose worker died before it was fetched, everything when the
scheduler was restarted or the network was away. What nobody answers for a while ends the run. This process listens on
nothing and talks to the scheduler only.

Verified by tests/end_to_end/test_dask.py and tests/end_to_end/test_dask_losses.py.
"""

from __future__ import annotations

import importlib
import logging
import queue
import time
import warnings
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from workbench.execution.dask_remote import Files, read_files, run_remote, write_files
from workbench.execution.errors import RunError
from workbench.execution.jobs import Done, Failed, Job, Lost, Message, Progressed, ended_by_full_disk

__all__ = ["PATIENCE", "DaskWorkers"]

PATIENCE = 300.0
"""How long a scheduler may be away, or have no worker, before the run ends [s]."""
_ANSWER = 30.0
"""Within this time a scheduler answers, on a busy machine, too [s]."""
_LOOK_EVERY = 5.0
"""When nothing was heard for so long, the scheduler is asked whether it is there [s]."""
_LOSSES = 10
"""How often an attempt may be lost by no fault of its task before it counts as its worker's death."""
_TOPIC = "workbench-progress"


@dataclass(slots=True, kw_only=True)
class _Attempt:
    """One attempt at a job: its future, how often attempts before it were lost, whether a worker began it."""

    job: Job
    future: Any
    losses: int
    begun: bool = False


class DaskWorkers:
    """The cluster behind one scheduler.

    Parameters
    ----------
    address : of the scheduler, e.g. ``"tcp://host:8786"``
    log : named in messages; a cluster's workers keep logs of their own

    Raises
    ------
    RunError
        If Dask is not installed or nobody answers at the address.
    """

    def __init__(self, address: str, log: Path) -> None:
        try:
            self._distributed: Any = importlib.import_module("distributed")
        except ModuleNotFoundError:
            raise RunError("--scheduler needs Dask; install it: pip install 'wheel-workbench[dask]'") from None
        for name in ("distributed", "distributed.client", "tornado.application", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what they would say is said once, by us
        self.log, self._address = log, address
        self._news: queue.Queue[tuple[str, float | None]] = queue.Queue()
        self._attempts: dict[str, _Attempt] = {}
        self._handed_in = 0
        try:
            self._client = self._connected()
        except (OSError, ValueError) as error:
            raise RunError(
                f"no Dask scheduler answers at {address} ({error}); start one with: dask scheduler"
            ) from None
        self._well = time.monotonic()

    @property
    def free(self) -> int:
        """Any number: the scheduler keeps what its workers cannot take yet."""
        return 1_000_000

    def start(self, job: Job) -> None:
        """Hand the job, with the files it needs, to the scheduler."""
        if self._client.status != "running":
            self._connect_again()
        self._hand_in(job, losses=0)

    def wait(self) -> Sequence[tuple[str, Message]]:
        """Block until a task has something to say: its name and message."""
        while True:
            try:
                token, fraction = self._news.get(timeout=_LOOK_EVERY)
            except queue.Empty:
                self._look()
                continue
            attempt = self._attempts.get(token)
            if attempt is None:  # lost and handed in again
                continue
            if fraction is not None:
                attempt.begun = True
                return [(attempt.job.name, Progressed(fraction=fraction))]
            message = self._outcome(token, attempt)
            if message is not None:
                return [(attempt.job.name, message)]

    def stop(self) -> None:
        """Give up what still runs and leave the cluster, whether it answers or not."""
        for attempt in self._attempts.values():
            with suppress(Exception):
                attempt.future.cancel()
        self._attempts.clear()
        self._leave()

    def _connected(self) -> Any:
        """A client of the scheduler; raises OSError or ValueError if nobody answers."""
        with warnings.catch_warnings(action="ignore", category=UserWarning):  # versions are compared for each job
            client = self._distributed.Client(self._address, timeout=_ANSWER, set_as_default=False)
        client.subscribe_topic(_TOPIC, self._progressed)
        return client

    def _leave(self) -> None:
        with suppress(Exception):
            self._client.close(timeout=_LOOK_EVERY)

    def _hand_in(self, job: Job, losses: int) -> None:
        self._handed_in += 1
        token = f"{job.name}-{job.folder.name}-{self._handed_in}"  # unlike any other on the cluster
        needs = {name: read_files(folder) for name, folder in job.needs.items()}
        with warnings.catch_warnings(action="ignore", category=UserWarning):  # "large graph": meshes are megabytes
            future = self._client.submit(run_remote, job, needs, _Report(token), key=token, pure=False)
        self._attempts[token] = _Attempt(job=job, future=future, losses=losses)
        future.add_done_callback(self._ended)

    def _progressed(self, event: tuple[float, tuple[str, float]]) -> None:
        self._news.put(event[1])

    def _ended(self, future: Any) -> None:
        self._news.put((future.key, None))

    def _outcome(self, token: str, attempt: _Attempt) -> Message | None:
        """What became of an attempt that ended; None if it was lost and its job is handed in again."""
        future = attempt.future
        if future.status == "cancelled":  # with the connection
            self._connect_again()
            return None
        del self._attempts[token]
        if future.status == "error":
            error = future.exception()
            if not isinstance(error, self._distributed.KilledWorker):
                return Failed(message=f"the cluster gave it up: {type(error).__name__}: {error}")
            if attempt.begun or attempt.losses >= _LOSSES:
                return Lost(how="the death of one cluster worker after another", times=error.allowed_failures + 1)
            return self._lost(attempt, error.allowed_failures + 1)  # it waited where other tasks killed workers
        found = None
        if future.status == "finished":
            with suppress(Exception):  # its worker, or the connection, goes away just now
                found = future.result(timeout=PATIENCE)
        return self._lost(attempt, 1) if found is None else _fetched(attempt.job, *found)

    def _lost(self, attempt: _Attempt, losses: int) -> Message | None:
        """Hand a job in again whose result was lost, unless that has happened too often."""
        if attempt.losses >= _LOSSES:
            return Lost(how="its result lost again and again", times=attempt.losses)
        with suppress(Exception):
            attempt.future.cancel()
        if self._workers() is None:
            self._connect_again()
        self._hand_in(attempt.job, attempt.losses + losses)
        return None

    def _look(self) -> None:
        """Nothing was heard for a while: is the scheduler there, and has it workers?"""
        workers = self._workers()
        if workers is None:
            self._connect_again()
        elif workers:
            self._well = time.monotonic()
        elif time.monotonic() - self._well > PATIENCE:
            raise RunError(
                f"the Dask scheduler at {self._address} has had no worker for {PATIENCE:.0f} s; finished results are "
                f"kept, start again to go on; start a worker with: dask worker {self._address} --nthreads 1"
            )

    def _workers(self) -> int | None:
        """How many workers the scheduler has; None if it does not answer or has forgotten this client."""
        if self._client.status != "running":
            return None
        with suppress(Exception):
            about = self._client.sync(self._client.scheduler.identity, callback_timeout=_ANSWER)
            return len(about["workers"])
        return None

    def _connect_again(self) -> None:
        """Find the scheduler again, and hand in again all that it has forgotten."""
        self._leave()
        end = time.monotonic() + PATIENCE
        while True:
            try:
                self._client = self._connected()
                break
            except (OSError, ValueError) as error:
                if time.monotonic() > end:
                    raise RunError(
                        f"the Dask scheduler at {self._address} has been away for {PATIENCE:.0f} s ({error}); finished "
                        "results are kept, start again to go on"
                    ) from None
                time.sleep(_LOOK_EVERY / 5)
        self._well = time.monotonic()
        lost, self._attempts = self._attempts, {}
        for attempt in lost.values():
            self._hand_in(attempt.job, attempt.losses)


def _fetched(job: Job, message: Done | Failed | Lost, files: Files) -> Done | Failed | Lost:
    """Put a result's files into the job's folder."""
    try:
        write_files(job.folder, files)
    except OSError as error:
        return ended_by_full_disk(error, job.places)
    return message


class _Report:
    """Sends a task's progress to whoever listens on the topic."""

    def __init__(self, token: str) -> None:
        self.token = token

    def __call__(self, fraction: float) -> None:
        from distributed import get_worker

        get_worker().log_event(_TOPIC, (self.token, float(fraction)))
