"""Files that a library writes without saying whether it could: cut off where the disk is full.

Verified by tests/unit/test_geometry_written.py.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path

__all__ = ["check_written"]

_TAIL = 200


def check_written(path: Path, end: bytes) -> None:
    """Make sure that a file ends as its format does; one that does not is removed.

    Parameters
    ----------
    path : file a library wrote
    end : its last bytes but white space, e.g. ``b"$EndElements"``

    Raises
    ------
    OSError
        ENOSPC if the file is missing or cut off.
    """
    try:
        with path.open("rb") as stream:
            stream.seek(max(0, path.stat().st_size - _TAIL))
            whole = stream.read().rstrip().endswith(end)
    except FileNotFoundError:
        whole = False
    if not whole:
        path.unlink(missing_ok=True)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
