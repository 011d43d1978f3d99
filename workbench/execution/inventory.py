"""What lies in a store: results, and what runs leave beside them.

Verified by tests/unit/test_workbench_pruning.py.
"""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from workbench.execution.integrity import MANIFEST, examined, read_manifest
from workbench.execution.store import Store

__all__ = ["Kept", "leftovers", "results"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """One result, or one thing beside the results.

    Attributes
    ----------
    kind : checkpoints belong to tasks that were interrupted, scratch to tasks that run or were killed
    name : key of a result or of the task of a checkpoint; else the name of the file or folder
    path : folder or file
    task, study : name of the task, of the study it was first computed for; empty if not known
    stored_at : time of its making [s since 1970]
    size : of all its files [bytes]
    wall_s : wall time of the computation [s], 0 if not known
    fault : what is wrong with it; empty for a whole one
    """

    kind: Literal["result", "checkpoint", "scratch", "log"]
    name: str
    path: Path
    task: str = ""
    study: str = ""
    stored_at: float
    size: int
    wall_s: float = 0.0
    fault: str = ""


def results(store: Store, *, check: bool = False) -> list[Kept]:
    """Every result, the newest first; with ``check``, every file is read and its checksum compared."""
    found = [_result(path, check=check) for path in store.root.glob("[0-9a-f][0-9a-f]/*") if len(path.name) == 64]
    return sorted(found, key=lambda kept: (-kept.stored_at, kept.name))


def _result(path: Path, *, check: bool) -> Kept:
    if check:
        manifest, fault = examined(path, path.name)
    else:
        manifest = read_manifest(path) or {}
        fault = "" if manifest else f"{MANIFEST} is missing or cannot be read"
    made, size = _made_and_size(path)
    return Kept(
        kind="result",
        name=path.name,
        path=path,
        task=str(manifest.get("task", "")),
        study=str(manifest.get("study", "")),
        stored_at=float(manifest.get("stored_at", made)),
        size=size,
        wall_s=float(manifest.get("wall_s", 0.0)),
        fault=fault,
    )


def leftovers(store: Store) -> list[Kept]:
    """Checkpoints, scratch and logs, but nothing that a run which lives on this machine is filling now."""
    return [*_all(store, "checkpoints", "checkpoint"), *_all(store, "tmp", "scratch"), *_all(store, "log", "log")]


def _all(store: Store, folder: str, kind: Literal["checkpoint", "scratch", "log"]) -> Iterator[Kept]:
    for path in sorted((store.root / folder).iterdir()):
        if kind != "checkpoint" and _is_of_a_live_process(path):
            continue
        made, size = _made_and_size(path)
        name = path.name.partition(".")[0] if kind == "checkpoint" else path.name
        yield Kept(kind=kind, name=name, path=path, stored_at=made, size=size)


def _is_of_a_live_process(path: Path) -> bool:
    """Whether scratch ``HOST-PID-xxxx`` or a log ``run-PID.log`` belongs to a process that lives on this machine."""
    if path.suffix == ".log":
        return Path(f"/proc/{path.stem.removeprefix('run-')}").exists()
    owner, _, pid = path.name.rpartition("-")[0].rpartition("-")
    return owner == socket.gethostname() and Path(f"/proc/{pid}").exists()


def _made_and_size(path: Path) -> tuple[float, int]:
    """Time of the last change [s since 1970] and size of all files [bytes]; a run may take files away meanwhile."""
    made, size = 0.0, 0
    for one in (path, *(path.rglob("*") if path.is_dir() else ())):
        with contextlib.suppress(FileNotFoundError):
            state = one.stat()
            made = max(made, state.st_mtime)
            size += state.st_size if one.is_file() else 0
    return made, size
