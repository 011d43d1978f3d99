"""The runner: needs before users, nothing twice, failures as one message with finished results kept."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from workbench.execution import runner
from workbench.execution.claims import Claims
from workbench.execution.errors import RunError
from workbench.execution.inventory import results
from workbench.execution.jobs import Done, Job
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Entry, Store
from workbench.execution.task import Task, task_keys

PROBE = "tests.unit.workbench_probe_tasks"


class Recorder:
    """A listener that remembers."""

    def __init__(self) -> None:
        self.events: list[tuple[str, str]] = []

    def damaged(self, name: str, fault: str) -> None:
        self.events.append(("damaged", f"{name}: {fault}"))

    def warned(self, warning: str) -> None:
        self.events.append(("warned", warning))

    def started(self, name: str) -> None:
        self.events.append(("started", name))

    def progressed(self, name: str, fraction: float) -> None:
        assert 0.0 <= fraction <= 1.0
        self.events.append(("progressed", name))

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        self.events.append(("reused" if reused else "computed", name))

    def elsewhere(self, name: str) -> None:
        self.events.append(("elsewhere", name))

    def restarted(self, name: str, reason: str) -> None:
        self.events.append(("restarted", f"{name}: {reason}"))

    def failed(self, name: str, message: str) -> None:
        self.events.append(("failed", name))


def _sum(tmp_path: Path, name: str, value: float, needs: tuple[str, ...] = ()) -> Task:
    inputs = {"name": name, "value": value, "log": str(tmp_path / "log.txt")}
    return Task(name=name, function=f"{PROBE}:add", inputs=inputs, needs=needs)


def _graph(tmp_path: Path, a: float = 1.0) -> list[Task]:
    tasks = [_sum(tmp_path, "a", a), _sum(tmp_path, "b", 10.0), _sum(tmp_path, "c", 100.0, ("a", "b"))]
    return [*tasks, _sum(tmp_path, "d", 1000.0, ("b",))]


def _runs(tmp_path: Path) -> list[str]:
    log = tmp_path / "log.txt"
    return sorted(log.read_text(encoding="utf-8").split()) if log.exists() else []


def test_computes_in_order_and_then_reuses(tmp_path: Path) -> None:
    store, recorder = Store(tmp_path / "store"), Recorder()
    entries = run_tasks(_graph(tmp_path), store, recorder)
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "111.0"
    assert (entries["d"].path / "sum.txt").read_text(encoding="utf-8") == "1010.0"
    assert entries["c"].dofs == 3
    assert ("progressed", "c") in recorder.events
    again = Recorder()
    run_tasks(_graph(tmp_path), store, again)
    assert again.events == [("reused", name) for name in "abcd"]
    assert _runs(tmp_path) == ["a", "b", "c", "d"]


def test_a_changed_input_recomputes_what_depends_on_it_only(tmp_path: Path) -> None:
    store = Store(tmp_path / "store")
    run_tasks(_graph(tmp_path), store, Recorder())
    recorder = Recorder()
    entries = run_tasks(_graph(tmp_path, a=2.0), store, recorder)
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "112.0"
    assert {name for kind, name in recorder.events if kind == "computed"} == {"a", "c"}


def test_a_damaged_result_is_told_and_computed_again(tmp_path: Path) -> None:
    store = Store(tmp_path / "store")
    entries = run_tasks(_graph(tmp_path), store, Recorder())
    (entries["b"].path / "sum.txt").write_text("10.1", encoding="utf-8")
    recorder = Recorder()
    again = run_tasks(_graph(tmp_path), store, recorder)
    told = [text for kind, text in recorder.events if kind == "damaged"]
    assert told == ["b: sum.txt has been changed since it was stored"]
    assert [name for kind, name in recorder.events if kind == "computed"] == ["b"]
    assert (again["b"].path / "sum.txt").read_text(encoding="utf-8") == "10.0"


def _run_graph(folder: Path, start: float) -> None:
    while time.time() < start:
        time.sleep(0.001)
    entries = run_tasks(_graph(folder), Store(folder / "store"), Recorder())
    assert (entries["c"].path / "sum.txt").read_text(encoding="utf-8") == "111.0"


def test_two_processes_at_once_on_one_store_each_have_every_result_whole(tmp_path: Path) -> None:
    """Two runs of the same graph with workers of their own, started together: nothing torn, nothing done twice."""
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_run_graph, args=(tmp_path, time.time() + 2.0)) for _ in range(2)]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
    assert [process.exitcode for process in processes] == [0, 0]
    store, keys = Store(tmp_path / "store"), task_keys(tuple(_graph(tmp_path)))
    assert {one.name: one.fault for one in results(store, check=True)} == dict.fromkeys(keys.values(), "")
    assert _runs(tmp_path) == ["a", "b", "c", "d"]
    assert list((store.root / "tmp").iterdir()) == []


def _claim(folder: Path, pipe: Connection) -> None:
    claims = Claims(folder)
    pipe.send(claims.take("key"))
    pipe.recv()


def test_a_claim_ends_with_the_process_that_holds_it(tmp_path: Path) -> None:
    ours, theirs = multiprocessing.get_context("spawn").Pipe()
    process = multiprocessing.get_context("spawn").Process(target=_claim, args=(tmp_path, theirs), daemon=True)
    process.start()
    assert ours.recv() is True
    claims = Claims(tmp_path)
    assert claims.take("key") is False
    assert claims.take("another") is True
    process.kill()
    process.join()
    assert claims.take("key") is True
    claims.give_back_all()
    assert list((tmp_path / "claims").iterdir()) == []


def test_what_another_run_computes_is_told_waited_for_and_taken_over_if_it_fails(tmp_path: Path) -> None:
    """Another run holds the claims of two tasks; it brings the result of one and gives the other back unfinished."""
    store, recorder = Store(tmp_path / "store"), Recorder()
    tasks = [_sum(tmp_path, "a", 1.0), _sum(tmp_path, "b", 10.0)]
    keys = task_keys(tuple(tasks))
    other = Claims(store.root)
    assert other.take(keys["a"])
    assert other.take(keys["b"])

    def end() -> None:
        while ("elsewhere", "b") not in recorder.events:
            time.sleep(0.02)
        folder = store.scratch()
        (folder / "sum.txt").write_text("1.0", encoding="utf-8")
        store.put(keys["a"], folder, {"wall_s": 1.0})
        other.give_back_all()

    thread = threading.Thread(target=end)
    thread.start()
    run_tasks(tasks, store, recorder)
    thread.join()
    assert _runs(tmp_path) == ["b"]
    assert {("elsewhere", "a"), ("elsewhere", "b"), ("reused", "a"), ("computed", "b")} <= set(recorder.events)


def test_two_tasks_with_one_key_are_computed_once(tmp_path: Path) -> None:
    task = _sum(tmp_path, "a", 1.0)
    recorder = Recorder()
    run_tasks([task, replace(task, name="same")], Store(tmp_path / "store"), recorder)
    assert _runs(tmp_path) == ["a"]
    assert not [event for event in recorder.events if event[0] == "elsewhere"]


def test_what_stands_before_a_slash_is_no_part_of_a_key(tmp_path: Path) -> None:
    """In a graph of several studies a task keeps the key it has in its own; its function sees the bare names."""
    plain, scoped = (
        _graph(tmp_path),
        [
            replace(task, name=f"p1/{task.name}", needs=tuple(f"p1/{need}" for need in task.needs))
            for task in _graph(tmp_path)
        ],
    )
    keys = task_keys(tuple(plain))
    assert task_keys(tuple(scoped)) == {f"p1/{name}": key for name, key in keys.items()}
    entries = run_tasks(scoped, Store(tmp_path / "store"), Recorder())
    assert entries["p1/c"].manifest["task"] == "c"
    assert entries["p1/c"].manifest["needs"] == {"a": keys["a"], "b": keys["b"]}


@pytest.mark.parametrize(
    ("function", "message"),
    [
        ("refuse", r"task bad failed: load = -1 N: must be > 0; press harder"),
        ("crash", r"task bad failed: unexpected ZeroDivisionError: by zero; the traceback is in .*\.log"),
        (
            "die",
            r"worker of task bad ended with signal 9 \(SIGKILL\) from outside.*, 3 times; finished results are kept",
        ),
    ],
)
def test_a_failure_is_one_message_and_keeps_finished_results(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], function: str, message: str
) -> None:
    store = Store(tmp_path / "store")
    good = _sum(tmp_path, "a", 1.0)
    bad = Task(name="bad", function=f"{PROBE}:{function}", inputs={}, needs=("a",))
    with pytest.raises(RunError, match=message):
        run_tasks([good, bad], store, Recorder())
    assert store.get(task_keys((good,))["a"]) is not None
    assert list((store.root / "tmp").iterdir()) == []
    assert capfd.readouterr() == ("", "")
    if function == "crash":
        log = next((store.root / "log").iterdir()).read_text(encoding="utf-8")
        assert "chatter of a solver" in log
        assert "ZeroDivisionError" in log


def test_a_failure_stops_only_what_needs_it(tmp_path: Path) -> None:
    """Three tasks fail, one waits for a failed one in vain, the others finish; what two say alike is told once."""
    bad = [Task(name=n, function=f"{PROBE}:refuse", inputs={}, cost=9.0) for n in ("bad", "worse")]
    bad.append(Task(name="broken", function=f"{PROBE}:crash", inputs={}, cost=9.0))
    tasks = [*bad, _sum(tmp_path, "a", 1.0), _sum(tmp_path, "b", 1.0, ("bad",)), _sum(tmp_path, "c", 2.0, ("a",))]
    recorder = Recorder()
    with pytest.raises(RunError, match=r"tasks (bad, worse|worse, bad) failed: load = -1 N: ") as caught:
        run_tasks(tasks, Store(tmp_path / "store"), recorder, Computing(workers=1))
    assert "task broken failed: unexpected ZeroDivisionError" in str(caught.value)
    assert str(caught.value).count("press harder") == 1
    assert [name for kind, name in recorder.events if kind == "computed"] == ["a", "c"]
    assert {name for kind, name in recorder.events if kind == "failed"} == {"bad", "worse", "broken"}
    assert _runs(tmp_path) == ["a", "c"]


def test_a_task_whose_worker_is_killed_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    """The worker dies after each of the first two steps of three; no step is done twice, no other task is disturbed."""
    steps = Task(name="steps", function=f"{PROBE}:dying_steps", inputs={"log": str(tmp_path / "steps")}, resumable=True)
    store, recorder = Store(tmp_path / "store"), Recorder()
    entries = run_tasks([steps, *_graph(tmp_path)], store, recorder)
    assert (tmp_path / "steps").read_text(encoding="utf-8").split() == ["0", "1", "2"]
    assert (entries["steps"].path / "steps.txt").read_text(encoding="utf-8") == "3"
    assert _runs(tmp_path) == ["a", "b", "c", "d"]
    restarts = [text for kind, text in recorder.events if kind == "restarted"]
    assert restarts == ["steps: its worker ended with signal 9 (SIGKILL) from outside, not for want of memory"] * 2
    assert list((store.root / "checkpoints").iterdir()) == []
    assert list((store.root / "tmp").iterdir()) == []


def test_without_a_checkpoint_a_restarted_task_begins_anew(tmp_path: Path) -> None:
    """Negative control: the same task, not marked resumable, does its first step each time and gives up."""
    steps = Task(name="steps", function=f"{PROBE}:dying_steps", inputs={"log": str(tmp_path / "steps")})
    with pytest.raises(RunError, match="3 times"):
        run_tasks([steps], Store(tmp_path / "store"), Recorder())
    assert (tmp_path / "steps").read_text(encoding="utf-8").split() == ["0", "0", "0"]


def test_workers_have_one_thread_and_the_parent_keeps_its_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    task = Task(name="t", function=f"{PROBE}:threads", inputs={})
    entry = run_tasks([task], Store(tmp_path), Recorder())["t"]
    assert (entry.path / "threads.txt").read_text(encoding="utf-8") == "1"
    assert os.environ["OMP_NUM_THREADS"] == "3"


@pytest.fixture
def interruptible() -> Iterator[None]:
    """SIGINT raises KeyboardInterrupt, also where the tests run as a background job that ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_interrupt_is_one_message_and_ends_the_workers(tmp_path: Path) -> None:
    pid_file = tmp_path / "pid"
    task = Task(name="t", function=f"{PROBE}:wait", inputs={"pid": str(pid_file)})

    def interrupt() -> None:
        while not (pid_file.exists() and pid_file.read_text(encoding="utf-8")):
            time.sleep(0.02)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(RunError, match="interrupted; finished results are kept"):
        run_tasks([task], Store(tmp_path / "store"), Recorder())
    thread.join()
    assert not Path(f"/proc/{pid_file.read_text(encoding='utf-8')}").exists()


