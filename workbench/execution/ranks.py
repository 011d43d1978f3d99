"""One task on several MPI processes, ``mpiexec -n N python -m workbench.execution.ranks JOB``, started by the worker.

Every process runs the task function; the first one's folder is the result, what the others write is dropped. Progress
comes back as marked lines on standard output, the end as a file. Verified by tests/end_to_end/test_ranks.py.
"""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from contracts.errors import InputError
from workbench.execution.jobs import Done, Failed, Job, run_job

__all__ = ["die_with_parent", "mpiexec", "run_on_ranks"]

_PROGRESS = "\x1eprogress "
_ANSWER = "answer.json"
_PR_SET_PDEATHSIG = 1


def mpiexec() -> str:
    """Launcher of the MPI that came with this Python's packages, else the one on the path.

    MPICH has one that forks all processes here, and one for many machines, which listens on all their addresses.
    """
    beside = [Path(sys.executable).with_name(name) for name in ("mpiexec.gforker", "mpiexec")]
    found = next((str(one) for one in beside if one.exists()), None) or shutil.which("mpiexec")
    if found is None:
        raise InputError("mpiexec", "none", "is needed for --ranks", "install the package mpich of your MPI library")
    return found


def run_on_ranks(job: Job, report: Callable[[float], None]) -> Done | Failed:
    """Run the job on its number of processes of this machine and wait for it."""
    with tempfile.TemporaryDirectory(prefix="workbench-ranks-") as name:
        folder = Path(name)
        (folder / "job.json").write_text(json.dumps(asdict(job), default=str), encoding="utf-8")
        command = [
            mpiexec(),
            "-n",
            str(job.ranks),
            sys.executable,
            "-m",
            "workbench.execution.ranks",
            str(folder / "job.json"),
        ]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, preexec_fn=die_with_parent) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if line.startswith(_PROGRESS):
                    report(float(line.removeprefix(_PROGRESS)))
                else:
                    sys.stdout.write(line)
        return _answer(folder / _ANSWER, process.returncode)


def _answer(path: Path, status: int) -> Done | Failed:
    if not path.exists():
        return Failed(message=f"the MPI processes ended with status {status} (out of memory? use fewer)")
    values: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return Done(**values) if "dofs" in values else Failed(**values)


def die_with_parent() -> None:
    """Ask Linux to kill this process when its parent dies, so that a killed run leaves no orphan computing."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def main(path: Path) -> None:
    """Run the job as one of the MPI processes; a failure of any process ends them all."""
    die_with_parent()
    from reference_fe.dolfinx_api import COMM

    values = json.loads(path.read_text(encoding="utf-8"))
    values["needs"] = {name: Path(folder) for name, folder in values["needs"].items()}
    values["folder"] = Path(values["folder"])
    values["checkpoint"] = Path(values["checkpoint"]) if values["checkpoint"] else None
    job = Job(**values)
    with tempfile.TemporaryDirectory(prefix="workbench-rank-") as dropped:
        if COMM.rank > 0:
            job = replace(job, folder=Path(dropped))
        answer = run_job(job, _tell if COMM.rank == 0 else lambda fraction: None)
    if COMM.rank == 0 or isinstance(answer, Failed):
        fresh = path.with_name(f"answer-{os.getpid()}")
        fresh.write_text(json.dumps(asdict(answer)), encoding="utf-8")
        fresh.replace(path.with_name(_ANSWER))
    if isinstance(answer, Failed):
        COMM.Abort(2)


def _tell(fraction: float) -> None:
    print(f"{_PROGRESS}{fraction!r}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
