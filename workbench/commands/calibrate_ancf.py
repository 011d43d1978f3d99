"""``workbench calibrate ancf``: fits the ANCF tires of a study to its FE curves and writes a study with the kept one.

Verified by tests/end_to_end/test_calibrate_ancf.py.
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.errors import InputError
from contracts.input_file import input_text
from workbench.commands.computing import read_and_warn, tell_kept, warn
from workbench.execution.errors import RunError
from workbench.execution.progress import RunDisplay
from workbench.execution.result_files import read_result
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task
from workbench.execution.terminal import console, empty_table
from workbench.questions.ancf_fit.fit import FittedTire, read_fit
from workbench.questions.ancf_fit.graph import AS_IT_IS, fit_name, fit_tasks, stand_name, stand_task
from workbench.questions.ancf_fit.stand_task import reasons_against
from workbench.questions.study_graph import report_tasks
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish, to_json
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.model_parameters import ancf_preset
from workbench.study.reading import built_in_study, study_of
from workbench.study.rewrite import rewritten_study, rewritten_table
from workbench.verdict.number_format import displayed

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.records import Fitted, Held

__all__ = ["run_calibrate_ancf"]

_UNITS = {"young_modulus": "Pa", "density": "kg/m^3", "contact_stiffness": "N/m", "phase": "rad"}
_LENGTHS = ("outer_radius", "datum_radius", "hub_radius", "rim_thickness", "spoke_thickness")
_COUNTS = ("circumferential_plates", "spokes")


def run_calibrate_ancf(study_path: Path | None, tire: str | None, out: Path, store: Path, computing: Computing) -> int:
    """Fit the study's tires, or one of them; 0 if the kept one is to be trusted.

    It follows the FE average within the study's tolerance, stands, and carries nearly the same on twice as many plates.
    """
    from workbench.questions.ancf_fit.records import Fitted, Held

    path = study_path or built_in_study()
    study = _chosen(read_and_warn(path), tire)
    section = study.ancf_fit
    assert section is not None
    check_folder(out)
    name = f"{path.stem}_fitted.toml"
    check_targets(out, ("ancf_fit.json", name))
    checks = [stand_task(study, t.name) for t in section.tires]
    tasks = [*_with_needs(fit_tasks(study), report_tasks(study)), *checks]
    with RunDisplay(console, tasks) as display:
        entries = run_tasks(tasks, Store(store, study=path.stem), display, computing)
    own = read_fit("own", entries[AS_IT_IS].path, Held, around(study))
    tires = [read_fit(t.name, entries[fit_name(t.name)].path, Fitted, around(study)) for t in section.tires]
    kept = next(t for t in tires if t.name == section.kept.name)
    against = {t.name: reasons_against(read_result(entries[stand_name(t.name)].path)) for t in section.tires}
    note = f"ANCF tire fitted to the FE curves by workbench calibrate ancf: {kept.name}"
    if against[kept.name]:
        note += f". Not to be trusted: {against[kept.name][0]}"
    text = rewritten_study(input_text(path, "study file"), {}, note, path.parent)
    summary = {"schema": 1, "study": study.name, "kept": kept.name, "own": asdict(own.numbers)}
    summary["tires"] = [{"name": t.name, **asdict(t.numbers), "not_to_be_trusted": against[t.name]} for t in tires]
    curves = [curve for t in tires for curve in (*t.curves.values(), t.average)]
    text = rewritten_table(text, "ancf", _values(kept), without=["surfaces"])
    files = {"ancf_fit.json": to_json(summary)}
    try:
        _check_rewritten(out / name, text, kept)
        files[name] = text
    finally:  # a study that says something else is not written, but what was found is
        tell_kept(publish(out, "calibrate ancf", files, curves))
    _print([own, *tires], kept)
    for fitted, reasons in against.items():
        warn(path, [f"{fitted}: {reason}" for reason in reasons])
    console.print(f"study: {out / name}", soft_wrap=True)
    follows = abs(kept.numbers.average.largest) <= study.tolerances.ancf_fit
    return 0 if follows and not against[kept.name] else 1


def _chosen(study: Study, tire: str | None) -> Study:
    """The study with all its tires to be fitted, or with one of them; InputError if there is none."""
    section = study.ancf_fit
    if section is None:
        raise InputError("[ancf_fit]", "missing", "is needed to fit the ANCF tire", "copy it from studies/exomars.toml")
    if tire is None:
        return study
    chosen = tuple(t for t in section.tires if t.name == tire)
    if not chosen:
        known = ", ".join(t.name for t in section.tires)
        raise InputError("tire", tire, f"is none of the study's ({known})", "name one of [[ancf_fit.tires]]")
    return study.model_copy(update={"ancf_fit": section.model_copy(update={"tires": chosen, "keep": tire})})


def _with_needs(wanted: Sequence[Task], known: Sequence[Task]) -> list[Task]:
    """The tasks wanted and all they need, in the order of the graph."""
    by_name, needed = {task.name: task for task in known}, set[str]()
    open_names = [task.name for task in wanted]
    while open_names:
        name = open_names.pop()
        if name not in needed:
            needed.add(name)
            open_names += by_name[name].needs
    return [task for task in known if task.name in needed]


def _values(tire: FittedTire[Fitted]) -> dict[str, object]:
    """Keys of [ancf], with the fitted tire's numbers to seven digits, the FE's orientations."""
    preset = asdict(tire.numbers.preset)
    values: dict[str, object] = {name: f"{1e3 * preset[name]:.7g} mm" for name in _LENGTHS}
    values |= {name: f"{preset[name]:.7g} {unit}" for name, unit in _UNITS.items()}
    values |= {name: preset[name] for name in (*_COUNTS, "contact_damping")}
    return values | {"orientations": [f"{o:g} deg" for o in tire.numbers.orientations_deg], "thesis_preset": False}


def _check_rewritten(path: Path, text: str, tire: FittedTire[Fitted]) -> None:
    """Make sure that the study to be written can be read, and says what was found."""
    study = study_of(path, tomllib.loads(text))
    found, wanted = ancf_preset(study), tire.numbers.preset
    for name in (*_LENGTHS, *_UNITS, *_COUNTS):
        value, goal = getattr(found, name), getattr(wanted, name)
        if abs(value - goal) > 1e-5 * abs(goal):
            raise RunError(f"{path}: [ancf] {name} could not be written into this file; set it by hand: {goal:g}")


def _print(tires: Sequence[FittedTire[Held]], kept: FittedTire[Fitted]) -> None:
    """Errors of every tire, then the kept one's parameters."""
    low, high = kept.numbers.load_range_N
    columns = ("tire", "spokes", "rim plates", "average: largest", "at", *(f"{o:g} deg" for o in kept.curves))
    table = empty_table(f"against the FE curves, {low:.0f} to {high:.0f} N", columns, texts=["tire"])
    for tire in tires:
        n = tire.numbers
        each = [f"{100.0 * e:.1f} %" for e in n.relative_rms]
        worst = f"{100.0 * n.average.largest:+.2f} %", f"{n.average.at_load:.0f} N"
        mesh = str(n.preset.spokes), str(n.preset.circumferential_plates)
        table.add_row(tire.name, *mesh, *worst, *each)
    console.print(table)
    _print_travels(tires)
    columns = ("parameter", "value", "95 % interval")
    table = empty_table(f"{kept.name}: parameters", columns, texts=["parameter"])
    for row in kept.numbers.parameters:
        fitted = "at its bound" if row.at_bound else _interval(row.interval, row.unit)
        table.add_row(row.name, displayed(row.value, row.unit), fitted)
    console.print(table)
    for pair in kept.numbers.indistinguishable:
        console.print(f"cannot be told apart: {' and '.join(pair)}")


def _print_travels(tires: Sequence[FittedTire[Held]]) -> None:
    """Stiffnesses against the hub's travel, of the FE wheel and of every tire beside it, if the study asks for them."""
    rows = tires[0].numbers.travels
    if not rows:
        return
    columns = ("travel", "at", "FE", *(tire.name for tire in tires))
    title = f"against the hub's travel under {tires[0].numbers.travel_load_N:g} N: N/mm, turning N m/rad"
    table = empty_table(title, columns, texts=["travel"])
    for i, row in enumerate(rows):
        scale = 1e-3 if row.unit == "N/m" else 1.0
        cells = [row.way, f"{row.orientation_deg:g} deg", f"{scale * row.fe:.4g}"]
        for own in (tire.numbers.travels[i] for tire in tires):
            if own.tire is None or own.difference is None:
                cells.append("–")
            else:
                cells.append(f"{scale * own.tire:.4g} ({100.0 * own.difference:+.0f} %)")
        table.add_row(*cells)
    console.print(table)


def _interval(ends: Sequence[float] | None, unit: str) -> str:
    return "–" if ends is None else " … ".join(displayed(value, unit) for value in ends)
