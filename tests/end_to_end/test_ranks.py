"""``workbench stiffness --ranks 2``: the curve of one process to 1e-8; a failure on the ranks is one message."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import environment, run
from tests.listening import family
from tests.unit.test_workbench_runner import PROBE, Recorder
from workbench.execution.errors import RunError
from workbench.execution.ranks import mpiexec
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task


@pytest.mark.long
def test_two_ranks_yield_the_curve_of_one(
    workspace: Path, first_report: subprocess.CompletedProcess[str], tmp_path: Path
) -> None:
    arguments = ("stiffness", workspace / "study.toml", "--out", "out", "--store", "store", "--ranks", "2")
    done = run(*arguments, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    two = read_curve(tmp_path / "out" / "curves" / "fe_phi000.csv")
    one = read_curve(workspace / "report" / "curves" / "fe_phi000.csv")
    np.testing.assert_allclose(two.load, one.load, rtol=1e-8)
    np.testing.assert_array_equal(two.deflection, one.deflection)


def test_progress_and_result_of_the_first_process_come_back(tmp_path: Path) -> None:
    task = Task(name="t", function=f"{PROBE}:count_ranks", inputs={"log": str(tmp_path / "log")}, shared=True)
    recorder = Recorder()
    entry = run_tasks([task], Store(tmp_path / "store"), recorder, Computing(ranks=2))["t"]
    assert (entry.path / "rank.txt").read_text(encoding="utf-8") == "0 of 2"
    assert entry.dofs == 2
    assert ("progressed", "t") in recorder.events
    assert sorted((tmp_path / "log").read_text(encoding="utf-8").split()) == ["0", "1"]


@pytest.mark.parametrize(("function", "message"), [("refuse", "must be > 0; press harder"), ("crash", "by zero")])
def test_a_failure_on_the_ranks_is_told(tmp_path: Path, function: str, message: str) -> None:
    task = Task(name="t", function=f"{PROBE}:{function}", inputs={}, shared=True)
    with pytest.raises(RunError, match=f"task t failed: .*{message}"):
        run_tasks([task], Store(tmp_path / "store"), Recorder(), Computing(ranks=2))


def test_a_task_that_cannot_be_shared_runs_once(tmp_path: Path) -> None:
    task = Task(name="t", function=f"{PROBE}:count_ranks", inputs={"log": str(tmp_path / "log")})
    entry = run_tasks([task], Store(tmp_path / "store"), Recorder(), Computing(ranks=2))["t"]
    assert (entry.path / "rank.txt").read_text(encoding="utf-8") == "0 of 1"


def test_processes_end_with_their_launcher(tmp_path: Path) -> None:
    """A worker that is killed takes its launcher along, and that must leave nobody computing."""
    told = tmp_path / "pid"
    job = {
        "name": "t",
        "function": f"{PROBE}:wait",
        "inputs": {"pid": str(told)},
        "needs": {},
        "origin": {},
        "ranks": 2,
    }
    places = {"folder": str(tmp_path), "checkpoint": None, "store": None}
    (tmp_path / "job.json").write_text(json.dumps(job | places), encoding="utf-8")
    command = [mpiexec(), "-n", "2", sys.executable, "-m", "workbench.execution.ranks", str(tmp_path / "job.json")]
    processes = set[int]()
    for _ in range(3):  # MPI itself did not start once in thousands of runs: "invalid bandwidth 0.00", says its UCX
        with subprocess.Popen(command, env=environment()) as launcher:
            _until(lambda launcher=launcher: told.exists() or launcher.poll() is not None)  # type: ignore[misc]
            if told.exists():  # by one of them, after MPI's start, at which they wait for each other
                processes = family(launcher.pid) - {launcher.pid}
                launcher.kill()
                break
    assert len(processes) >= 2
    _until(lambda: not any(_runs(pid) for pid in processes))


def _until(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 300.0
    while not true():
        assert time.monotonic() < end
        time.sleep(0.05)


def _runs(pid: int) -> bool:
    """Whether it is there, and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
