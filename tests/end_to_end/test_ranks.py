"""``workbench stiffness --ranks 2``: the curve of one process to 1e-8; a failure on the ranks is one message."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import run
from tests.unit.test_workbench_runner import PROBE, Recorder
from workbench.execution.errors import RunError
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task


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
