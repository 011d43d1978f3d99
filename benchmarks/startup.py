"""How long ``workbench --help`` takes, beside a Python that does nothing and one that imports numpy.

``make bench NAME=startup`` prints the table and writes ``build/bench/startup.json``. Processor seconds of a fresh
process, the smallest of ten, taken in turn: what else the machine does moves the wall time, hardly this. The aim is
0.5 s. The ratio is the peer's time over ours: how much of it is the interpreter's own.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.output.run import Run, add_option  # noqa: E402

COMMANDS = {
    "workbench --help": ["-m", "workbench", "--help"],
    "python -c pass": ["-c", "pass"],
    "python -c 'import numpy'": ["-c", "import numpy"],
}
REPEATS = 10


def processor_seconds(arguments: list[str]) -> float:
    """User and system time [s] of one Python process with these arguments."""
    before = os.times()
    subprocess.run([sys.executable, *arguments], cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("startup")
    taken: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(REPEATS):
        for name, arguments in COMMANDS.items():
            taken[name].append(processor_seconds(arguments))
    (own, ours), *peers = ((name, min(times)) for name, times in taken.items())
    print(f"{own:<28}{ours:8.3f} s")
    rows: list[dict[str, object]] = []
    for name, seconds in peers:
        print(f"{name:<28}{seconds:8.3f} s   ratio {seconds / ours:.3f}")
        measured = {"unit": "s", "ours": ours, "peer": seconds, "ratio": seconds / ours}
        rows.append({"case": name, "metric": "processor time of workbench --help", **measured})
    for path in run.write(rows, keep=options.record):
        print(path)


if __name__ == "__main__":
    main()
