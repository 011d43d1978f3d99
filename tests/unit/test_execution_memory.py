"""What the kernel counts and how much memory there is, read from files like the kernel's."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from contracts.memory import shown_size
from workbench.execution.memory import KillCount, limit_text, out_of_memory

GROUP = "batch/job7"


def _machine(root: Path, *, version: int, kills: int) -> Path:
    """A machine whose control groups are of version 1 or 2, or that has none (0); returns the file that counts."""
    (root / "proc" / "self").mkdir(parents=True, exist_ok=True)
    (root / "proc" / "meminfo").write_text("MemTotal:       24000000 kB\nMemFree: 1 kB\n", encoding="ascii")
    (root / "proc" / "vmstat").write_text(f"pgfault 3\noom_kill {100 + kills}\n", encoding="ascii")
    lines = {0: "", 1: f"9:cpu:/\n4:memory:/{GROUP}\n0::/\n", 2: f"0::/{GROUP}\n"}[version]
    (root / "proc" / "self" / "cgroup").write_text(lines, encoding="ascii")
    if version == 0:
        return root / "proc" / "vmstat"
    mount = root / "sys" / "fs" / "cgroup" / ("memory" if version == 1 else "")
    own = mount / GROUP
    own.mkdir(parents=True, exist_ok=True)
    counts, limit = ("memory.oom_control", "memory.limit_in_bytes") if version == 1 else ("memory.events", "memory.max")
    (own / counts).write_text(f"low 0\noom 9\noom_kill {kills}\n", encoding="ascii")
    (own / limit).write_text("max\n" if version == 2 else "9223372036854771712\n", encoding="ascii")
    (own.parent / limit).write_text("2000000000\n", encoding="ascii")
    return own / counts


@pytest.mark.parametrize("version", [0, 1, 2])
def test_a_kill_is_accounted_for_once(tmp_path: Path, version: int) -> None:
    _machine(tmp_path, version=version, kills=4)
    count = KillCount(tmp_path)
    assert count.known
    assert not count.one_more()
    _machine(tmp_path, version=version, kills=6)
    assert [count.one_more() for _ in range(3)] == [True, True, False]


def test_the_own_group_counts_not_the_machine(tmp_path: Path) -> None:
    """What the kernel kills in another container is not ours."""
    _machine(tmp_path, version=2, kills=0)
    count = KillCount(tmp_path)
    (tmp_path / "proc" / "vmstat").write_text("oom_kill 999\n", encoding="ascii")
    assert not count.one_more()


def test_a_machine_that_does_not_count(tmp_path: Path) -> None:
    count = KillCount(tmp_path)
    assert not count.known
    assert not count.one_more()


def test_this_machine_tells() -> None:
    assert KillCount().known
    assert " GB " in limit_text()


class _PetscError(RuntimeError):
    ierr = 55


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (MemoryError(), True),
        (OSError(errno.ENOMEM, "Cannot allocate memory", "x"), True),
        (OSError(errno.ENOSPC, "out of memory, says a disk", "x"), False),
        (_PetscError("error code 55"), True),
        (RuntimeError("std::bad_alloc"), True),
        ("terminate called after throwing an instance of 'std::bad_alloc'", True),
        (RuntimeError("matrix is singular"), False),
        ("", False),
    ],
)
def test_what_errors_and_output_say(error: BaseException | str, expected: bool) -> None:
    assert out_of_memory(error) is expected


def test_sizes() -> None:
    assert [shown_size(n) for n in (12, 200_000, 2_500_000, 24e9)] == ["12 bytes", "200 kB", "2.5 MB", "24 GB"]
