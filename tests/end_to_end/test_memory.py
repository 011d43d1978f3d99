"""Memory that runs out is told from a kill from outside; the task is tried once more, alone, and given up with numbers.

The limits are those a user meets: a control group (a container, a batch job), in which the kernel kills, and a limit of
address space (``ulimit -v``), within which an allocation fails.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.end_to_end.small_study import environment

LIMIT = 600_000_000
"""Memory of the control group [bytes]; a worker of these tests needs a tenth of it."""
SCRIPT = """
import os, resource, sys
from pathlib import Path
folder, group, space = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
if group:
    Path(group, "cgroup.procs").write_text(str(os.getpid()))
from tests.unit.test_workbench_runner import PROBE, Recorder
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task
def main():
    common = {"log": str(folder / "log.txt"), "value": 1.0}
    tasks = [Task(name=n, function=f"{PROBE}:add", inputs=common | {"name": n}) for n in "ab"]
    tasks += [Task(name="big", function=f"{PROBE}:allocate", inputs=common | {"name": "big"}, cost=9.0)]
    if space:
        resource.setrlimit(resource.RLIMIT_AS, (space, space))
    recorder = Recorder()
    try:
        run_tasks(tasks, Store(folder / "store"), recorder, Computing(workers=2))
    except Exception as error:
        print(type(error).__name__, error)
    print(*(f"{kind} {text}" for kind, text in recorder.events if kind in ("restarted", "computed")), sep="\\n")
if __name__ == "__main__":
    main()
"""


@pytest.fixture
def group() -> Iterator[Path]:
    """A control group with little memory."""
    mounts = Path("/sys/fs/cgroup/memory"), Path("/sys/fs/cgroup")
    mount = next((m for m in mounts if (m / "cgroup.procs").exists() and os.access(m, os.W_OK)), None)
    made = mount and mount / f"workbench-test-{uuid.uuid4().hex[:8]}"
    limits = ("memory.limit_in_bytes", "memory.memsw.limit_in_bytes", "memory.max", "memory.swap.max")
    try:
        assert made is not None
        made.mkdir()
        found = [name for name in limits if (made / name).exists()]
        assert found
    except (OSError, AssertionError):
        if made is not None and made.is_dir():
            made.rmdir()
        pytest.skip("a control group with a limit of memory needs root and a writable /sys/fs/cgroup")
    for name in found:
        (made / name).write_text("0" if name == "memory.swap.max" else str(LIMIT), encoding="ascii")
    yield made
    end = time.monotonic() + 60.0
    while (made / "cgroup.procs").read_text(encoding="ascii") and time.monotonic() < end:
        time.sleep(0.1)  # what was killed is counted until it has ended
    made.rmdir()


def _said(folder: Path, group: str, space: int) -> list[str]:
    (folder / "run.py").write_text(SCRIPT, encoding="utf-8")
    arguments = [sys.executable, str(folder / "run.py"), str(folder), group, str(space)]
    ended = subprocess.run(arguments, env=environment(), capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    return ended.stdout.splitlines()


def test_a_task_that_the_kernel_kills_for_memory(group: Path, tmp_path: Path) -> None:
    message, *events = _said(tmp_path, str(group), 0)
    assert message.startswith("RunError task big failed twice, the second time alone: the kernel killed it because ")
    assert "memory ran out: it held " in message
    assert (
        "of 600 MB within this control group's limit; finished results are kept, start again with more memory"
        in message
    )
    assert sorted(e for e in events if e.startswith("computed")) == ["computed a", "computed b"]
    (restarted,) = (e for e in events if e.startswith("restarted"))
    assert restarted.startswith("restarted big: the kernel killed it because memory ran out: it held ")
    assert (tmp_path / "log.txt").read_text(encoding="utf-8").split().count("big") == 2


@pytest.mark.long
def test_an_allocation_that_fails(tmp_path: Path) -> None:
    message, *events = _said(tmp_path, "", 4_000_000_000)
    assert message.startswith("RunError task big failed twice, the second time alone: no memory left")
    assert "of 4 GB within this process' limit of address space (ulimit -v)" in message
    assert sorted(e for e in events if e.startswith("computed")) == ["computed a", "computed b"]
    assert (tmp_path / "log.txt").read_text(encoding="utf-8").split().count("big") == 2
