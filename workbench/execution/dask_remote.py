"""What a worker of a Dask cluster does with a job: files unpacked, the job run, files packed again.

Verified by tests/end_to_end/test_dask.py.
"""

from __future__ import annotations

import socket
import tempfile
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from workbench.execution.fingerprint import library_versions
from workbench.execution.jobs import Done, Failed, Job, Lost, ended_by_full_disk, run_job
from workbench.execution.ranks import run_on_ranks
from workbench.execution.reach import source_hash

__all__ = ["Files", "read_files", "run_remote", "write_files"]

type Files = dict[str, bytes]
"""Relative path -> content; a file alone has none."""

_ONE_AT_A_TIME = threading.Lock()


def write_files(folder: Path, files: Files) -> None:
    """Write files into a folder, which is made; a file alone in its place."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


def run_remote(
    job: Job, needs: Mapping[str, Files], report: Callable[[float], None]
) -> tuple[Done | Failed | Lost, Files]:
    """Run a job on a cluster's worker: its message, and the files it made; ``report`` tells that it began, too."""
    report(0.0)
    different = _differences(job.origin)
    if different:
        return Failed(message=f"the cluster's worker has another version of {', '.join(different)}; install ours"), {}
    try:
        with _ONE_AT_A_TIME, tempfile.TemporaryDirectory(prefix="workbench-job-") as name:
            places = (Path(name) / "needs" / f"{i}{job.needs[need].suffix}" for i, need in enumerate(needs))
            here = replace(job, needs=dict(zip(needs, places, strict=True)), store=None)
            for need, files in needs.items():
                write_files(here.needs[need], files)
            kept = job.checkpoint if job.checkpoint is not None and job.checkpoint.parent.is_dir() else None
            here = replace(here, folder=Path(name) / "result", checkpoint=kept)
            here.folder.mkdir()
            message = run_job(here, report) if job.ranks == 1 else run_on_ranks(here, report)
            return _of_this_machine(message), read_files(here.folder)
    except OSError as error:
        return _of_this_machine(ended_by_full_disk(error, {})), {}


def _of_this_machine(message: Done | Failed | Lost) -> Done | Failed | Lost:
    """The message, with the machine's name where its disk is full; another machine's may have room."""
    if isinstance(message, Failed) and message.disk_full:
        return Failed(message=f"on {socket.gethostname()}: {message.message}")
    return message


def _differences(origin: Mapping[str, Mapping[str, str]]) -> list[str]:
    """Names of sources and libraries that are not those the job was made with."""
    here = {name: _hash_here(name) for name in origin["sources"]}
    versions = library_versions(tuple(origin["libraries"]))
    wanted, found = {**origin["sources"], **origin["libraries"]}, {**here, **versions}
    return [name for name, value in wanted.items() if found[name] != value]


def _hash_here(name: str) -> str:
    try:
        return source_hash(name)
    except (ModuleNotFoundError, FileNotFoundError):  # of another version
        return ""


def read_files(folder: Path) -> Files:
    """Every file below a folder; of a file its content, without a name."""
    if folder.is_file():
        return {"": folder.read_bytes()}
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