class _OneByOne:
    """Two workers that finish what was started first, and remember what ran beside what."""

    log = Path("log")

    def __init__(self) -> None:
        self.jobs: list[str] = []
        self.beside: list[set[str]] = []

    @property
    def free(self) -> int:
        return 2 - len(self.jobs)

    def start(self, job: Job) -> None:
        self.jobs.append(job.name)
        self.beside.append(set(self.jobs))

    def wait(self) -> list[tuple[str, Done]]:
        return [(self.jobs.pop(0), Done(dofs=0, wall_s=0.0))]

    def stop(self) -> None:
        return None


def test_two_workers_compile_different_things_while_there_are_any(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workers = _OneByOne()
    monkeypatch.setattr(runner, "_workers", lambda *given: workers)
    forms, kernels = "workbench.questions.fe.task:solve", "workbench.questions.multibody.task:solve"
    tasks = [Task(name=f"form_{i}", function=forms, inputs={"i": i}, cost=9.0) for i in range(3)]
    tasks += [Task(name=f"kernel_{i}", function=kernels, inputs={"i": i}, cost=1.0) for i in range(3)]
    run_tasks(tasks, Store(tmp_path), Recorder())
    assert [len({name[0] for name in both}) for both in workers.beside] == [1, 2, 2, 2, 2, 2]
