"""One wheel on one MPI process and on two: time for each Newton iteration, and for each increment of the curve.

``make bench NAME=fe_ranks`` prints the table and writes ``build/bench/fe_ranks.json``; "ours" is two processes, "peer"
one, both measured in turn, several times, the shortest kept. The first increment (compilation, first factorisation) is
left out. Timings mean something on a machine with two idle cores only: the load at the start is in the table. The
work of the busiest process, as MUMPS counts it, does not depend on that; its CPU time includes waiting for the other.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run, add_option  # noqa: E402

ANSWERS = ROOT / "build" / "bench"
DEFLECTIONS = (0.002, 0.005, 0.010, 0.015)
SIZES = {"medium": (7e-3, 15e-3), "large": (4e-3, 10e-3)}
"""Element size along strips and along the axle [m]."""


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", choices=SIZES, default="medium")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    add_option(parser)
    options = parser.parse_args()
    if options.child:
        solve(options.size, options.child)
        return
    load = os.getloadavg()[0]
    run = Run("fe_ranks")
    runs: dict[int, list[dict[str, float]]] = {1: [], 2: []}
    for _ in range(options.repeats):
        for ranks, found in runs.items():
            found.append(measured(options.size, ranks))
    one, two = ({name: min(run[name] for run in found) for name in found[0]} for found in runs.values())
    rows = [row(f"wheel, {one['dofs']:.0f} unknowns", name, unit, two[key], one[key]) for key, name, unit in METRICS]
    rows.append(row("machine", "load average at the start", "-", load, None))
    rows.append(row("machine", "cores", "-", float(os.cpu_count() or 1), None))
    written = run.write(rows, keep=options.record)
    print(f"{'case':<24}{'metric':<44}{'two':>10}{'one':>10}{'ratio':>8}")
    for r in rows:
        shown = [f"{r[k]:.3g}" if r[k] is not None else "" for k in ("ours", "peer", "ratio")]
        print(f"{r['case']:<24}{r['metric'] + ' [' + r['unit'] + ']':<44}{shown[0]:>10}{shown[1]:>10}{shown[2]:>8}")
    for path in written:
        print(f"written: {path}")


METRICS = (
    ("iteration_s", "wall time of a Newton iteration", "s"),
    ("cpu_s", "CPU time of an iteration, busiest process", "s"),
    ("increment_s", "wall time of an increment, all records", "s"),
    ("flops", "factorisation work of the busiest process", "flop"),
    ("cells", "cells of the busiest process", "-"),
    ("memory_mb", "peak memory of all processes", "MB"),
)


def row(case: str, metric: str, unit: str, ours: float, peer: float | None) -> dict[str, object]:
    """One line of the table; the ratio is above one where two processes do better."""
    return {"case": case, "metric": metric, "unit": unit, "ours": ours, "peer": peer, "ratio": peer and peer / ours}


def measured(size: str, ranks: int) -> dict[str, float]:
    """Numbers of one run in processes of its own."""
    from workbench.execution.ranks import mpiexec

    answer = ANSWERS / f"fe_ranks_{ranks}.tmp"
    answer.parent.mkdir(parents=True, exist_ok=True)
    own = [sys.executable, __file__, "--size", size, "--child", str(answer)]
    launcher = [] if ranks == 1 else [mpiexec(), "-n", str(ranks)]
    subprocess.run([*launcher, *own], check=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
    numbers: dict[str, float] = json.loads(answer.read_text(encoding="utf-8"))
    answer.unlink()
    return numbers


def solve(size: str, answer: Path) -> None:
    """Solve the wheel, as one of the processes; the first one writes the numbers."""
    from contracts.materials import TI_6AL_4V
    from geometry.build import build_mesh
    from geometry.wheel import exomars_hoops
    from reference_fe.dolfinx_api import COMM, MPI
    from reference_fe.problem.domain import Domain
    from reference_fe.solver.newton import NewtonSolver
    from reference_fe.wheel.pressed import WheelLoadCase, solve_wheel

    element_size, axial_size = SIZES[size]
    mesh = build_mesh(
        exomars_hoops(), element_size=element_size, axial_size=axial_size, parts="flexible", half_width=True
    )
    spent: list[tuple[float, int, float, float]] = []
    NewtonSolver.solve = timed(NewtonSolver.solve, spent)  # type: ignore[method-assign]
    stamps: list[float] = []

    def note(deflection: float, load: float) -> None:
        stamps.append(time.perf_counter())

    case = WheelLoadCase(orientation_deg=15.0, deflections=DEFLECTIONS)
    result = solve_wheel(mesh, dict.fromkeys(mesh.parts, TI_6AL_4V), case, note)
    memory = COMM.allreduce(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0)
    later = spent[1:]
    numbers = {
        "dofs": float(result.dofs),
        "iteration_s": sum(s[0] for s in later) / sum(s[1] for s in later),
        "cpu_s": COMM.allreduce(sum(s[3] for s in later) / sum(s[1] for s in later), op=MPI.MAX),
        "increment_s": (stamps[-1] - stamps[0]) / (len(stamps) - 1),
        "flops": COMM.allreduce(later[-1][2], op=MPI.MAX),
        "cells": float(COMM.allreduce(Domain.from_tagged(mesh).mesh.topology.index_map(3).size_local, op=MPI.MAX)),
        "memory_mb": memory,
    }
    if COMM.rank == 0:
        answer.write_text(json.dumps(numbers), encoding="utf-8")


def timed(call: Callable, spent: list[tuple[float, int, float, float]]) -> Callable:
    """The Newton solve; seconds, iterations, this process' flop of one factorisation and CPU seconds are noted."""

    def run(self: Any, rise: float = 0.0) -> Any:
        start, cpu = time.perf_counter(), time.process_time()
        outcome = call(self, rise)
        wall, cpu = time.perf_counter() - start, time.process_time() - cpu
        flop = self._direct.factors.getMumpsRinfo(3)
        spent.append((wall, outcome.iterations, flop, cpu))
        return outcome

    return run


if __name__ == "__main__":
    main()
