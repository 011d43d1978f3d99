"""Two containers with one host name, one store and the same process numbers: neither waits for nor sweeps the other."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from contracts.machine import lives_here, machine

SCRIPT = """
import os, sys
from pathlib import Path
from workbench.execution.live_runs import announce, exclusive, keys_in_use
from workbench.execution.store import Store
store = Store(Path(sys.argv[1]))
store.sweep()
announce(store.root, [sys.argv[2]])
scratch = store.scratch()
with exclusive(store.root):
    print(os.getpid(), len(keys_in_use(store.root)), flush=True)
sys.stdin.readline()
print(scratch.is_dir(), flush=True)
"""
APART = ["unshare", "--pid", "--fork", "--kill-child", "--mount-proc"]


def test_a_process_of_ours_is_seen_and_one_of_elsewhere_is_not() -> None:
    assert lives_here(machine(), os.getpid())
    assert not lives_here(machine(), 99999999)
    assert not lives_here("elsewhere-00000000", os.getpid())
    assert machine() == machine()


def _container(store: Path, key: str) -> subprocess.Popen[str]:
    command = [*APART, sys.executable, "-c", SCRIPT, str(store), key]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@pytest.mark.timeout(120)
def test_two_sets_of_process_numbers_on_one_store(tmp_path: Path) -> None:
    if shutil.which("unshare") is None or subprocess.run([*APART, "true"], capture_output=True, check=False).returncode:
        pytest.skip("process numbers of one's own need unshare and root")
    with _container(tmp_path / "s", "a" * 64) as one:
        assert one.stdin is not None
        assert one.stdout is not None
        first = one.stdout.readline().split()
        with _container(tmp_path / "s", "b" * 64) as other:
            assert other.stdout is not None
            second = other.stdout.readline().split()
            assert first[0] == second[0]  # the same number, on a host of the same name
            assert [first[1], second[1]] == ["1", "2"]  # both runs live
            assert other.communicate("end\n")[0].strip() == "True"
        one.stdin.write("end\n")
        one.stdin.flush()
        assert one.stdout.readline().strip() == "True"  # the other did not take its scratch for a leftover
