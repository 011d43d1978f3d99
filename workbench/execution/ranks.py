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
from workbench.execution.disk import where_full
from workbench.execution.jobs import Done, Failed, Job, Lost, ended_by_full_disk, run_job
from workbench.execution.memory import KillCount, limit_text

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


def run_on_ranks(job: Job, report: Callable[[float], None]) -> Done | Failed | Lost:
    """Run the job on its number of processes of this machine and wait for it; a full disk under it is named."""
    try:
        return _run(job, report)
    except OSError as error:
        return ended_by_full_disk(error, job.places)


def _run(job: Job, report: Callable[[float], None]) -> Done | Failed | Lost:
    killed = KillCount()
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
        if (folder / _ANSWER).exists():
            values: dict[str, Any] = json.loads((folder / _ANSWER).read_text(encoding="utf-8"))
            kind = Done if "dofs" in values else Lost if "how" in values else Failed
            return kind(**values)
    if killed.one_more():
        how = f"the kernel killed one of {job.ranks} MPI processes because memory ran out, of {limit_text()}"
        return Lost(how=how, memory=True)
    if room := where_full(job.places):
        return Failed(message=room, disk_full=True)
    return Lost(how=f"its MPI processes ended with status {process.returncode}")


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
    values |= {name: Path(values[name]) if values[name] else None for name in ("checkpoint", "store")}
    job = Job(**values)
    with tempfile.TemporaryDirectory(prefix="workbench-rank-") as dropped:
        if COMM.rank > 0:
            job = replace(job, folder=Path(dropped))
        answer = run_job(job, _tell if COMM.rank == 0 else lambda fraction: None)
    if COMM.rank == 0 or not isinstance(answer, Done):
        fresh = path.with_name(f"answer-{os.getpid()}")
        fresh.write_text(json.dumps(asdict(answer)), encoding="utf-8")
        fresh.replace(path.with_name(_ANSWER))
    if not isinstance(answer, Done):
        COMM.Abort(2)


def _tell(fraction: float) -> None:
    print(f"{_PROGRESS}{fraction!r}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
