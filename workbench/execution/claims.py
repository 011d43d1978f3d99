"""Who computes which result now: a task that another run on the same store computes is waited for, not done twice.

A claim is a locked file (flock) in ``STORE/claims``, given back by the operating system when the process ends, however
it ends. It saves work, and nothing rests on it: where there are no locks both runs compute, and the store keeps one.

Verified by tests/unit/test_workbench_runner.py.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path
from typing import IO

__all__ = ["Claims"]


class Claims:
    """What this run has claimed.

    Parameters
    ----------
    root : of the store
    """

    def __init__(self, root: Path) -> None:
        self._folder = root / "claims"
        self._folder.mkdir(exist_ok=True)
        self._held: dict[str, IO[str]] = {}

    def take(self, key: str) -> bool:
        """Whether the key is ours now; False if another run that lives computes it."""
        path = self._folder / key
        try:
            stream = None if os.path.lexists(path) and not path.is_file() else path.open("a", encoding="utf-8")
        except OSError:
            stream = None
        if stream is None:  # something stands in its place: both compute
            return True
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            stream.close()
            return False
        except OSError:  # no locks here
            pass
        self._held[key] = stream
        return True

    def give_back(self, key: str) -> None:
        """The key is computed, or will not be."""
        stream = self._held.pop(key, None)
        if stream is not None:
            with contextlib.suppress(FileNotFoundError):
                (self._folder / key).unlink()
            stream.close()

    def give_back_all(self) -> None:
        """The run ends."""
        for key in list(self._held):
            self.give_back(key)
