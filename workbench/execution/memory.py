"""Whether memory ran out: what the kernel counts, what an error says, how much there is; and whether a run will fit.

The kernel counts the processes it killed for want of memory, for a control group (a container, a batch job) and for the
machine. A worker that died by SIGKILL while the count did not move was killed by somebody else.

Verified by tests/unit/test_execution_memory.py, tests/unit/test_workbench_memory.py and
tests/end_to_end/test_memory.py.
"""

from __future__ import annotations

import errno
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.errors import MemoryLimitError
from contracts.memory import MemoryBound, free_memory, shown_size, total_memory

if TYPE_CHECKING:
    from workbench.execution.task import Task

__all__ = ["KillCount", "limit_text", "memory_warning", "out_of_memory"]

_SURE = 0.9
"""Part of the expected memory that a task takes at the least: below, a refusal could be wrong."""
_HINT = "choose a larger element_size or axial_size, a smaller factor, or a machine with more memory"
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


def memory_warning(
    tasks: Sequence[Task], workers: int, free: MemoryBound | None = None, total: MemoryBound | None = None
) -> str:
    """What to tell the user of the memory that the run will take; empty if it fits.

    Parameters
    ----------
    tasks : those still to be computed
    workers : how many run at once
    free, total : what each of them may take now, and one at the very most; read from the system if left out

    Raises
    ------
    MemoryLimitError
        If a task needs more than a process can ever have here.
    """
    largest = sorted((task for task in tasks if task.memory > 0.0), key=lambda task: -task.memory)[: max(workers, 1)]
    if not largest:
        return ""
    first, total = largest[0], total or total_memory()
    if _SURE * first.memory > total.bytes:
        raise MemoryLimitError(f"{_need(first)}, and {total}", _HINT)
    count = len(largest)
    together, free = sum(task.memory for task in largest), free or free_memory(processes=count)
    if together <= count * free.bytes and first.memory <= total.bytes:
        return ""
    if count == 1:
        return f"{_need(first)}, and {free}: it may run out of memory; {_HINT}"
    return (
        f"{_need(first)}, {count} tasks at once about {shown_size(together)}, and "
        f"{shown_size(count * free.bytes)} are available {free.source}: they may run out of memory; use --workers 1, "
        f"or {_HINT}"
    )


def _need(task: Task) -> str:
    unknowns = f" for its {task.unknowns} unknowns" if task.unknowns else ""
    return f"task {task.name} needs about {shown_size(task.memory)}{unknowns}"
