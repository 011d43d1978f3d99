"""``workbench traverse``: the way between two samples, driven whole over rocks, kept beside the study for its report.

Verified by tests/end_to_end/test_traverse.py.
"""

from __future__ import annotations

import csv
import io
import shlex
import time
from collections.abc import Sequence
from pathlib import Path

from rover_dynamics.rover.rover_file import read_rover
from workbench.commands.computing import console, naming, read_and_warn, shortest, tell_kept, warn
from workbench.execution.progress import RunDisplay
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.terminal import empty_table
from workbench.questions.kept import keep, replaced, require_place
from workbench.questions.traverse.graph import TRAVERSE_TIRES, Asked, stretch_name, traverse_tasks
from workbench.questions.traverse.question import RECORD, TIRE_WORDS
from workbench.questions.traverse.results import WIDTHS, TireRun, found_of, run_of
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import put_files
from workbench.study.reading import built_in_study

__all__ = ["run_traverse"]


def run_traverse(
    study_path: Path | None, tires: Sequence[str], asked: Asked, out: Path, store: Path, computing: Computing
) -> int:
    """Drive every stretch, count, print and keep; goes on where it stopped. 0 also where something ends the drive."""
    path = study_path or built_in_study()
    study = read_and_warn(path)
    driven = tuple(dict.fromkeys(tires)) or TRAVERSE_TIRES[:1]
    begun = time.monotonic()
    with naming(path):
        tasks = traverse_tasks(study, driven, asked)
        require_place(study, RECORD)
        check_folder(out)
        check_targets(out, [_file(tire) for tire in driven])
        warn(path, replaced(study, RECORD, again := _again(study_path, driven, asked), tasks))
        with RunDisplay(console, tasks) as display:
            entries = run_tasks(tasks, Store(store, study=path.stem), display, computing)
    results = {
        tire: [read_result(entries[stretch_name(tire, k)].path) for k in range(asked.stretches)] for tire in driven
    }
    runs = [run_of(tire, results[tire]) for tire in driven]
    wheels = [leg.name for leg in read_rover().legs]
    seconds = max(time.monotonic() - begun, sum(e.wall_s for e in entries.values()) / (computing.workers or 1))
    record = keep(study, RECORD, again, tasks, seconds, found_of(asked, wheels, runs))
    _print(runs, asked)
    tell_kept(put_files(out, {_file(run.tire): _cycles(run, wheels) for run in runs}, "traverse"))
    console.print(f"counted cycles: {out}", soft_wrap=True)
    console.print(f"kept for the report: {record}", soft_wrap=True)
    return 0


def _again(study_path: Path | None, tires: Sequence[str], asked: Asked) -> str:
    """What makes the record anew, as a user types it."""
    plain = Asked()
    options = [f"--tire {tire}" for tire in tires]
    options += [
        f"--{name} {shortest(getattr(asked, name))}" for name in ("distance", "abundance") if _other(name, asked, plain)
    ]
    options += [f"--seed {asked.seed}"] if asked.seed != plain.seed else []
    options += [f"--speed {3600.0 * asked.speed:.10g}"] if _other("speed", asked, plain) else []
    return " ".join(["workbench traverse", *([] if study_path is None else [shlex.quote(str(study_path))]), *options])


def _other(name: str, asked: Asked, plain: Asked) -> bool:
    return bool(getattr(asked, name) != getattr(plain, name))


def _file(tire: str) -> str:
    return f"cycles_{tire}.csv"


def _cycles(run: TireRun, wheels: Sequence[str]) -> bytes:
    """Rows: what is counted, range from and to [N, m], and the cycles of each wheel."""
    text = io.StringIO()
    write = csv.writer(text, lineterminator="\n")
    write.writerow(["of", "range_from", "range_to", *wheels])
    for name, columns in (("load_N", run.load_cycles), ("deflection_m", run.deflection_cycles)):
        width = WIDTHS[name.partition("_")[0]]
        for k in range(max(map(len, columns), default=0)):
            counts = [column[k] if k < len(column) else 0.0 for column in columns]
            write.writerow([name, f"{k * width:g}", f"{(k + 1) * width:g}", *(f"{one:g}" for one in counts)])
    return text.getvalue().encode()


def _print(runs: Sequence[TireRun], asked: Asked) -> None:
    title = f"{asked.distance:g} m at {3600.0 * asked.speed:g} m/h, abundance {asked.abundance:g}, seed {asked.seed}"
    table = empty_table(title, ["", *(TIRE_WORDS[run.tire] for run in runs)], texts=[""])
    for row in zip(_ROWS, *map(_column, runs), strict=True):
        table.add_row(*row)
    console.print(table)
    for run in runs:
        if run.ends:
            console.print(f"{TIRE_WORDS[run.tire]}: {run.ends}")


_ROWS = (
    "way up to where it first ends",
    "way of all stretches",
    "time",
    "energy drives give",
    "net of what they get back",
    "largest load of a wheel",
    "largest deflection",
    "time without load",
    "time above first yield",
    "stretches with a wheel above it",
    "rocks in the wheels' tracks",
    "rocks driven around",
)


def _column(run: TireRun) -> tuple[str, ...]:
    """What `_ROWS` says of one kind of tire; shares of the time are those of the wheel that has most."""
    return (
        f"{run.reached:.1f} m",
        f"{run.way:.1f} m",
        f"{run.time / 3600.0:.3g} h",
        f"{run.energy_per_metre:.1f} J/m",
        f"{run.work_per_metre:.1f} J/m",
        f"{max(run.loads, default=0.0):.0f} N",
        f"{1e3 * max(run.deflections, default=0.0):.1f} mm",
        f"{100.0 * max(run.airborne, default=0.0):.3f} %",
        "" if run.over is None else f"{100.0 * max(run.over, default=0.0):.3f} %",
        "" if run.overloaded is None else f"{run.overloaded} of {run.stretches}",
        f"{run.rocks}",
        f"{run.avoided}",
    )
