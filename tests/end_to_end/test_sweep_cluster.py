"""A sweep over a real Dask scheduler and two workers on loopback, one of which is killed on the way."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.end_to_end.small_study import ROOT, command, environment

DEADLINE = 500.0
"""Only to end what hangs [s]: more than ten times what it takes on an idle machine."""
TASKS = 9


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Address of a scheduler and its two worker processes, started from the command line as a user would."""
    here = tmp_path / "scheduler.json"
    scheduler = (
        "dask_scheduler",
        "--host",
        "127.0.0.1",
        "--port",
        "0",
        "--dashboard-address",
        "127.0.0.1:0",
        "--scheduler-file",
        here,
    )
    worker = (
        "dask_worker",
        "--scheduler-file",
        here,
        "--nthreads",
        "1",
        "--host",
        "127.0.0.1",
        "--no-nanny",
        "--dashboard-address",
        "127.0.0.1:0",
    )
    processes = [_distributed(tmp_path, *scheduler)]
    try:
        _wait_for(lambda: here.is_file() and here.stat().st_size > 0)
        processes += [_distributed(tmp_path, *worker) for _ in range(2)]
        yield str(json.loads(here.read_text(encoding="utf-8"))["address"]), processes[1:]
    finally:
        for process in processes:
            process.kill()
            process.wait(10.0)


def _distributed(folder: Path, name: str, *arguments: str | Path) -> subprocess.Popen[bytes]:
    line = [sys.executable, "-m", f"distributed.cli.{name}", *map(str, arguments)]
    with (folder / "cluster.log").open("ab") as log:
        return subprocess.Popen(line, cwd=folder, env=environment(), stdout=log, stderr=log)


def _wait_for(condition: object) -> None:
    start = time.monotonic()
    assert callable(condition)
    while not condition():
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.02)


@pytest.mark.long
def test_a_sweep_ends_with_every_point_though_a_worker_is_killed(
    cluster: tuple[str, list[subprocess.Popen[bytes]]], tmp_path: Path
) -> None:
    """The worker is killed once two of nine results are in; the other one computes the rest."""
    address, workers = cluster
    text = (ROOT / "studies" / "strip_sweep.toml").read_text(encoding="utf-8")
    old = 'strip_thickness = ["0.55 mm", "0.609 mm", "0.65 mm"]\norientation = ["0 deg", "30 deg"]'
    assert old in text
    values = ", ".join(f'"0.{55 + i} mm"' for i in range(TASKS))
    (tmp_path / "study.toml").write_text(
        text.replace(old, f'strip_thickness = [{values}]\norientation = ["0 deg"]\n').replace(
            "base = true", "base = false"
        ),
        encoding="utf-8",
    )
    arguments = command("sweep", "study.toml", "--out", "out", "--store", "store", "--scheduler", address)
    with (tmp_path / "said").open("wb") as said:
        sweep = subprocess.Popen(arguments, cwd=tmp_path, env=environment(), stdout=said, stderr=said)
    try:
        _wait_for(lambda: len(list((tmp_path / "store").glob("??/*/manifest.json"))) >= 2)
        assert sweep.poll() is None, "the sweep ended before a worker could be killed"
        os.kill(workers[0].pid, signal.SIGKILL)
        workers[0].wait(10.0)
        status = sweep.wait(DEADLINE)
    finally:
        sweep.kill()
    assert status == 0, (tmp_path / "said").read_text(encoding="utf-8")
    with (tmp_path / "out" / "sweep.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["state"] for row in rows] == ["whole"] * TASKS
    tangents = [float(row["initial_tangent_N_per_m"]) for row in rows]
    assert tangents == sorted(tangents)
    assert workers[1].poll() is None
    assert list((tmp_path / "store" / "tmp").iterdir()) == []
