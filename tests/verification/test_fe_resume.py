"""Claim: a solve killed with SIGKILL and started again yields the bytes of a solve that was never stopped.

Source: the project's own requirement. Tolerance: none, on one process every bit of curve and fields is equal. Negative
control: a checkpoint whose displacement is off by a millionth shows in the bytes, so the resumed run does start there.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from contracts.kept_arrays import write_kept
from tests.end_to_end.small_study import ROOT, environment
from tests.verification.wheel_process import DEFLECTIONS

DEADLINE = 500.0
"""Only to end what hangs [s]: more than ten times what it takes on an idle machine."""
INCREMENTS_BEFORE_THE_KILL = 2


def _start(folder: Path) -> subprocess.Popen[bytes]:
    arguments = [sys.executable, "-m", "tests.verification.wheel_process", folder / "curve.npz", folder / "kept.npz"]
    return subprocess.Popen(arguments, cwd=ROOT, env=environment())


def _kept(path: Path) -> dict[str, np.ndarray]:
    if not path.exists():
        return {}
    with np.load(path, allow_pickle=False) as archive:
        return dict(archive)


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run that nobody stopped."""
    folder = tmp_path_factory.mktemp("straight")
    assert _start(folder).wait(DEADLINE) == 0
    return folder


@pytest.fixture(scope="module")
def killed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, np.ndarray]:
    """Checkpoint that a run killed in its third increment left."""
    folder = tmp_path_factory.mktemp("killed")
    process, start = _start(folder), time.monotonic()
    wanted = DEFLECTIONS[INCREMENTS_BEFORE_THE_KILL - 1]
    while _kept(folder / "kept.npz").get("process0/progress", np.zeros(2))[0] < wanted:
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.01)
    time.sleep(0.1)  # well into the next increment
    os.kill(process.pid, signal.SIGKILL)
    assert process.wait(10.0) == -signal.SIGKILL
    assert not (folder / "curve.npz").exists()
    return _kept(folder / "kept.npz")


def _resume(kept: dict[str, np.ndarray], folder: Path) -> bytes:
    write_kept(folder / "kept.npz", kept)
    assert _start(folder).wait(DEADLINE) == 0
    assert not (folder / "kept.npz").exists()
    return (folder / "curve.npz").read_bytes()


def test_the_resumed_curve_is_equal_bit_for_bit(straight: Path, killed: dict[str, np.ndarray], tmp_path: Path) -> None:
    assert killed["process0/progress"][0] < DEFLECTIONS[-1]
    assert _resume(killed, tmp_path) == (straight / "curve.npz").read_bytes()


def test_a_checkpoint_that_is_off_shows(straight: Path, killed: dict[str, np.ndarray], tmp_path: Path) -> None:
    off = killed | {"process0/displacement": killed["process0/displacement"] * (1.0 + 1e-6)}
    assert _resume(off, tmp_path) != (straight / "curve.npz").read_bytes()
