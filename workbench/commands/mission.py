"""``workbench mission``: every requirement of the mission on every kind of tire, kept beside the study for its report.

Verified by tests/end_to_end/test_mission.py.
"""

from __future__ import annotations

import shlex
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from workbench.commands.computing import console, naming, read_and_warn, warn
from workbench.execution.progress import RunDisplay
from workbench.execution.result_files import early_ends, read_result
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.terminal import empty_table
from workbench.questions.kept import keep, replaced, require_place
from workbench.questions.model_curves import CURVE
from workbench.questions.models.between import Between
from workbench.questions.models.wheel_curves import curves_around, largest_between
from workbench.questions.models.wheel_tasks import between_steps, rock_name, solved_tire, where_it_moves
from workbench.questions.rover_mission.graph import COMPARED, MISSION_TIRES, mission_task_name, mission_tasks
from workbench.questions.rover_mission.question import RECORD, TIRE_WORDS
from workbench.questions.rover_mission.requirements import MISSION, TITLES
from workbench.questions.rover_mission.results import Cell, Mission, WheelYield, found_of, mission_of, wheel_yield
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.reading import built_in_study
from workbench.study.strengths import yield_strengths

__all__ = ["run_mission"]


def run_mission(study_path: Path | None, tires: Sequence[str], store: Path, computing: Computing) -> int:
    """Drive, search, print and keep; goes on where it stopped. 0 also where a requirement is not met."""
    path = study_path or built_in_study()
    study = read_and_warn(path)
    asked = [tire for tire in MISSION_TIRES if tire in tires] if set(tires) <= set(MISSION_TIRES) else list(tires)
    driven = tuple(asked) or MISSION_TIRES
    begun = time.monotonic()
    with naming(path):
        tasks = mission_tasks(study, driven)
        require_place(study, RECORD)
        warn(path, replaced(study, RECORD, _again(study_path, driven), tasks))
        with RunDisplay(console, tasks) as display:
            entries = run_tasks(tasks, Store(store, study=path.stem), display, computing)
    folders = {name: entry.path for name, entry in entries.items()}
    warn(path, [f"{task} ends early: {why}" for task, why in early_ends(folders).items()])
    runs = [read_result(folders[mission_task_name(tire, scenario)]) for tire in driven for scenario in MISSION]
    with naming(path):
        found = found_of(runs, *_of_wheel(study, driven, folders))
    seconds = max(time.monotonic() - begun, sum(e.wall_s for e in entries.values()) / (computing.workers or 1))
    record = keep(study, RECORD, _again(study_path, driven), tasks, seconds, found)
    _print(mission_of(found))
    console.print(f"kept for the report: {record}", soft_wrap=True)
    return 0


def _of_wheel(
    study: Study, tires: Sequence[str], folders: Mapping[str, Path]
) -> tuple[WheelYield | None, dict[str, Between], Between | None]:
    """Where the wheel yields, if its solid model is asked, what its tires miss half way between their orientations, and
    what the tangent plane misses on a half-round."""
    between, wheel, rock = {}, None, None
    for tire in (one for one in ("fe", "ancf_wheel") if one in tires):
        values = solved_tire(study, tire)[0]
        if tire == "fe":
            wheel = wheel_yield(curves_around(values, folders), yield_strengths(study))
            rocks = {one: folders[rock_name(one)] for one in where_it_moves(study)[::2]}
            rock = largest_between(values, folders, _curves(tire, rocks), COMPARED)
        halves = {one: folders[orientation_name(tire, one)] for one in between_steps(study)}
        between[tire] = largest_between(values, folders, _curves(tire, halves), COMPARED)
    return wheel, between, rock


def _curves(model: str, folders: Mapping[float, Path]) -> list[StiffnessCurve]:
    return [read_curve(folder / CURVE, model=model, orientation_deg=one) for one, folder in folders.items()]


def _again(study_path: Path | None, tires: tuple[str, ...]) -> str:
    """What makes the record anew, as a user types it."""
    some = "" if tires == MISSION_TIRES else "".join(f" --tire {tire}" for tire in tires)
    if study_path is None:
        return f"workbench mission{some}" if some else "make mission"
    return f"workbench mission {shlex.quote(str(study_path))}{some}"


def _print(mission: Mission) -> None:
    columns = ("requirement", "verdict", "torque", "smallest torque", "energy", "friction")
    for tire in mission.tires:
        table = empty_table(f"mission on {TIRE_WORDS[tire]}", columns, texts=columns[:2], folded=columns[:2])
        for cell in mission.of_tire(tire):
            table.add_row(TITLES[cell.scenario], *_row(cell))
        console.print(table)
    if (wheel := mission.wheel) is not None:
        what = "ends its curves unyielded" if wheel.part is None else f"yields ({wheel.part.replace('_', ' ')})"
        console.print(f"the wheel {what} at {wheel.load:.0f} N, standing on {wheel.orientation_deg:g} deg")


def _row(cell: Cell) -> tuple[str, ...]:
    verdict = cell.decided + (f": {cell.words}" if cell.words else "")
    torque = "" if cell.unlimited is None else f"{cell.unlimited.torque:.3g} N m"
    least = "" if cell.least is None else f"{cell.least.torque:.3g} N m"
    energy = "" if cell.least is None else f"{cell.least.energy:.0f} J"
    return verdict, torque, least, energy, cell.least_friction
