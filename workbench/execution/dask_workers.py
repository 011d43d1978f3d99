"""Workers of a Dask cluster, given by the address of its scheduler. The one module that imports Dask.

Nothing is shared but the network: a job takes along the files it needs and brings its own back, into the local store. A
worker must have the same source text and libraries; it compares them before it computes. Where it sees the store's
folder at the same path (this machine, a shared disk), a task killed with it goes on from its last checkpoint. A task
runs in the worker's own process, one at a time: start workers with ``--nthreads 1``.

Verified by tests/end_to_end/test_dask.py.
"""

from __future__ import annotations

import importlib
import queue
import tempfile
import threading
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from workbench.execution.errors import RunError
from workbench.execution.fingerprint import library_versions, source_hash
from workbench.execution.jobs import Done, Failed, Job, Lost, Message, Progressed, run_job
from workbench.execution.ranks import run_on_ranks

__all__ = ["DaskWorkers"]

type Files = dict[str, bytes]
"""Relative path -> content."""

_TOPIC = "workbench-progress"
_ONE_AT_A_TIME = threading.Lock()


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
            distributed: Any = importlib.import_module("distributed")
        except ModuleNotFoundError:
            raise RunError("--scheduler needs Dask; install it: pip install 'wheel-workbench[dask]'") from None
        self.log = log
        try:
            self._client = distributed.Client(address, timeout="10s", set_as_default=False)
        except (OSError, ValueError) as error:
            raise RunError(
                f"no Dask scheduler answers at {address} ({error}); start one with: dask scheduler"
            ) from None
        self._news: queue.Queue[tuple[str, Message]] = queue.Queue()
        self._jobs: dict[str, tuple[Job, Any]] = {}
        self._client.subscribe_topic(_TOPIC, self._progressed)

    @property
    def free(self) -> int:
        """Any number: the scheduler keeps what its workers cannot take yet."""
        return 1_000_000

    def start(self, job: Job) -> None:
        """Hand the job, with the files it needs, to the scheduler."""
        needs = {name: _read(folder) for name, folder in job.needs.items()}
        with warnings.catch_warnings(action="ignore", category=UserWarning):  # "large graph": meshes are megabytes
            future = self._client.submit(_run_remote, job, needs, key=_token(job), pure=False)
        self._jobs[_token(job)] = job, future
        future.add_done_callback(self._ended)

    def wait(self) -> Sequence[tuple[str, Message]]:
        """Block until a task has something to say: its name and message."""
        return [self._news.get()]

    def stop(self) -> None:
        """Give up what still runs and leave the cluster."""
        for _, future in self._jobs.values():
            future.cancel()
        self._client.close()

    def _progressed(self, event: tuple[float, tuple[str, float]]) -> None:
        token, fraction = event[1]
        if token in self._jobs:
            self._news.put((self._jobs[token][0].name, Progressed(fraction=fraction)))

    def _ended(self, future: Any) -> None:
        if future.key in self._jobs:
            job, _ = self._jobs.pop(future.key)
            self._news.put((job.name, _outcome(job, future)))


def _outcome(job: Job, future: Any) -> Message:
    """What became of a finished job; its files are put into the job's folder."""
    from distributed import KilledWorker

    if future.status == "finished":
        message, files = future.result()
        for name, content in files.items():
            (job.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (job.folder / name).write_bytes(content)
        end: Done | Failed = message
        return end
    error = future.exception() if future.status == "error" else None
    if isinstance(error, KilledWorker):
        return Lost(how="the death of one cluster worker after another")
    return Failed(message=f"the cluster gave it up: {error or future.status}")


def _run_remote(job: Job, needs: Mapping[str, Files]) -> tuple[Done | Failed, Files]:
    """Run a job on a cluster's worker: its message, and the files it made."""
    different = _differences(job.origin)
    if different:
        return Failed(message=f"the cluster's worker has another version of {', '.join(different)}; install ours"), {}
    with _ONE_AT_A_TIME, tempfile.TemporaryDirectory(prefix="workbench-job-") as name:
        folders = {need: Path(name) / "needs" / str(i) for i, need in enumerate(needs)}
        for need, files in needs.items():
            for path, content in files.items():
                (folders[need] / path).parent.mkdir(parents=True, exist_ok=True)
                (folders[need] / path).write_bytes(content)
        kept = job.checkpoint if job.checkpoint is not None and job.checkpoint.parent.is_dir() else None
        here = replace(job, needs=folders, folder=Path(name) / "result", checkpoint=kept)
        here.folder.mkdir()
        report = _Report(_token(job))
        message = run_job(here, report) if job.ranks == 1 else run_on_ranks(here, report)
        return message, _read(here.folder)


class _Report:
    """Sends a task's progress to whoever listens on the topic."""

    def __init__(self, token: str) -> None:
        self.token = token

    def __call__(self, fraction: float) -> None:
        from distributed import get_worker

        get_worker().log_event(_TOPIC, (self.token, float(fraction)))


def _token(job: Job) -> str:
    """Name of this attempt at this task, unlike any other on the cluster."""
    return f"{job.name}-{job.folder.name}"


def _differences(origin: Mapping[str, Mapping[str, str]]) -> list[str]:
    """Names of sources and libraries that are not those the job was made with."""
    here = {name: source_hash(name) for name in origin["sources"]}
    versions = library_versions(tuple(origin["libraries"]))
    wanted, found = {**origin["sources"], **origin["libraries"]}, {**here, **versions}
    return [name for name, value in wanted.items() if found[name] != value]


def _read(folder: Path) -> Files:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
