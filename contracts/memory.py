"""How much memory this process may still take, by every limit that the system sets.

Verified by tests/unit/test_workbench_memory.py.
"""

from __future__ import annotations

import resource
from dataclasses import dataclass, replace
from pathlib import Path

__all__ = ["MemoryBound", "free_memory", "limited_address_space", "shown_size", "total_memory"]

_PROC, _CGROUP = Path("/proc"), Path("/sys/fs/cgroup")


@dataclass(frozen=True, slots=True, kw_only=True)
class MemoryBound:
    """An amount of memory and what sets it.

    Attributes
    ----------
    bytes : amount [byte]
    source : in words, after "are available"
    """

    bytes: float
    source: str

    def __str__(self) -> str:
        return f"{shown_size(self.bytes)} are available {self.source}"


def shown_size(amount: float) -> str:
    """A size [byte] for people: ``"12 bytes"``, ``"480 MB"``, ``"3.1 GB"``, ``"27 GB"``."""
    for size, unit in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if amount >= 0.9995 * size:
            return f"{amount / size:{'.2g' if amount < 9.95 * size else '.0f'}} {unit}"
    return f"{amount:.0f} bytes"


def free_memory(processes: int = 1, *, proc: Path = _PROC, cgroup: Path = _CGROUP) -> MemoryBound:
    """What each of some equal processes may still take now.

    The least of this process' address space and its share of control group and machine.
    """
    used = _sizes(proc / "self" / "status")
    shared = _groups(proc, cgroup, used=True)
    machine = _sizes(proc / "meminfo")
    if "MemAvailable" in machine:
        amount = machine["MemAvailable"] + machine.get("SwapFree", 0.0)
        shared.append(MemoryBound(bytes=amount, source="on this machine now"))
    each = [replace(bound, bytes=bound.bytes / processes) for bound in shared]
    return min([_address_space(used.get("VmSize", 0.0)), *each], key=lambda bound: bound.bytes)


def total_memory(*, proc: Path = _PROC, cgroup: Path = _CGROUP) -> MemoryBound:
    """What a process may take at the very most, were nothing else running."""
    bounds = [_address_space(0.0), *_groups(proc, cgroup, used=False)]
    machine = _sizes(proc / "meminfo")
    if "MemTotal" in machine:
        amount = machine["MemTotal"] + machine.get("SwapTotal", 0.0)
        bounds.append(MemoryBound(bytes=amount, source="on this machine in all"))
    return min(bounds, key=lambda bound: bound.bytes)


def limited_address_space() -> str:
    """``"0.8 GB"`` where this process' address space is limited, else empty."""
    bound = _address_space(0.0)
    return "" if bound.bytes == float("inf") else shown_size(bound.bytes)


def _address_space(used: float) -> MemoryBound:
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    amount = float("inf") if limit == resource.RLIM_INFINITY else max(float(limit) - used, 0.0)
    return MemoryBound(bytes=amount, source="within this process' limit of address space (ulimit -v)")


def _groups(proc: Path, cgroup: Path, *, used: bool) -> list[MemoryBound]:
    """Limits of the control groups of this process, version 2 and 1, each less what is used if asked for."""
    try:
        lines = (proc / "self" / "cgroup").read_text().splitlines()
    except OSError:
        return []
    found = []
    for line in lines:
        _, controllers, path = line.split(":", 2)
        second = controllers == ""
        if not second and "memory" not in controllers.split(","):
            continue
        root = cgroup if second else cgroup / "memory"
        names = ("memory.max", "memory.current") if second else ("memory.limit_in_bytes", "memory.usage_in_bytes")
        group = Path(path.lstrip("/"))
        for folder in (root / group, *(root / parent for parent in group.parents)):
            limit = _number(folder / names[0])
            if limit is not None:
                taken = (_number(folder / names[1]) or 0.0) - _file_cache(folder) if used else 0.0
                amount = max(limit - max(taken, 0.0), 0.0)
                found.append(MemoryBound(bytes=amount, source="within this control group's limit"))
    return found


def _file_cache(folder: Path) -> float:
    """Copies of files that a control group is charged for and gives up when asked [byte]."""
    try:
        rows = dict(line.split() for line in (folder / "memory.stat").read_text().splitlines())
    except (OSError, ValueError):
        return 0.0
    return sum(float(rows.get(name, 0.0)) for name in ("inactive_file", "active_file"))


def _number(path: Path) -> float | None:
    """The number in a file of a control group; None without one."""
    try:
        return float(int(path.read_text()))
    except (OSError, ValueError):
        return None


def _sizes(path: Path) -> dict[str, float]:
    """``Name:  123 kB`` lines of a file, in bytes; none where the system has no such file."""
    try:
        lines = path.read_text().splitlines()
    except OSError:
        return {}
    fields = (line.split() for line in lines if line.endswith(" kB"))
    return {name.rstrip(":"): 1024.0 * float(amount) for name, amount, _ in fields}
