"""A run's memory judged before it starts: refused beyond what there is, warned of beyond what is free."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from contracts.errors import MemoryLimitError
from contracts.memory import MemoryBound, free_memory, shown_size, total_memory
from workbench.execution.memory import memory_warning
from workbench.execution.task import Task


def _task(name: str, memory: float) -> Task:
    return Task(name=name, function="m:f", inputs={}, memory=memory, unknowns=2_600_000)


def _bound(amount: float, source: str = "on this machine now") -> MemoryBound:
    return MemoryBound(bytes=amount, source=source)


def test_what_fits_is_not_spoken_of() -> None:
    tasks = [_task("a", 2e9), _task("b", 1e9), Task(name="small", function="m:f", inputs={})]
    assert memory_warning(tasks, 2, _bound(2e9), _bound(9e9)) == ""
    assert memory_warning([], 2) == ""


def test_more_than_there_is_in_all_is_refused_with_the_numbers() -> None:
    with pytest.raises(MemoryLimitError) as caught:
        memory_warning([_task("fe_phi000", 18e9)], 1, _bound(9e9), _bound(14e9, "on this machine in all"))
    assert str(caught.value) == (
        "out of memory: task fe_phi000 needs about 18 GB for its 2600000 unknowns, and 14 GB are available on this "
        "machine in all; choose a larger element_size or axial_size, a smaller factor, or a machine with more memory"
    )


def test_more_than_is_free_is_a_warning() -> None:
    text = memory_warning([_task("a", 6e9)], 2, _bound(5e9), _bound(16e9))
    assert text.startswith("task a needs about 6 GB for its 2600000 unknowns, and 5 GB are available on this")
    assert "larger element_size" in text


def test_two_at_once_need_both() -> None:
    """Each fits alone; with one worker nothing is said."""
    tasks = [_task("a", 6e9), _task("b", 5e9)]
    assert "2 tasks at once about 11 GB" in memory_warning(tasks, 2, _bound(5e9), _bound(16e9))
    assert memory_warning(tasks, 1, _bound(10e9), _bound(16e9)) == ""


def test_an_expectation_within_its_error_is_no_refusal() -> None:
    assert "may run out" in memory_warning([_task("a", 15e9)], 1, _bound(9e9), _bound(14e9))


@pytest.mark.parametrize(
    ("amount", "shown"), [(4.8e8, "480 MB"), (9.9999e8, "1 GB"), (3.14e9, "3.1 GB"), (1.4e10, "14 GB")]
)
def test_sizes_for_people(amount: float, shown: str) -> None:
    assert shown_size(amount) == shown


def _system(folder: Path, group: dict[str, str], version: int) -> tuple[Path, Path]:
    """A /proc with 8 GB, 6 of them free, and a control group of this process."""
    proc, cgroup = folder / "proc", folder / "cgroup"
    (proc / "self").mkdir(parents=True)
    (proc / "meminfo").write_text("MemTotal: 8000000 kB\nMemAvailable: 6000000 kB\nSwapTotal: 0 kB\nHugePages: 0\n")
    (proc / "self" / "status").write_text("Name: python\nVmSize: 500000 kB\n")
    lines = "0::/a/b\n" if version == 2 else "5:cpu:/\n4:memory:/a/b\n0::/\n"
    (proc / "self" / "cgroup").write_text(lines)
    place = (cgroup if version == 2 else cgroup / "memory") / "a" / "b"
    place.mkdir(parents=True)
    for name, text in group.items():
        (place / name).write_text(text)
    return proc, cgroup


@pytest.mark.parametrize(
    ("version", "names"),
    [(2, ("memory.max", "memory.current")), (1, ("memory.limit_in_bytes", "memory.usage_in_bytes"))],
)
def test_a_control_group_bounds_the_memory(tmp_path: Path, version: int, names: tuple[str, str]) -> None:
    """3 GB, of which 1.5 are used, 0.5 of them copies of files that the system gives up when asked."""
    stat = "anon 1000000000\ninactive_file 300000000\nactive_file 200000000\n"
    group = {names[0]: "3000000000\n", names[1]: "1500000000\n", "memory.stat": stat}
    proc, cgroup = _system(tmp_path, group, version)
    assert total_memory(proc=proc, cgroup=cgroup).bytes == 3e9
    free = free_memory(proc=proc, cgroup=cgroup)
    assert free.bytes == 2e9
    assert "control group" in free.source
    assert free_memory(4, proc=proc, cgroup=cgroup).bytes == 5e8


def test_without_a_limit_the_machine_is_the_bound(tmp_path: Path) -> None:
    proc, cgroup = _system(tmp_path, {"memory.max": "max\n"}, 2)
    assert free_memory(proc=proc, cgroup=cgroup).bytes == 6000000 * 1024
    assert total_memory(proc=proc, cgroup=cgroup).bytes == 8000000 * 1024


def test_a_limit_of_address_space_is_seen() -> None:
    code = "from contracts.memory import *; print(total_memory().bytes, free_memory().bytes, free_memory().source)"

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (3 * 10**8, 3 * 10**8))

    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, preexec_fn=limit)
    total, free, source = run.stdout.split(maxsplit=2)
    assert float(total) == 3e8
    assert 0.0 <= float(free) < 3e8
    assert "ulimit -v" in source
