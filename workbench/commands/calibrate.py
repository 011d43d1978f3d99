"""``workbench calibrate``: runs the trials, prints the table, writes the result and a study with the found thickness.

Verified by tests/end_to_end/test_calibrate.py.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.curves import read_curve
from contracts.errors import InputError, StudyError
from contracts.input_file import input_text
from workbench.commands.computing import read_and_warn, tell_kept
from workbench.execution.errors import RunError
from workbench.execution.progress import RunDisplay
from workbench.execution.runner import Computing, run_tasks
from workbench.execution.store import Store
from workbench.execution.task import Task
from workbench.execution.terminal import console, empty_table
from workbench.questions.calibration import Calibration, Trial, calibrate, scaled_study, strip_thicknesses
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.graph import without_fields
from workbench.questions.model_curves import CURVE, mean_curve
from workbench.questions.section.graph import without_planar_model
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish, to_json
from workbench.study.full import around
from workbench.study.magnitudes import above_zero
from workbench.study.model import Study
from workbench.study.orientation import degrees
from workbench.study.reading import built_in_study, study_of
from workbench.study.rewrite import rewritten_study
from workbench.study.wheel_design import wheel_design

__all__ = ["run_calibrate"]

_NAMES = {"section": "section model", "fe": "solid model"}


def run_calibrate(study_path: Path | None, target: str | None, out: Path, store: Path, computing: Computing) -> int:
    """Find the strip thickness for a target tangent; 0 if the solid model confirms it within the study's tolerance."""
    path = study_path or built_in_study()
    study = read_and_warn(path)
    if (reason := without_planar_model(study)) is not None:
        hint = "calibration steps by the section model: take it out, or try thicknesses with workbench stiffness"
        raise StudyError(path, reason.what, reason.value, reason.rule, hint)
    if target is None:
        wanted = _of_the_reference(study)
    else:
        wanted = above_zero("target", target, "N/m", "reference.slope.value", "8.25 N/mm")
    check_folder(out)
    name = f"{path.stem}_calibrated.toml"
    check_targets(out, ("calibration.json", name))
    runs = _Runs(study=study, store=Store(store, study=path.stem), computing=computing)
    found = calibrate(wanted, runs.tangent("section"), runs.tangent("fe"))
    note = f"strip thickness found by workbench calibrate for an initial tangent of {wanted * 1e-3:g} N/mm"
    thickness = strip_thicknesses(study, found.corrected.factor)
    text = rewritten_study(input_text(path, "study file"), thickness, note, path.parent)
    files = {"calibration.json": to_json(_summary(study, found))}
    try:
        _check_rewritten(out / name, text, thickness)
        files[name] = text
    finally:  # a study that says something else is not written, but what was found is
        tell_kept(publish(out, "calibrate", files))
    _print(study, found)
    console.print(f"study: {out / name}", soft_wrap=True)
    return 0 if abs(found.difference) <= study.tolerances.initial_tangent else 1


def _of_the_reference(study: Study) -> float:
    if study.reference is None or study.reference.slope is None:
        rule = "is missing, and the study has no [reference] slope"
        raise InputError("target", "", rule, "give --target '8.25 N/mm'")
    return study.reference.slope.value


@dataclass(frozen=True, slots=True, kw_only=True)
class _Runs:
    """Runs both models of the study at other thicknesses; results are kept in the store as always."""

    study: Study
    store: Store
    computing: Computing

    def tangent(self, model: str) -> Callable[[float], float]:
        """Thickness factor -> initial tangent of the mean over the study's orientations [N/m]."""

        def evaluate(factor: float) -> float:
            scaled = scaled_study(self.study, factor)
            wheel_design(scaled)
            value = self._solve(model, [self._shortened(task) for task in stiffness_tasks(scaled, model, ())])
            shown = f"strips {factor:.4f} times as thick: {_NAMES[model]} {value * 1e-3:.4f} N/mm"
            console.print(shown)
            return value

        return evaluate

    def _shortened(self, task: Task) -> Task:
        """A run ends at the first point of the study's curve that the tangent needs, and keeps no fields."""
        if "deflections" not in task.inputs:
            return task
        up_to, points = self.study.tangent_up_to, list(task.inputs["deflections"])
        last = next((i for i, d in enumerate(points) if d >= up_to - 1e-12), len(points) - 1)
        return replace(task, inputs=without_fields(task.inputs) | {"deflections": points[: last + 1]})

    def _solve(self, model: str, tasks: Sequence[Task]) -> float:
        with RunDisplay(console, tasks) as display:
            entries = run_tasks(tasks, self.store, display, self.computing)
        folders = {name: entry.path for name, entry in entries.items() if name.startswith(f"{model}_phi")}
        turns = {name: float(name.removeprefix(f"{model}_phi")) for name in folders}
        curves = [read_curve(path / CURVE, model=model, orientation_deg=turns[name]) for name, path in folders.items()]
        if any(curve.partial for curve in curves):
            raise RunError(f"{_NAMES[model]}: a run to the initial tangent does not converge; see workbench stiffness")
        return mean_curve(curves, around(self.study)).initial_tangent(self.study.tangent_up_to)


def _summary(study: Study, found: Calibration) -> dict[str, Any]:
    """``calibration.json``, schema 1; SI."""

    def row(trial: Trial) -> dict[str, Any]:
        return {
            "factor": trial.factor,
            "thickness_m": strip_thicknesses(study, trial.factor),
            "section_tangent_N_per_m": trial.section,
            "solid_tangent_N_per_m": trial.solid,
        }

    return {
        "schema": 1,
        "study": study.name,
        "target_N_per_m": found.target,
        "tangent_up_to_m": study.tangent_up_to,
        "orientations_deg": [degrees(o) for o in study.fe.orientations],
        "first": row(found.first),
        "corrected": row(found.corrected),
        "solid_over_section": found.first.ratio,
        "difference": found.difference,
    }


def _check_rewritten(path: Path, text: str, thickness: dict[str, float]) -> None:
    """Make sure that the study to be written can be read, and says what was found."""
    if strip_thicknesses(study_of(path, tomllib.loads(text))) != thickness:
        shown = ", ".join(f"{name} {t * 1e3:.4f} mm" for name, t in thickness.items())
        raise RunError(f"{path}: the thicknesses could not be written into this file; set them by hand: {shown}")


def _print(study: Study, found: Calibration) -> None:
    title = f"initial tangent to {study.tangent_up_to * 1e3:g} mm, mean of the orientations"
    columns = ("trial", "rim thickness", "section", "solid", "target", "solid - target")
    table = empty_table(title, columns, texts=["trial"])
    for name, trial in (
        ("section model meets the target", found.first),
        ("corrected by solid/section", found.corrected),
    ):
        table.add_row(
            name,
            f"{strip_thicknesses(study, trial.factor)['tire'] * 1e3:.4f} mm",
            f"{trial.section * 1e-3:.4f} N/mm",
            f"{trial.solid * 1e-3:.4f} N/mm",
            f"{found.target * 1e-3:.4f} N/mm",
            f"{100.0 * (trial.solid / found.target - 1.0):+.2f} %",
        )
    console.print(table)
