"""Which results the runs that live now use: pruning leaves them alone.

Each process that runs tasks keeps one file in ``STORE/runs`` with the keys of its graphs and a checksum, locked (flock)
until the process ends, however it ends; a file nobody holds locked is a leftover. Whoever reads or writes these files
holds the store's own lock, so that a run cannot begin to use a result while it is being removed.

Verified by tests/unit/test_workbench_pruning.py.
"""

from __future__ import annotations

import atexit
import fcntl
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import FileIO
from pathlib import Path
from typing import IO

from contracts.errors import InputError
from contracts.machine import machine
from workbench.execution.integrity import sealed, unsealed
from workbench.execution.store_folder import ANNOUNCEMENT, KEY

__all__ = ["announce", "exclusive", "keys_in_use"]

_FOLDER = "runs"
_LOCK = "lock"


@dataclass(slots=True, kw_only=True)
class _Announcement:
    """This process' file and what it says."""

    stream: FileIO
    keys: set[str] = field(default_factory=set)


_OURS: dict[Path, _Announcement] = {}
"""By store; open, and so locked, until the process ends."""


@contextmanager
def exclusive(root: Path) -> Iterator[None]:
    """Hold the store's lock. Where a file system has no locks, or the lock's place is no file, nothing is held."""
    lock = root / _LOCK
    if not os.access(root, os.W_OK) or (os.path.lexists(lock) and not lock.is_file()):
        yield
        return
    with lock.open("a", encoding="utf-8") as stream:
        _lock(stream, fcntl.LOCK_EX)
        yield


def announce(root: Path, keys: Iterable[str]) -> None:
    """Say that this process uses these results until it ends."""
    with exclusive(root):
        ours = _OURS.get(root.absolute())
        if ours is None or not Path(ours.stream.name).exists():
            (root / _FOLDER).mkdir(exist_ok=True)
            path = root.absolute() / _FOLDER / f"{machine()}-{os.getpid()}.json"
            ours = _OURS[root.absolute()] = _Announcement(stream=path.open("wb", buffering=0))
            atexit.register(ours.stream.close)
            _lock(ours.stream, fcntl.LOCK_EX)
        ours.keys.update(keys)
        ours.stream.seek(0)
        ours.stream.truncate()
        ours.stream.write(sealed({"keys": sorted(ours.keys)}).encode())


def keys_in_use(root: Path) -> frozenset[str]:
    """Keys of all runs that live, this process' among them; leftovers are removed. Call it in ``exclusive``.

    Raises
    ------
    InputError
        If a run lives and what it uses cannot be read: anything might be in use then.
    """
    found: set[str] = set()
    for path in (root / _FOLDER).glob("*.json"):
        if not (ANNOUNCEMENT.fullmatch(path.name) and path.is_file()):
            continue
        with path.open("r", encoding="utf-8", errors="replace") as stream:
            text, ended = stream.read(), _lock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            keys = _announced(text)
            if ended and os.access(root, os.W_OK) and (keys is not None or not text):
                path.unlink(missing_ok=True)
            elif not ended and keys is None:
                rule = "says what a run that lives uses, and cannot be read"
                raise InputError("file of the store", path, rule, "try again when that run has ended")
            elif not ended:
                found.update(keys or ())
    return frozenset(found)


def _announced(text: str) -> list[str] | None:
    """Keys in a file that `announce` wrote; None if it is damaged, or another's."""
    content = unsealed(text)
    keys = None if content is None else content.get("keys")
    return keys if isinstance(keys, list) and all(isinstance(k, str) and KEY.fullmatch(k) for k in keys) else None


def _lock(stream: IO[str] | FileIO, how: int) -> bool:
    """Whether the lock was given."""
    try:
        fcntl.flock(stream, how)
    except OSError:
        return False
    return True
