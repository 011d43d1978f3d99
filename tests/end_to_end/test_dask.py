"""Tasks over a Dask scheduler: results in the local store, the same bytes as at home, a killed worker costs nothing."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed import LocalCluster

from tests.end_to_end.small_study import run
from tests.unit.test_workbench_runner import PROBE, Recorder
from workbench.execution.errors import RunError
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """Address of a scheduler with two worker processes."""
    options: dict[str, Any] = {"dashboard_address": "127.0.0.1:0", "silence_logs": False}
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, **options) as cluster:
        yield str(cluster.scheduler_address)


def _sum(tmp_path: Path, name: str, value: float, needs: tuple[str, ...] = ()) -> Task:
    inputs = {"name": name, "value": value, "log": str(tmp_path / "log.txt")}
    return Task(name=name, function=f"{PROBE}:add", inputs=inputs, needs=needs)


def test_results_come_back_into_the_local_store(scheduler: str, tmp_path: Path) -> None:
    tasks = [_sum(tmp_path, "a", 1.0), _sum(tmp_path, "b", 10.0), _sum(tmp_path, "c", 100.0, ("a", "b"))]
    recorder, store = Recorder(), Store(tmp_path / "store")
    entries = run_tasks(tasks, store, recorder, Computing(scheduler=scheduler))
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "111.0"
    assert entries["c"].dofs == 3
    assert ("progressed", "c") in recorder.events
    again = Recorder()
    run_tasks(tasks, store, again)
    assert again.events == [("reused", name) for name in "abc"]


def test_a_killed_worker_is_replaced_and_its_task_goes_on(scheduler: str, tmp_path: Path) -> None:
    """The task kills its worker after each of two steps; on this machine the checkpoint is seen by the next worker."""
    steps = Task(name="steps", function=f"{PROBE}:dying_steps", inputs={"log": str(tmp_path / "steps")}, resumable=True)
    store = Store(tmp_path / "store")
    entries = run_tasks([steps, _sum(tmp_path, "a", 1.0)], store, Recorder(), Computing(scheduler=scheduler))
    assert (tmp_path / "steps").read_text(encoding="utf-8").split() == ["0", "1", "2"]
    assert (entries["steps"].path / "steps.txt").read_text(encoding="utf-8") == "3"
    assert list((store.root / "checkpoints").iterdir()) == []


def test_a_failure_is_told_as_at_home(scheduler: str, tmp_path: Path) -> None:
    bad = Task(name="bad", function=f"{PROBE}:refuse", inputs={})
    with pytest.raises(RunError, match=r"task bad failed: load = -1 N: must be > 0; press harder"):
        run_tasks([bad], Store(tmp_path / "store"), Recorder(), Computing(scheduler=scheduler))


@pytest.mark.parametrize("sources", [{}, {"contracts.of_a_later_version": "0"}, {"contracts/later.csv": "0"}])
def test_a_worker_with_other_code_refuses(
    scheduler: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sources: dict[str, str]
) -> None:
    """The job says that it was made with another numpy than the worker has, or with files that it lacks."""
    other = {"sources": sources, "libraries": {"numpy": "0.1"}}
    monkeypatch.setattr(Task, "origin", lambda self: other)
    task = _sum(tmp_path, "a", 1.0)
    with pytest.raises(RunError, match="task a failed: the cluster's worker has another version of "):
        run_tasks([task], Store(tmp_path / "store"), Recorder(), Computing(scheduler=scheduler))
    assert not (tmp_path / "log.txt").exists()


def test_no_scheduler_is_one_message(tmp_path: Path) -> None:
    with pytest.raises(RunError, match=r"no Dask scheduler answers at nowhere"):
        run_tasks([_sum(tmp_path, "a", 1.0)], Store(tmp_path), Recorder(), Computing(scheduler="nowhere"))


@pytest.mark.long
def test_a_stiffness_curve_over_the_cluster_has_the_same_bytes(
    scheduler: str, workspace: Path, first_report: object, tmp_path: Path
) -> None:
    arguments = ("stiffness", workspace / "study.toml", "--out", "out", "--store", "store", "--scheduler", scheduler)
    assert run(*arguments, folder=tmp_path).returncode == 0
    at_home = ("stiffness", workspace / "study.toml", "--out", "home", "--store", workspace / "store")
    assert "computed in" not in run(*at_home, folder=tmp_path).stdout
    name = "curves/fe_phi000.csv"
    assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "home" / name).read_bytes()
