"""A run killed half-way (SIGKILL) and started again: same numbers, nothing finished is computed twice."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from contracts.curves import read_curve
from tests.end_to_end.small_study import command, environment, run

DEADLINE = 500.0
"""Only to end what hangs [s]: more than ten times what it takes on an idle machine."""


def _manifests(store: Path) -> dict[str, int]:
    """Time of each stored result, by folder."""
    return {p.parent.name: p.stat().st_mtime_ns for p in store.glob("??/*/manifest.json")}


def _children(pid: int) -> list[int]:
    text = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    return [int(child) for child in text.split()]


def _alive(pid: int) -> bool:
    status = Path(f"/proc/{pid}/stat")
    return status.exists() and status.read_text(encoding="ascii").rpartition(")")[2].split()[0] != "Z"


@pytest.fixture(scope="module")
def killed(
    tmp_path_factory: pytest.TempPathFactory, workspace: Path, first_report: subprocess.CompletedProcess[str]
) -> tuple[Path, dict[str, int]]:
    """Store of a run that was killed once five results were finished, and their times.

    It begins with what the first report computed, but for the continuum's and the section model's runs.
    """
    assert first_report.returncode == 0, first_report.stderr
    folder = tmp_path_factory.mktemp("killed")
    shutil.copytree(workspace / "store", folder / "store")
    summary = json.loads((workspace / "report" / "summary.json").read_text(encoding="utf-8"))
    for task, key in summary["provenance"]["tasks"].items():
        if task.startswith(("fe_", "section_", "words_")):
            shutil.rmtree(folder / "store" / key[:2] / key, ignore_errors=True)
    kept = len(_manifests(folder / "store"))
    arguments = command("report", workspace / "study.toml", "--out", folder / "report", "--store", folder / "store")
    process = subprocess.Popen(arguments, env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    start = time.monotonic()
    while len(_manifests(folder / "store")) < kept + 5:
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.02)
    workers = _children(process.pid)
    os.kill(process.pid, signal.SIGKILL)
    process.wait(10.0)
    while any(_alive(pid) for pid in workers):
        assert time.monotonic() - start < DEADLINE, "a worker outlived the killed run"
        time.sleep(0.05)
    return folder, _manifests(folder / "store")


def test_a_killed_run_leaves_no_report(killed: tuple[Path, dict[str, int]]) -> None:
    assert not (killed[0] / "report").exists()


@pytest.mark.long
def test_started_again_it_finishes_with_the_same_numbers(
    killed: tuple[Path, dict[str, int]], workspace: Path, first_report: subprocess.CompletedProcess[str]
) -> None:
    folder, before = killed
    again = run("report", workspace / "study.toml", "--out", folder / "report", "--store", folder / "store")
    assert again.returncode == first_report.returncode == 0, again.stderr
    reused = set(re.findall(r"\] (\S+): reused", again.stdout))
    computed = set(re.findall(r"\] (\S+): computed", again.stdout))
    summary = json.loads((folder / "report" / "summary.json").read_text(encoding="utf-8"))
    assert len(reused) == len(before.keys() & set(summary["provenance"]["tasks"].values()))
    assert computed
    assert not reused & computed
    after = _manifests(folder / "store")
    assert {key: after[key] for key in before} == before
    assert list((folder / "store" / "tmp").iterdir()) == []
    for path in (workspace / "report" / "curves").iterdir():
        one, two = read_curve(path), read_curve(folder / "report" / "curves" / path.name)
        assert one.deflection == pytest.approx(two.deflection, rel=1e-12, abs=0.0)
        assert one.load == pytest.approx(two.load, rel=1e-9, abs=1e-12)


def test_ctrl_c_is_one_message_and_exit_status_2(workspace: Path, tmp_path: Path) -> None:
    """The terminal sends SIGINT to the whole process group; only the parent may speak."""
    arguments = command("report", workspace / "study.toml", "--out", tmp_path / "report", "--store", tmp_path / "store")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job would hand down "ignore"
    try:
        process = subprocess.Popen(
            arguments,
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
    finally:
        signal.signal(signal.SIGINT, before)
    start = time.monotonic()
    while not _manifests(tmp_path / "store"):
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)
    _, message = process.communicate(timeout=DEADLINE)
    assert process.returncode == 2
    assert message == "workbench: error: interrupted; finished results are kept, start again to go on\n"
    assert _manifests(tmp_path / "store")
    assert not (tmp_path / "report").exists()
