"""Tiny tasks for the runner's tests: they leave a mark outside the store each time they run."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from workbench.execution.task import Progress


def add(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Sum of its input and of the tasks it needs."""
    with Path(inputs["log"]).open("a", encoding="utf-8") as log:
        log.write(f"{inputs['name']}\n")
    progress(0.5)
    total = inputs["value"] + sum(float((p / "sum.txt").read_text(encoding="utf-8")) for p in needs.values())
    (out / "sum.txt").write_text(repr(total), encoding="utf-8")
    return 3


def refuse(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Raise one of our errors."""
    raise InputError("load", "-1 N", "must be > 0", "press harder")


def crash(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Raise an error nobody foresaw, after printing."""
    print("chatter of a solver")
    raise ZeroDivisionError("by zero")


def die(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Kill the worker, as the system does when memory runs out."""
    (out / "torn.txt").write_text("half", encoding="utf-8")
    os.kill(os.getpid(), signal.SIGKILL)
    return 0


def allocate(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Ask for memory until there is none."""
    with Path(inputs["log"]).open("a", encoding="utf-8") as log:
        log.write(f"{inputs['name']}\n")
    held = []
    while True:
        held.append(bytearray(b"x") * 50_000_000)


def dying_steps(
    inputs: Mapping[str, Any],
    needs: Mapping[str, Path],
    out: Path,
    progress: Progress,
    checkpoint: Path | None = None,
) -> int:
    """Three steps, kept in the checkpoint; the worker is killed after each step but the last."""
    kept = checkpoint is not None and checkpoint.exists()
    done = int(checkpoint.read_text(encoding="utf-8")) if checkpoint and kept else 0
    with Path(inputs["log"]).open("a", encoding="utf-8") as log:
        log.write(f"{done}\n")
    if checkpoint is not None:
        checkpoint.write_text(str(done + 1), encoding="utf-8")
    if done < 2:
        os.kill(os.getpid(), signal.SIGKILL)
    (out / "steps.txt").write_text(str(done + 1), encoding="utf-8")
    return 0


def threads(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Write what the worker may use."""
    (out / "threads.txt").write_text(os.environ["OMP_NUM_THREADS"], encoding="utf-8")
    return 0


def wait(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Take longer than any test lets it."""
    Path(inputs["pid"]).write_text(str(os.getpid()), encoding="utf-8")
    time.sleep(120.0)
    return 0


def gated(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Note that it began, wait until the gate opens, and write the sum as `add` does."""
    with Path(inputs["log"]).open("a", encoding="utf-8") as log:
        log.write(f"{inputs['name']}\n")
    while not Path(inputs["gate"]).exists():
        time.sleep(0.02)
    (out / "sum.txt").write_text(repr(inputs["value"]), encoding="utf-8")
    return 1


def count_ranks(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Write which of how many MPI processes this is; as many unknowns as processes."""
    from reference_fe.dolfinx_api import COMM

    with Path(inputs["log"]).open("a", encoding="utf-8") as log:
        log.write(f"{COMM.rank}\n")
    (out / "rank.txt").write_text(f"{COMM.rank} of {COMM.size}", encoding="utf-8")
    progress(0.5)
    return int(COMM.size)
