"""What lies in a store: results, and what runs leave beside them.

Verified by tests/unit/test_workbench_pruning.py.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from contracts.machine import lives_here, machine
from workbench.execution.integrity import examined, stated
from workbench.execution.store import Store
from workbench.execution.store_folder import CHECKPOINT, KEY, LOG, SCRATCH

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
    folders = [path for path in store.root.glob("[0-9a-f][0-9a-f]/*") if KEY.fullmatch(path.name) and path.is_dir()]
    found = [_result(path, check=check) for path in folders if path.name.startswith(path.parent.name)]
    return sorted(found, key=lambda kept: (-kept.stored_at, kept.name))


def _result(path: Path, *, check: bool) -> Kept:
    manifest, fault = examined(path, path.name) if check else stated(path, path.name)
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
    """Checkpoints, scratch and logs, but nothing that a run which lives on this machine is filling now.

    What is not of the store's naming is nobody's business here.
    """
    found = [*_all(store, "checkpoints", "checkpoint", CHECKPOINT), *_all(store, "tmp", "scratch", SCRATCH)]
    return [*found, *_all(store, "log", "log", LOG)]


def _all(
    store: Store, folder: str, kind: Literal["checkpoint", "scratch", "log"], naming: re.Pattern[str]
) -> Iterator[Kept]:
    for path in sorted((store.root / folder).glob("*")):
        ours = naming.fullmatch(path.name)
        if ours is None or path.is_symlink() or path.is_dir() != (kind == "scratch"):
            continue
        if kind != "checkpoint" and _lives(ours.groupdict()):
            continue
        made, size = _made_and_size(path)
        name = ours[1] or ours[2] if kind == "checkpoint" else path.name
        yield Kept(kind=kind, name=name, path=path, stored_at=made, size=size)


def _lives(owner: dict[str, str]) -> bool:
    """Whether scratch ``HOST-PID-xxxx`` or a log ``run-PID.log`` belongs to a process that lives on this machine."""
    return lives_here(owner.get("host", machine()), owner["pid"])


def _made_and_size(path: Path) -> tuple[float, int]:
    """Time of the last change [s since 1970] and size of all files [bytes]; a run may take files away meanwhile."""
    made, size = 0.0, 0
    for one in (path, *(path.rglob("*") if path.is_dir() else ())):
        with contextlib.suppress(FileNotFoundError):
            state = one.stat()
            made = max(made, state.st_mtime)
            size += state.st_size if one.is_file() else 0
    return made, size
