"""What one code made of one case, and how it was measured."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

__all__ = ["Measured", "Outcome", "measured", "python_run"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """One code's run through one case.

    Attributes
    ----------
    unknowns : displacement unknowns
    increments : converged increments
    iterations : linear solves in all, those of increments that were given up included
    cpu_s : processor time of the whole run, set-up included [s]
    wall_s : wall time of the whole run [s]; says less than ``cpu_s`` when something else runs beside it
    memory_MB : largest resident set of the process [MB]
    force_N : force of the driven line at full travel, on the whole body [N]
    libraries_MB : the part of the memory that Python, its libraries and compiled loops take, where it is known [MB]
    """

    unknowns: int
    increments: int
    iterations: int
    cpu_s: float
    wall_s: float
    memory_MB: float
    force_N: float
    libraries_MB: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """Resources of a finished process, and what it printed."""

    cpu_s: float
    wall_s: float
    memory_MB: float
    output: str


def measured(command: Sequence[str], folder: Path, threads: int, limit_s: float) -> Measured:
    """Run a command, its output in ``folder``/log, and read its resources from the kernel.

    Raises
    ------
    subprocess.SubprocessError
        When it fails or takes more than ``limit_s`` of processor time.
    """
    environment = dict(os.environ) | {"OMP_NUM_THREADS": str(threads), "MKL_NUM_THREADS": str(threads)}
    environment["PYTHONPATH"] = str(Path(__file__).resolve().parents[2])
    command = ["bash", "-c", f'ulimit -t {int(limit_s)}; exec "$@"', "bash", *command]
    log = folder / "log"
    started = time.perf_counter()
    with log.open("w") as file:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=file, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    text = log.read_text(errors="replace")
    if process.returncode:
        raise subprocess.SubprocessError(f"{command[4]}: exit {process.returncode}, last lines:\n{text[-600:]}")
    return Measured(
        cpu_s=usage.ru_utime + usage.ru_stime,
        wall_s=time.perf_counter() - started,
        memory_MB=usage.ru_maxrss / 1024.0,
        output=text,
    )


def python_run(module: str, arguments: Mapping[str, Any], folder: Path, threads: int, limit_s: float) -> Outcome:
    """Run a module of this package in a process of its own; its last line is a JSON object with the missing numbers.

    It measures its own times, so that imports and meshing are left out.
    """
    command = [sys.executable, "-m", f"benchmarks.peer_codes.{module}", json.dumps(arguments)]
    run = measured(command, folder, threads, limit_s)
    numbers = json.loads(run.output.strip().splitlines()[-1])
    return Outcome(**numbers, memory_MB=run.memory_MB)
