"""Where a process number means something: names under which processes leave files for each other in a shared folder.

Verified by tests/unit/test_machine.py.
"""

from __future__ import annotations

import hashlib
import socket
from functools import cache
from pathlib import Path

__all__ = ["lives_here", "machine"]

_BOOT = Path("/proc/sys/kernel/random/boot_id")
_PROCESS_NUMBERS = Path("/proc/self/ns/pid")


@cache
def machine() -> str:
    """Host name and eight digits for this start of the machine and this set of process numbers.

    Containers may share a host name, a folder and even the number of their process; without the digits one would take
    the other's files for leftovers. On systems without ``/proc`` the host name alone.
    """
    try:
        told = f"{_BOOT.read_text(encoding='ascii')}{_PROCESS_NUMBERS.readlink()}"
    except OSError:
        return socket.gethostname()
    return f"{socket.gethostname()}-{hashlib.sha256(told.encode()).hexdigest()[:8]}"


def lives_here(name: str, pid: str | int) -> bool:
    """Whether the process ``pid`` of the ``machine()`` of this name can be seen from here, and lives."""
    return name == machine() and Path(f"/proc/{pid}").exists()
