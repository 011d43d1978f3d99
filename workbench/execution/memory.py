"""Whether memory ran out: what the kernel counts, what an error says, how much there is.

The kernel counts the processes it killed for want of memory, for a control group (a container, a batch job) and for the
machine. A worker that died by SIGKILL while the count did not move was killed by somebody else.

Verified by tests/unit/test_execution_memory.py and tests/end_to_end/test_memory.py.
"""

from __future__ import annotations

import errno
from pathlib import Path

from contracts.memory import shown_size, total_memory

__all__ = ["KillCount", "limit_text", "out_of_memory"]

_PETSC_ERR_MEM = 55
_SIGNS = ("bad_alloc", "cannot allocate memory", "out of memory", "unable to allocate")
"""How libraries say it that raise or print something else than a MemoryError."""


def out_of_memory(error: BaseException | str) -> bool:
    """Whether an error, or what a process printed, says that memory ran out."""
    if isinstance(error, MemoryError):
        return True
    if isinstance(error, OSError):
        return error.errno == errno.ENOMEM
    text = str(error).lower()
    return getattr(error, "ierr", None) == _PETSC_ERR_MEM or any(sign in text for sign in _SIGNS)


class KillCount:
    """The kernel's count of processes killed for want of memory, and how many of them are accounted for.

    Parameters
    ----------
    root : of the file system; another one in tests
    """

    def __init__(self, root: Path = Path("/")) -> None:
        self._root = root
        self._seen = self._count()

    @property
    def known(self) -> bool:
        """Whether the kernel tells."""
        return self._seen is not None

    def one_more(self) -> bool:
        """Whether the kernel has killed one more than is accounted for; it is accounted for now."""
        count = self._count()
        if count is None or self._seen is None or count <= self._seen:
            return False
        self._seen += 1
        return True

    def _count(self) -> int | None:
        files = [
            folder / name for folder in _groups(self._root)[:1] for name in ("memory.events", "memory.oom_control")
        ]
        for path in (*files, self._root / "proc" / "vmstat"):
            count = _number(path, "oom_kill")
            if count is not None:
                return count
        return None


def limit_text() -> str:
    """How much memory a worker may have at most, and who says so: ``"24 GB on this machine in all"``."""
    bound = total_memory()
    return f"{shown_size(bound.bytes)} {bound.source}"


def _groups(root: Path) -> list[Path]:
    """Folders of this process' control group for memory, its own first, then those around it; none where unknown."""
    mounts = {"memory": root / "sys" / "fs" / "cgroup" / "memory", "": root / "sys" / "fs" / "cgroup"}
    for line in _read(root / "proc" / "self" / "cgroup").splitlines():
        _, controllers, path = line.split(":", 2)
        mount = mounts.get(controllers)
        if mount is None:
            continue
        own = mount / path.lstrip("/")
        own = own if own.is_dir() else mount  # in a container whose own group is mounted there
        if any((own / name).exists() for name in ("memory.events", "memory.oom_control")):
            return [own, *(folder for folder in own.parents if folder.is_relative_to(mount))]
    return []


def _number(path: Path, name: str) -> int | None:
    """The number behind a name in a file of lines such as ``oom_kill 3``."""
    for line in _read(path).splitlines():
        words = line.split()
        if len(words) >= 2 and words[0] == name and words[1].isdigit():
            return int(words[1])
    return None


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""
