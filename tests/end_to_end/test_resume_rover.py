"""A rover on ANCF tires killed in the middle of its scenario goes on from its checkpoint and writes the same bytes."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from tests.end_to_end.small_study import command, environment, run

DEADLINE = 500.0
"""Only to end what hangs [s]: more than ten times what it takes on an idle machine."""


def _static(folder: Path) -> tuple[str | Path, ...]:
    return ("rover", "static", "--tire", "ancf", "--out", folder / "out", "--store", folder / "store")


def _kept(folder: Path) -> list[Path]:
    """Checkpoints of a store; files that begin with a dot are still being written."""
    return [path for path in (folder / "store").glob("checkpoints/*.npz") if not path.name.startswith(".")]


@pytest.mark.long
def test_it_goes_on_and_writes_the_same_bytes(tmp_path: Path) -> None:
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    process = subprocess.Popen(
        command(*_static(killed)), env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    start = time.monotonic()
    while not _kept(killed):
        assert process.poll() is None, "the run ended before it could be killed"
        assert time.monotonic() - start < DEADLINE
        time.sleep(0.005)
    os.kill(process.pid, signal.SIGKILL)
    process.wait(10.0)
    assert not (killed / "out" / "series" / "static_ancf.csv").exists()
    (checkpoint,) = _kept(killed)
    with np.load(checkpoint, allow_pickle=False) as archive:
        assert float(archive["clock"][0]) >= 0.0  # the settling is over
    assert run(*_static(killed)).returncode == 0
    assert run(*_static(whole)).returncode == 0
    name = "out/series/static_ancf.csv"
    assert (killed / name).read_bytes() == (whole / name).read_bytes()
    assert _kept(killed) == []
