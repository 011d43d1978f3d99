"""``workbench calibrate brush``: the brush tire of a study's own wheel, beside Table II, kept beside the study.

Verified by tests/end_to_end/test_calibrate_brush.py.
"""

from __future__ import annotations

import math
import shlex
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from contracts.curves import read_curve
from contracts.hub_travel import OVER_GROUND
from workbench.commands.computing import computed, console, naming, read_and_warn, shortest, tell_kept, warn
from workbench.execution.result_files import early_ends
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.kept import keep, replaced, require_place
from workbench.questions.model_curves import CURVE
from workbench.questions.models.driving_brush import RECORD, calibration_tasks
from workbench.questions.models.wheel_brush import Line, WheelBrush, lines_beside_table_two, wheel_brush
from workbench.questions.models.wheel_tasks import where_it_moves
from workbench.questions.travel_files import travel_curves
from workbench.questions.travels import WORKING_LOAD
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish
from workbench.study.full import around
from workbench.study.model_parameters import rover_brush
from workbench.study.orientation import degrees, orientation_name
from workbench.study.reading import built_in_study
from workbench.verdict.number_format import displayed

__all__ = ["run_calibrate_brush"]

TABLE = "brush_of_wheel.csv"
"""In the folder asked for."""


def run_calibrate_brush(
    study_path: Path | None, model: tuple[str, float], out: Path, store: Path, computing: Computing
) -> int:
    """Solve curves and load cases of the wheel, keep the brush tire they make, print and write its table; 0.

    model : fe or ancf_wheel, and the working load [N]
    """
    (name, load), path, begun = model, study_path or built_in_study(), time.monotonic()
    study = read_and_warn(path)
    check_folder(out)
    check_targets(out, (TABLE,))
    asked = [degrees(o) for o in study.fe.orientations]
    with naming(path):
        given, tasks = rover_brush(study), calibration_tasks(study, name, load, asked)
        require_place(study, RECORD)
    given_as = [] if study_path is None else [shlex.quote(str(study_path))]
    at = [] if load == WORKING_LOAD else ["--load", shortest(load)]
    again = " ".join(["workbench calibrate brush", *given_as, "--model", name, *at])
    warn(path, replaced(study, RECORD, again, tasks))
    entries = computed(path, tasks, store, computing)
    folders = {task: entry.path for task, entry in entries.items()}
    warn(path, [f"{task} ends early: {why}" for task, why in early_ends(folders).items()])
    with naming(path):
        curves = [read_curve(folders[orientation_name(name, o)] / CURVE, model=name, orientation_deg=o) for o in asked]
        travels = travel_curves(name, OVER_GROUND, where_it_moves(study), folders)
        found = wheel_brush(curves, travels, load, given, around(study))
    lines = lines_beside_table_two(found)
    seconds = max(time.monotonic() - begun, sum(e.wall_s for e in entries.values()) / (computing.workers or 1))
    _print(found, lines)
    record = keep(study, RECORD, again, tasks, seconds, _record(found, name, asked))
    tell_kept(publish(out, "calibrate brush", {TABLE: _csv(lines)}))
    console.print(f"table: {out / TABLE}", soft_wrap=True)
    console.print(f"kept beside the study: {record}", soft_wrap=True)
    if study.rover is None or study.rover.brush == "study":
        console.print(f'[rover] brush = "wheel" in {path} has the rover drive on it', soft_wrap=True)
    return 0


def _record(found: WheelBrush, model: str, orientations_deg: Sequence[float]) -> dict[str, Any]:
    """What `driving_brush` reads, and the table; SI."""
    return {
        "model": model,
        "load_N": found.load,
        "orientations_deg": list(orientations_deg),
        "radial_N_per_m": found.tire.radial_stiffness,
        "forward_N_per_m": found.carcass.forward,
        "sideways_N_per_m": found.carcass.sideways,
        "table": [line._asdict() for line in lines_beside_table_two(found)],
    }


def _csv(lines: Sequence[Line]) -> str:
    rows = [
        f'{one.name},{one.unit},{_cell(one.table)},{_cell(one.wheel)},{_cell(one.ratio)},"{one.how}"' for one in lines
    ]
    return "\n".join(["parameter,unit,table_ii,wheel,ratio,how", *rows]) + "\n"


def _cell(value: float | None) -> str:
    return "" if value is None else f"{value:.12g}"


def _print(found: WheelBrush, lines: Sequence[Line]) -> None:
    columns = ("parameter", "Table II", "this wheel", "ratio", "how it was found")
    texts = (columns[0], columns[-1])
    title = f"brush tire of the wheel at {found.load:g} N, {1e3 * found.deflection:.1f} mm"
    table = empty_table(title, columns, texts=texts, folded=texts)
    for one in lines:
        ratio = "" if one.ratio is None else f"{one.ratio:.3g}"
        table.add_row(one.name, _shown(one.table, one.unit), _shown(one.wheel, one.unit), ratio, one.how)
    console.print(table)


def _shown(value: float | None, unit: str) -> str:
    """Per degree where Table II has it so."""
    if value is not None and unit == "N/rad":
        value, unit = math.radians(value), "N/deg"
    return displayed(value, unit)
