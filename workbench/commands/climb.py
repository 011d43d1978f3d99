"""``workbench climb``: the rover on slopes of soils, up, down and across, kept beside the study for its report.

Verified by tests/end_to_end/test_climb.py.
"""

from __future__ import annotations

import csv
import io
import math
import shlex
import time
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from contracts.errors import InputError
from rover_dynamics.soil.field import CELL
from workbench.commands.computing import console, naming, read_and_warn, tell_kept, warn
from workbench.commands.rover_soil import wheel_of
from workbench.commands.soil_rim import check_soil_tire
from workbench.commands.steps import steps_of
from workbench.execution.progress import RunDisplay
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.terminal import empty_table
from workbench.questions.kept import keep, replaced, require_place
from workbench.questions.soil.climb import DIRECTIONS, RECORD, STUCK, Climb, Climbs, climb_tasks, climbs_of, found_of
from workbench.questions.soil.climb_picture import climb_png
from workbench.report.folders import check_folder, check_targets
from workbench.report.placing import put_files
from workbench.study.model import Study
from workbench.study.reading import built_in_study
from workbench.study.soil_file import soil_of

__all__ = ["ClimbChoices", "run_climb"]

_FILES = ("climb.csv", "climb.png")
_TIRES, _SOILS, _ANGLES = ("rigid", "fe"), ("ding2011", "fjs1", "grc1"), "0:25:5"
_STEEPEST, _MOST = 40.0, 100


@dataclass(frozen=True, slots=True, kw_only=True)
class ClimbChoices:
    """What a user may choose: soils (those of the study if none), tires, and slopes ``A:B:STEP`` in degrees."""

    soils: tuple[str, ...] = ()
    tires: tuple[str, ...] = ()
    angle: str | None = None


def run_climb(study_path: Path | None, choices: ClimbChoices, out: Path, store: Path, computing: Computing) -> int:
    """Drive, print, keep, write table and picture; goes on where it stopped. 0 also where the rover gets stuck."""
    tires = tuple(dict.fromkeys(choices.tires)) or _TIRES
    for tire in tires:
        check_soil_tire(tire)
    angles = _angles(_ANGLES if choices.angle is None else choices.angle)
    path = study_path or built_in_study()
    study, begun = read_and_warn(path), time.monotonic()
    soils = [soil_of(name) if choices.soils else soil_of(name, path.parent) for name in _soils(study, choices)]
    if len({one.name for one in soils}) < len(soils):
        raise InputError("soil", ", ".join(one.name for one in soils), "are two of one name", "rename a file")
    check_folder(out)
    check_targets(out, _FILES)
    again = _again(study_path, choices)
    with naming(path):
        require_place(study, RECORD)
        wheels = {tire: wheel_of(study, tire, study_path, (store, computing)) for tire in tires}
        tasks = climb_tasks(soils, wheels, angles, CELL)
        warn(path, replaced(study, RECORD, again, tasks))
        with RunDisplay(console, tasks) as display:
            entries = run_tasks(tasks, Store(store, study=path.stem), display, computing)
    of_tire = [tire for _ in soils for tire in tires for _ in DIRECTIONS]
    found = found_of(
        [
            Climbs(
                soil=task.inputs["soil"]["name"],
                tire=tire,
                direction=task.inputs["direction"],
                rows=tuple(Climb(**row) for row in read_result(entries[task.name].path)["rows"]),
            )
            for task, tire in zip(tasks, of_tire, strict=True)
        ]
    )
    seconds = max(time.monotonic() - begun, sum(e.wall_s for e in entries.values()) / (computing.workers or 1))
    record = keep(study, RECORD, again, tasks, seconds, found)
    climbs = climbs_of(found)
    _print(climbs)
    title = f"{study.name}: the rover at 70 m/h on slopes of soil"
    files = {_FILES[0]: _table(climbs).encode(), _FILES[1]: climb_png(climbs, title)}
    tell_kept(put_files(out, files, "climb"))
    console.print(f"drives: {out / _FILES[0]}, {out / _FILES[1]}", soft_wrap=True)
    console.print(f"kept for the report: {record}", soft_wrap=True)
    return 0


def _soils(study: Study, choices: ClimbChoices) -> Sequence[str]:
    return choices.soils or (_SOILS if study.soil is None else study.soil.soils)


def _angles(text: str) -> tuple[float, ...]:
    """Slopes [rad] of ``A:B:STEP`` or one number, in degrees."""
    found = steps_of(text, "angle", _ANGLES, _MOST)
    if not 0.0 <= found[0] <= found[-1] <= _STEEPEST:
        rule = f"must lie in 0 to {_STEEPEST:g} degrees"
        raise InputError("angle", repr(text), rule, f"{_ANGLES} is usual")
    return tuple(math.radians(one) for one in found)


def _again(study_path: Path | None, choices: ClimbChoices) -> str:
    """What makes the record anew, as a user types it."""
    study = [] if study_path is None else [shlex.quote(str(study_path))]
    soils = [f"--soil {shlex.quote(one)}" for one in choices.soils]
    tires = [f"--tire {one}" for one in choices.tires]
    angle = [] if choices.angle is None else [f"--angle {choices.angle}"]
    return " ".join(["workbench climb", *study, *soils, *tires, *angle])


def _print(climbs: Sequence[Climbs]) -> None:
    columns = ("soil", "tire", "way", "deg", "slip", "ruts", "drift", "N m", "J/m", "ruts")
    title = f"steepest slope without getting stuck (a slip of {STUCK:g} over 5 s) and what it takes, in ruts too"
    table = empty_table(title, columns, texts=columns[:3])
    for one in climbs:
        row = one.at(one.steepest) if one.rows[0].climbs else None
        told = [one.shown if row else "none", *["-"] * 6]
        if row is not None:
            numbers = (row.slip, row.slip_in_ruts, row.drift, row.torque, row.energy, row.energy_in_ruts)
            shapes = ("{:z.2f}", "{:z.2f}", "{:z.2f}", "{:.2f}", "{:.0f}", "{:.0f}")
            told[1:] = ["-" if n is None else shape.format(n) for n, shape in zip(numbers, shapes, strict=True)]
        table.add_row(one.soil, one.tire, one.direction, *told)
    console.print(table)
    for one in climbs:
        for row in one.rows:
            if row.stopped:
                where = f"{one.soil}, {one.tire}, {one.direction}, {row.angle_deg:g} deg"
                console.print(f"{where}: {row.stopped}", soft_wrap=True)


def _table(climbs: Sequence[Climbs]) -> str:
    stream = io.StringIO()
    names = [one.name for one in fields(Climb) if one.name != "stopped"]
    units = {"largest": "largest_slip", "torque": "torque_N_m", "energy": "energy_J_m", "sinkage": "sinkage_m"}
    units["energy_in_ruts"] = "energy_in_ruts_J_m"
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["soil", "tire", "direction", *(units.get(name, name) for name in names), "stopped"])
    for one in climbs:
        for row in one.rows:
            numbers = [getattr(row, name) for name in names]
            shown = ["" if value is None else f"{value:.6g}" for value in numbers]
            writer.writerow([one.soil, one.tire, one.direction, *shown, row.stopped])
    return stream.getvalue()
