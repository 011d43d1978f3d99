"""``workbench stiffness``: curves of one model at some orientations.

Verified by tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

import math
from pathlib import Path

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from workbench.commands.computing import complain_of_early_ends, computed, console, naming, read_and_warn, tell_kept
from workbench.comparison.curves import mean_curve
from workbench.comparison.results import brush_curve
from workbench.execution.result_files import early_ends
from workbench.execution.runner import Computing
from workbench.execution.store import Entry
from workbench.graph.study_graph import stiffness_tasks
from workbench.report.folders import check_folder
from workbench.report.outputs import publish
from workbench.study.model import Study

__all__ = ["check_orientation", "run_stiffness"]

_MODELS = ("fe", "section", "ancf", "brush")


def run_stiffness(
    study_path: Path, model: str, orientations: tuple[float, ...], out: Path, store: Path, computing: Computing
) -> int:
    """Curves of one model at the orientations asked for."""
    if model not in _MODELS:
        raise InputError("model", model, "is not known", f"give one of {', '.join(_MODELS)}")
    for orientation in orientations:
        check_orientation(orientation)
    if model == "brush" and orientations:
        rule = "means nothing to the brush model, which is alike all around"
        raise InputError("orientation", f"{orientations[0]:g} deg", rule, "leave --orientation out, or choose fe")
    study = read_and_warn(study_path)
    check_folder(out)
    tasks = stiffness_tasks(study, model, tuple(dict.fromkeys(orientations)))
    entries = computed(study_path, tasks, store, computing)
    with naming(study_path):
        curves = _curves(study, model, entries)
    tell_kept(publish(out, f"stiffness {model}", {}, curves))
    for curve in curves:
        label = "average" if curve.orientation_deg is None else f"{curve.orientation_deg:g} deg"
        reach = f"{curve.deflection[-1] * 1e3:.1f} mm at {curve.load[-1]:.1f} N"
        reach = "no point converged" if curve.unloaded else reach
        part = " (partial)" if curve.partial else ""
        console.print(f"{model} {label}: {reach}{part}")
    console.print(f"curves: {out / 'curves'}", soft_wrap=True)
    complain_of_early_ends(study_path, early_ends({name: entry.path for name, entry in entries.items()}))
    return 0


def check_orientation(orientation: float) -> None:
    """Raise InputError for an orientation [deg] that is not one of a turn."""
    if not (math.isfinite(orientation) and 0.0 <= orientation < 360.0):
        rule = "must be finite, at least 0 and less than 360"
        raise InputError("orientation", f"{orientation} deg", rule, "give degrees such as 15")


def _curves(study: Study, model: str, entries: dict[str, Entry]) -> list[StiffnessCurve]:
    if model == "brush":
        return [brush_curve(study, entries["brush"].path)]
    found = []
    for name, entry in entries.items():
        if name.startswith(f"{model}_phi"):
            orientation = float(name.removeprefix(f"{model}_phi"))
            found.append(read_curve(entry.path / "curve.csv", model=model, orientation_deg=orientation))
    return [*found, mean_curve(found)]
