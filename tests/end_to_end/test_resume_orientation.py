"""A run killed in the middle of an orientation goes on behind its last increment and writes the same bytes."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest

from contracts.kept_arrays import read_kept, write_kept
from tests.end_to_end.small_study import command, environment, run, small_study_text

DEADLINE = 500.0
"""Only to end what hangs [s]: more than ten times what it takes on an idle machine."""
MARK_S = 1e6
"""Seconds added to the time in the checkpoint: a run that takes it up shows them, one that starts anew does not."""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The small study with six points on its curve."""
    text, count = re.subn(r"points = 2", "points = 6", small_study_text(), count=1)
    assert count == 1
    path = tmp_path_factory.mktemp("study") / "study.toml"
    path.write_text(text, encoding="utf-8")
    return path


def _stiffness(study: Path, folder: Path) -> tuple[str | Path, ...]:
    return ("stiffness", study, "--out", folder / "out", "--store", folder / "store", "--workers", "1")


@pytest.fixture(scope="module")
def killed(study: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run that was killed once an increment was kept."""
    folder = tmp_path_factory.mktemp("killed")
    process = subprocess.Popen(
        command(*_stiffness(study, folder)),
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    start = time.monotonic()
    while not _kept(folder):
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait(10.0)
    return folder


@pytest.mark.long
def test_it_goes_on_behind_its_last_increment(study: Path, killed: Path, tmp_path: Path) -> None:
    (checkpoint,) = _kept(killed)
    kept = read_kept(checkpoint)
    assert kept is not None
    kept["recorded/wall_s"] = kept["recorded/wall_s"] + MARK_S
    write_kept(checkpoint, kept)
    assert run(*_stiffness(study, killed)).returncode == 0
    assert run(*_stiffness(study, tmp_path)).returncode == 0
    name = "curves/fe_phi000.csv"
    assert (killed / "out" / name).read_bytes() == (tmp_path / "out" / name).read_bytes()
    assert _solve_time(killed) > MARK_S > _solve_time(tmp_path)
    assert list((killed / "store" / "checkpoints").iterdir()) == []


def _kept(folder: Path) -> list[Path]:
    """Checkpoints of a store; files that begin with a dot are still being written."""
    return [path for path in (folder / "store").glob("checkpoints/*.npz") if not path.name.startswith(".")]


def _solve_time(folder: Path) -> float:
    """Time that the result in the store says the solve took [s]."""
    results = [json.loads(path.read_text(encoding="utf-8")) for path in (folder / "store").glob("??/*/result.json")]
    (seconds,) = (numbers["solve_s"] for numbers in results if "solve_s" in numbers)
    return float(seconds)
