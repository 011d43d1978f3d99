"""Who of a tree of processes listens on which address, read from Linux' own tables."""

from __future__ import annotations

import contextlib
import ipaddress
import subprocess
import sys
import time
from pathlib import Path

__all__ = ["family", "heard_beyond", "heard_while", "listening"]

_TABLES = {"tcp": "0A", "tcp6": "0A", "udp": "07", "udp6": "07"}
"""Table -> state of a socket that anybody may speak to."""


def listening(root: int) -> set[tuple[str, str]]:
    """Kind and address of every socket on which a process, or one it started, can be spoken to."""
    own = {inode for pid in family(root) for inode in _sockets(pid)}
    found = set()
    for table, state in _TABLES.items():
        for line in Path("/proc/net", table).read_text(encoding="ascii").splitlines()[1:]:
            cells = line.split()
            if cells[3] == state and cells[9] in own:
                found.add((table, _address(cells[1].partition(":")[0])))
    return found


def heard_beyond(found: set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Those of `listening` that another machine can reach."""
    return {(kind, address) for kind, address in found if not ipaddress.ip_address(address).is_loopback}


def heard_while(process: subprocess.Popen[str]) -> set[tuple[str, str]]:
    """All of `listening` until a process ends."""
    found: set[tuple[str, str]] = set()
    while process.poll() is None:
        found |= listening(process.pid)
        time.sleep(0.02)
    return found


def family(root: int) -> set[int]:
    """A process and all it started."""
    parents = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdecimal():
            with contextlib.suppress(OSError):
                parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
    family, fresh = {root}, {root}
    while fresh:
        fresh = {pid for pid, parent in parents.items() if parent in fresh} - family
        family |= fresh
    return family


def _sockets(pid: int) -> set[str]:
    found = set()
    with contextlib.suppress(OSError):
        for one in Path(f"/proc/{pid}/fd").iterdir():
            with contextlib.suppress(OSError):
                target = str(one.readlink())
                if target.startswith("socket:["):
                    found.add(target[8:-1])
    return found


def _address(digits: str) -> str:
    """Of the kernel's hexadecimal words, each in this machine's order of bytes."""
    words = [int(digits[i : i + 8], 16).to_bytes(4, sys.byteorder) for i in range(0, len(digits), 8)]
    address = ipaddress.ip_address(b"".join(words))
    return str(getattr(address, "ipv4_mapped", None) or address)
