"""``workbench stiffness --path``: the hub of the wheel along a path over the ground, and what energy that takes.

Verified by tests/end_to_end/test_hub_path.py and tests/unit/test_workbench_hub_path.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from contracts.hub_travel import HubPlace, Way
from contracts.path_curve import PathCurve, write_path
from workbench.commands.computing import (
    complain_of_early_ends,
    computed,
    console,
    naming,
    read_and_warn,
    tell_kept,
    warn,
)
from workbench.commands.stiffness import check_orientation
from workbench.execution.result_files import early_ends
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.travel_files import path_curves
from workbench.questions.travels import path_tasks
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import publish
from workbench.study.hub_path import hub_path
from workbench.study.orientation import degrees, orientation_name

__all__ = ["off_the_ground", "run_path"]

_NOTHING = 1e-6
"""Share of the largest load that counts as none [-]."""


def run_path(
    study_path: Path,
    model: str,
    path: str,
    orientations: tuple[float, ...],
    out: Path,
    store: Path,
    computing: Computing,
) -> int:
    """Force and moment along a path, as `workbench.study.hub_path` reads it, at the orientations asked for [deg]."""
    for orientation in orientations:
        check_orientation(orientation)
    study = read_and_warn(study_path)
    check_folder(out)
    check_targets(out, ("paths/any",))
    places = hub_path(path, study.fe.max_deflection)
    each = tuple(dict.fromkeys(orientations)) or tuple(degrees(o) for o in study.fe.orientations)
    with naming(study_path):
        tasks = path_tasks(study, model, places, each)
    entries = computed(study_path, tasks, store, computing)
    folders = {name: entry.path for name, entry in entries.items()}
    with naming(study_path):
        curves = path_curves(model, each, folders)
    tell_kept(publish(out, f"stiffness {model} path", _texts(curves)))
    _print(curves)
    if curves:
        console.print(f"paths: {out / 'paths'}", soft_wrap=True)
    warn(study_path, [told for curve in curves for told in off_the_ground(curve)])
    complain_of_early_ends(study_path, early_ends(folders))
    return 0


def off_the_ground(curve: PathCurve) -> list[str]:
    """Where the wheel leaves the ground after its first touch, in a sentence; none where it stays."""
    load = curve.columns["load_N"]
    off = np.flatnonzero(load[1:] <= _NOTHING * load.max()) + 1
    if not len(off):
        return []
    place = dict(zip(HubPlace._fields, curve.places[off[0]].tolist(), strict=True))
    words = [
        f"{name} {math.degrees(value):.3g} deg" if Way(name).turns else f"{name} {1e3 * value:.3g} mm"
        for name, value in place.items()
        if value
    ]
    where = f"{curve.model} {curve.orientation_deg:g} deg: the wheel is off the ground at {len(off)} of its steps"
    return [f"{where}, first at {', '.join(words)}"]


def _texts(curves: Sequence[PathCurve]) -> dict[str, str]:
    found = {}
    with TemporaryDirectory() as folder:
        for curve in curves:
            path = Path(folder) / "path.csv"
            write_path(curve, path)
            found[f"paths/{orientation_name(curve.model, curve.orientation_deg)}.csv"] = path.read_text("utf-8")
    return found


def _print(curves: Sequence[PathCurve]) -> None:
    """Energy of each path: what the hub put in, what is still stored, what is gone, and by what account."""
    columns = ("orientation", "steps", "load up to", "work", "stored", "dissipated", "counted")
    table = empty_table("energies of the hub's path, mJ", columns, texts=[])
    for curve in curves:
        work, stored = float(curve.work[-1]), float(curve.stored[-1])
        energies = [f"{1e3 * value:.1f}" for value in (work, stored, work - stored, float(curve.lost[-1]))]
        if curve.model != "fe":
            energies[-1] = "."
        largest = f"{curve.columns['load_N'].max():.0f} N"
        table.add_row(f"{curve.orientation_deg:g} deg", str(len(curve.places) - 1), largest, *energies)
    console.print(table)
    console.print(
        "dissipated: the hub's work less what is stored at the end, by the trapezoid rule over the steps; counted: by "
        "friction and flow where they act (fe)",
        soft_wrap=True,
    )
