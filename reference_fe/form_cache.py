"""A folder of compiled forms for one process at a time, so that one that died while it compiled stops nobody.

FFCx marks a form in work by its C file and one that is done by a second file. Whoever finds the first alone waits ten
seconds for the second and then gives up: a killed run would spoil every later one, and a busy machine those beside it.
Here a lock, which the operating system takes back when its process ends, says who compiles; a C file alone is then what
a dead process left. Verified by tests/unit/test_fe_form_cache.py.
"""

from __future__ import annotations

import contextlib
import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

__all__ = ["sole_compiler"]

_LOCK = "lock"


@contextmanager
def sole_compiler(folder: Path) -> Iterator[None]:
    """Hold the folder of compiled forms, made if it is not there, and remove what was begun in it and never ended.

    Where a file system has no locks, or cannot be written, nothing is held and nothing removed.
    """
    with contextlib.ExitStack() as held:
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            stream = held.enter_context((folder / _LOCK).open("a", encoding="utf-8"))
            fcntl.flock(stream, fcntl.LOCK_EX)
            for begun in folder.glob("libffcx_*.c"):
                if not begun.with_suffix(".c.cached").exists():
                    begun.unlink(missing_ok=True)
        yield
