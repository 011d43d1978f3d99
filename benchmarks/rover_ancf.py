"""Speed of the rover on six ANCF tires: straight path, traction, the thesis' way, plates, points, where the time goes.

``make bench NAME=rover_ancf`` prints the table and writes ``build/bench/rover_ancf.json``; with ``ARGS=--record`` the
run is kept for the report. Processor time of one thread, which is the wall time of a core with nothing else to do;
compilation and settling (5 s before time zero) left out; ten outputs a second. The thesis' tire: 8 plates of
5 x 5 x 3 points, 100 contact points a plate of the rim, its contact law with a damper that builds up over 1 mm.

Errors are against a run with a tenth of the error allowed in a step. The thesis' way takes explicit steps whose length
the plates' viscosity limits; it is measured over milliseconds from rest, and the rest is extrapolated. For scale, from
the text of our issue: a C++ peer needs 2.6 s a simulated second for one such tire alone.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.flexible_rows.cases import STRAIGHT, TRACTION, rover  # noqa: E402
from benchmarks.flexible_rows.kernels import kernel_rows, profile_rows  # noqa: E402
from benchmarks.flexible_rows.motions import motion_rows  # noqa: E402
from benchmarks.flexible_rows.sizes import plate_rows, point_rows  # noqa: E402
from benchmarks.flexible_rows.thesis_way import thesis_rows  # noqa: E402
from benchmarks.output.run import Run, add_option  # noqa: E402
from workbench.questions.speed.aims import STRAIGHT_PATH  # noqa: E402

END, TRACTION_END, PROFILED = 40.0, 2.0, 5.0
"""How long motions last, and that of the profile [s]."""


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_option(parser)
    options, run = parser.parse_args(), Run("rover_ancf")
    straight, traction = rover(STRAIGHT), rover(TRACTION)
    rows = motion_rows(STRAIGHT_PATH, straight, END)
    fast = float(str(rows[0]["ours"])) / END
    rows += motion_rows(f"traction, 3.5 N m, {TRACTION_END:g} s", traction, TRACTION_END)
    rows += profile_rows(f"straight path, {PROFILED:g} s", straight, PROFILED)
    rows += kernel_rows(f"straight path, {PROFILED:g} s", straight, PROFILED)
    rows += [*plate_rows(), *point_rows(), *thesis_rows(fast)]
    for r in rows:
        print(f"{r['case']:<58}{r['metric']:<44}{r['ours']:>12.4g} {r['unit']}")
    for path in run.write(rows, keep=options.record):
        print(f"written: {path}")


if __name__ == "__main__":
    main()
