"""What can be lost between a run and its cluster: a result, a worker, the scheduler, the network.

The run goes on, or ends with one message; finished results are kept and no finished task is computed twice. A real
scheduler and real workers, started here, on loopback. Nothing rests on time: each disturbance waits for the event that
it is to disturb, and ends when the run has noticed.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.end_to_end.dask_processes import Cluster, Link, go_on, stop, wait_for
from tests.unit.test_workbench_runner import PROBE, Recorder
from workbench.execution import dask_workers
from workbench.execution.dask_workers import DaskWorkers
from workbench.execution.errors import RunError
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Entry, Store
from workbench.execution.task import Task


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    (tmp_path / "cluster").mkdir()
    found = Cluster(tmp_path / "cluster")
    try:
        found.add_worker()
        yield found
    finally:
        found.close()


@pytest.fixture
def noticed(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Set when the run looks for its scheduler anew; it asks often and soon takes no answer for none."""
    event, again = threading.Event(), DaskWorkers._connect_again

    def connect_again(self: DaskWorkers) -> None:
        event.set()
        again(self)

    monkeypatch.setattr(DaskWorkers, "_connect_again", connect_again)
    monkeypatch.setattr(dask_workers, "_LOOK_EVERY", 0.5)
    monkeypatch.setattr(dask_workers, "_ANSWER", 10.0)
    return event


def _tasks(folder: Path) -> list[Task]:
    """One that is soon finished, one that waits behind a gate, one that needs both."""
    common = {"log": str(folder / "log.txt"), "gate": str(folder / "gate")}
    first = Task(name="a", function=f"{PROBE}:add", inputs={"name": "a", "value": 1.0} | common, cost=9.0)
    gated = Task(name="g", function=f"{PROBE}:gated", inputs={"name": "g", "value": 10.0} | common, needs=("a",))
    return [first, gated, _last(common)]


def _last(common: dict[str, str]) -> Task:
    return Task(name="c", function=f"{PROBE}:add", inputs={"name": "c", "value": 100.0} | common, needs=("a", "g"))


def _run(folder: Path, address: str, disturb: Callable[[Recorder], None]) -> dict[str, Entry]:
    """Run the tasks, while the disturbance comes as soon as the task behind the gate runs; it opens the gate."""
    recorder, failed, ended = Recorder(), list[BaseException](), threading.Event()

    def watch() -> None:
        try:
            wait_for(lambda: "g" in _begun(folder) or ended.is_set(), "the task behind the gate")
            if not ended.is_set():
                disturb(recorder)
        except BaseException as error:
            failed.append(error)
        finally:
            (folder / "gate").touch()

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        entries = run_tasks(_tasks(folder), Store(folder / "store"), recorder, Computing(scheduler=address))
    finally:
        ended.set()
        thread.join()
    assert failed == []
    return entries


def _begun(folder: Path) -> list[str]:
    """Names of tasks in the order in which they began."""
    log = folder / "log.txt"
    return log.read_text(encoding="utf-8").split() if log.exists() else []


def _whole(folder: Path, entries: dict[str, Entry]) -> None:
    """Every result is there, and what had finished before the disturbance was computed once."""
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "111.0"
    assert [_begun(folder).count(name) for name in ("a", "c")] == [1, 1]
    assert list((folder / "store" / "tmp").iterdir()) == []


def test_a_result_whose_worker_dies_before_it_is_fetched_is_computed_again(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a busy machine the time between a task's end and the fetching of its result is long enough for this."""
    outcome, killed = DaskWorkers._outcome, list[int]()

    def kill_first(self: DaskWorkers, token: str, attempt: Any) -> object:
        if not killed:
            (worker,) = cluster.workers
            killed.append(worker.pid)
            os.kill(worker.pid, signal.SIGKILL)
            wait_for(lambda: attempt.future.status == "lost", "the loss")
            cluster.add_worker()
        return outcome(self, token, attempt)

    monkeypatch.setattr(DaskWorkers, "_outcome", kill_first)
    entries = _run(tmp_path, cluster.address, lambda recorder: None)
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "111.0"
    assert _begun(tmp_path).count("g") == 1
    assert killed


def test_a_worker_that_is_killed_and_replaced(cluster: Cluster, tmp_path: Path) -> None:
    def disturb(recorder: Recorder) -> None:
        cluster.add_worker()
        os.kill(cluster.workers[0].pid, signal.SIGKILL)
        wait_for(lambda: _begun(tmp_path).count("g") == 2, "another worker")

    _whole(tmp_path, _run(tmp_path, cluster.address, disturb))


def test_a_scheduler_that_is_killed_and_started_again(
    cluster: Cluster, tmp_path: Path, noticed: threading.Event
) -> None:
    """Its workers end with it, as Dask's do; new ones come with the new scheduler, which knows of nothing."""

    def disturb(recorder: Recorder) -> None:
        os.kill(cluster.scheduler.pid, signal.SIGKILL)
        wait_for(noticed.is_set, "the run to notice")
        cluster.start_scheduler()
        cluster.add_worker()
        wait_for(lambda: _begun(tmp_path).count("g") == 2, "the new worker")

    _whole(tmp_path, _run(tmp_path, cluster.address, disturb))


def test_a_network_that_is_away(cluster: Cluster, tmp_path: Path, noticed: threading.Event) -> None:
    """Connections break and none can be made, until the run has noticed."""
    link = Link(cluster.port)

    def disturb(recorder: Recorder) -> None:
        link.cut()
        wait_for(noticed.is_set, "the run to notice")
        link.mend()

    _whole(tmp_path, _run(tmp_path, link.address, disturb))
    link.cut()


def test_a_scheduler_that_stands_still(cluster: Cluster, tmp_path: Path, noticed: threading.Event) -> None:
    """Its connections stay open, and nothing comes through them."""

    def disturb(recorder: Recorder) -> None:
        stop(cluster.scheduler)
        wait_for(noticed.is_set, "the run to notice")
        go_on(cluster.scheduler)

    _whole(tmp_path, _run(tmp_path, cluster.address, disturb))


@pytest.mark.parametrize(
    ("who", "message"),
    [
        (
            "scheduler",
            r"^the Dask scheduler at tcp://127\.0\.0\.1:\d+ has been away for 2 s .*finished results are kept",
        ),
        (
            "worker",
            r"^the Dask scheduler at tcp://127\.0\.0\.1:\d+ has had no worker for 2 s; finished results are kept",
        ),
    ],
)
@pytest.mark.usefixtures("noticed")
def test_what_does_not_come_back_ends_the_run_with_one_message(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, who: str, message: str
) -> None:
    def disturb(recorder: Recorder) -> None:
        monkeypatch.setattr(dask_workers, "PATIENCE", 2.0)
        os.kill((cluster.scheduler if who == "scheduler" else cluster.workers[0]).pid, signal.SIGKILL)

    with pytest.raises(RunError, match=message):
        _run(tmp_path, cluster.address, disturb)
    recorder = Recorder()
    run_tasks(_tasks(tmp_path), Store(tmp_path / "store"), recorder)
    assert [name for kind, name in recorder.events if kind == "reused"] == ["a"]
