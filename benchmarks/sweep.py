"""What the runner costs for each task, and what a second process is worth in a sweep of the section model.

``make bench NAME=sweep`` prints the table and writes ``build/bench/sweep.json``; "ours" is two processes, "peer" one,
both in the same run, in turn, the shorter of two. Plain loops say what a second process is worth on this machine at
best: two where two cores are idle, less on two threads of one core; the load at the start is in the table. The first
task of each worker, which loads libraries, is left out.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run, add_option  # noqa: E402
from workbench.execution.runner import Computing, run_tasks  # noqa: E402
from workbench.execution.store import Entry, Store  # noqa: E402
from workbench.execution.task import Progress, Task  # noqa: E402
from workbench.questions.section.graph import section_task  # noqa: E402
from workbench.study.reading import read_study  # noqa: E402

TINY = 200


def tiny(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """A task that does next to nothing."""
    (out / "x.txt").write_text(str(inputs["i"]), encoding="utf-8")
    return 0


def loop(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Plain arithmetic: what two processes are worth on this machine at best."""
    return sum(i & 1 for i in range(4_000_000)) - inputs["i"]


class Clock:
    """A listener that notes when the first and the last task ended."""

    def __init__(self) -> None:
        self.ends: list[float] = []

    def damaged(self, name: str, fault: str) -> None: ...
    def warned(self, warning: str) -> None: ...
    def started(self, name: str) -> None: ...
    def progressed(self, name: str, fraction: float) -> None: ...
    def elsewhere(self, name: str) -> None: ...
    def restarted(self, name: str, reason: str) -> None: ...
    def failed(self, name: str, message: str) -> None: ...

    def finished(self, name: str, entry: Entry, reused: bool) -> None:
        """Note the time."""
        self.ends.append(time.perf_counter())


def seconds_per_task(tasks: list[Task], workers: int) -> float:
    """Wall time of each task behind the first one of each worker."""
    with tempfile.TemporaryDirectory() as folder:
        clock = Clock()
        run_tasks(tasks, Store(Path(folder)), clock, Computing(workers=workers))
    return (clock.ends[-1] - clock.ends[workers - 1]) / (len(tasks) - workers)


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=20, help="tasks of the section sweep")
    add_option(parser)
    options = parser.parse_args()
    run, load = Run("sweep"), os.getloadavg()[0]
    small = [Task(name=f"t{i}", function="benchmarks.sweep:tiny", inputs={"i": i}) for i in range(TINY)]
    loops = [Task(name=f"l{i}", function="benchmarks.sweep:loop", inputs={"i": i}) for i in range(options.points)]
    study = read_study(ROOT / "studies" / "strip_sweep.toml")
    solid = [section_task(study, f"s{i}", 5.0 * i, [0.005, 0.010, 0.015]) for i in range(options.points)]
    seconds_per_task(solid[:2], 1)  # compiles
    rows = []
    cases = {
        f"{TINY} tiny tasks": small,
        f"{options.points} section curves": solid,
        f"{options.points} plain loops": loops,
    }
    for case, tasks in cases.items():
        one, two = (min(seconds_per_task(tasks, workers) for _ in range(2)) for workers in (1, 2))
        metric = "wall time for each task"
        rows.append(
            {"case": case, "metric": metric, "unit": "ms", "ours": 1e3 * two, "peer": 1e3 * one, "ratio": one / two}
        )
    for metric, value in (("load average at the start", load), ("processors", float(os.cpu_count() or 1))):
        rows.append({"case": "machine", "metric": metric, "unit": "-", "ours": value, "peer": None, "ratio": None})
    written = run.write(rows, keep=options.record)
    print(f"{'case':<24}{'metric':<32}{'two':>10}{'one':>10}{'ratio':>8}")
    for row in rows:
        shown = [f"{row[k]:.3g}" if row[k] is not None else "" for k in ("ours", "peer", "ratio")]
        metric = f"{row['metric']} [{row['unit']}]"
        print(f"{row['case']:<24}{metric:<32}{shown[0]:>10}{shown[1]:>10}{shown[2]:>8}")
    for path in written:
        print(f"written: {path}")


if __name__ == "__main__":
    main()
