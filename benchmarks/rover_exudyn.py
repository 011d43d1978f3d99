"""The rover in another code: wheel loads at rest, a drop, the straight path and slopes beside EXUDYN's, from one file.

``make bench NAME=rover_exudyn`` compares what `peer_codes/rover_cases.py` lists, prints it, writes
``build/bench/rover_exudyn.json`` and the record that the report reads, ``rover_exudyn.json`` in the folder beside the
study. A minute; `tests/verification/test_rover_exudyn.py` does the same on every run of the tests.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT)]

from benchmarks.output.run import Run  # noqa: E402
from benchmarks.peer_codes.rover_cases import CASES, our_run, peer_run, rows  # noqa: E402
from workbench.execution.fingerprint import library_versions  # noqa: E402
from workbench.questions.kept import keep, require_place  # noqa: E402
from workbench.questions.rover.peer import COMMAND, RECORD, peer_tasks  # noqa: E402
from workbench.study.reading import built_in_study, read_study  # noqa: E402


def compared(name: str) -> list[dict[str, Any]]:
    """Rows of one case, printed."""
    case = CASES[name]
    found = [{**row, "key": f"{name}_{row['key']}"} for row in rows(case, our_run(case), peer_run(case))]
    for row in found:
        values = f"ours {row['ours']:.6g} {row['unit']}, EXUDYN {row['peer']:.6g} {row['unit']}"
        print(f"{row['case']}, {row['quantity']}: {values}, difference {row['difference']:.2g}", flush=True)
    return found


def main() -> None:
    """Compare, print, write, keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", type=Path, default=built_in_study(), help="study file whose report shows it")
    study, run, started = read_study(parser.parse_args().study), Run(RECORD), time.perf_counter()
    require_place(study, RECORD)
    found = [row for name in CASES for row in compared(name)]
    written = run.write([{"metric": row["quantity"], **row} for row in found], keep=False)
    peer = f"EXUDYN {library_versions(['exudyn'])['exudyn']}"
    wall = time.perf_counter() - started
    written.append(keep(study, RECORD, COMMAND, peer_tasks(), wall, {"peer": peer, "rows": found}))
    for path in written:
        print(f"written: {path}")


if __name__ == "__main__":
    main()
