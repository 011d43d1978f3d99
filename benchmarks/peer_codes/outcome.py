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


_LAUNCHER = """
import resource, subprocess, sys
resource.setrlimit(resource.RLIMIT_CPU, 2 * (int(sys.argv[2]),))
code = subprocess.call(sys.argv[3:])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
with open(sys.argv[1], "w") as file:
    file.write(f"{used.ru_utime + used.ru_stime} {used.ru_maxrss}")
sys.exit(code if code >= 0 else 128 - code)
"""
"""Starts the command from a small process: Linux counts what its parent held at that moment as its own peak."""


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
    log, usage = folder / "log", folder / "usage"
    launched = [sys.executable, "-I", "-S", "-c", _LAUNCHER, str(usage), str(int(limit_s)), *command]
    started = time.perf_counter()
    with log.open("w") as file:
        code = subprocess.call(launched, cwd=folder, env=environment, stdout=file, stderr=subprocess.STDOUT)
    text = log.read_text(errors="replace")
    if code:
        raise subprocess.SubprocessError(f"{command[0]}: exit {code}, last lines:\n{text[-600:]}")
    cpu_s, kilobytes = map(float, usage.read_text().split())
    return Measured(
        cpu_s=cpu_s,
        wall_s=time.perf_counter() - started,
        memory_MB=kilobytes / 1024.0,
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
