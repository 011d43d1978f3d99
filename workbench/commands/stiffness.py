"""``workbench stiffness``: curves of one model at some orientations, with the fields and peak stresses it has.

Verified by tests/end_to_end/test_commands.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from soil.soil import Soil
from workbench.commands.computing import (
    complain_of_early_ends,
    computed,
    console,
    naming,
    read_and_warn,
    tell_kept,
    warn,
)
from workbench.commands.obstacle import USED_BY, on_obstacle
from workbench.execution.result_files import early_ends, losses_of_stability
from workbench.execution.runner import Computing
from workbench.execution.terminal import empty_table
from workbench.questions.curve_graph import MODELS, stiffness_tasks
from workbench.questions.fe.graph import footprint_tasks
from workbench.questions.fe.unloading import Unloading, unloadings
from workbench.questions.models.curves import stiffness_curves
from workbench.questions.soil.graph import pressed_tasks
from workbench.questions.strength.yielding import PeakStress, peak_stresses
from workbench.report.folders import check_folder, check_targets
from workbench.report.outputs import beside_fields, field_files, publish
from workbench.study.model import Study
from workbench.study.obstacle_words import ground_words
from workbench.study.strengths import yield_strengths

__all__ = ["check_orientation", "run_stiffness"]

_SUNK = "contact_point_penetration_m"
type Peaks = Sequence[tuple[float, PeakStress]]
"""Orientation [deg] and peak stress of a part."""


def run_stiffness(
    study_path: Path,
    model: str,
    orientations: tuple[float, ...],
    out: Path,
    store: Path,
    computing: Computing,
    obstacle: Mapping[str, str] | None = None,
    soil: Soil | None = None,
) -> int:
    """Curves of one model at the orientations asked for; fields and peak stresses at the study's snapshot loads.

    obstacle : [fe.obstacle] in place of the study's
    soil : that the wheel is pressed into, or None
    """
    if model not in MODELS:
        raise InputError("model", model, "is not known", f"give one of {', '.join(MODELS)}")
    for orientation in orientations:
        check_orientation(orientation)
    study = read_and_warn(study_path, lambda table: table if obstacle is None else on_obstacle(table, obstacle, model))
    if model == "brush" and orientations:
        warn(study_path, ["the brush is the same at every orientation: --orientation changes nothing"])
    check_folder(out)
    check_targets(out, ("curves/any", "fields/any", "footprints/any", f"{model}_peak_stress.csv"))
    with naming(study_path):
        asked = tuple(dict.fromkeys(orientations))
        tasks = stiffness_tasks(study, model, asked) if soil is None else pressed_tasks(study, model, soil, asked)
        if model == "fe" and soil is None:
            tasks += tuple(footprint_tasks(study, [task for task in tasks if task.name.startswith("fe_")]))
    entries = computed(study_path, tasks, store, computing)
    folders = {name: entry.path for name, entry in entries.items()}
    with naming(study_path):
        curves = stiffness_curves(study, model, folders)
        ways = {c.orientation_deg: c for c in curves if model == "fe" and c.orientation_deg is not None}
        back = unloadings(ways, folders)
    ground = ground_words(study.fe) if model in USED_BY else ""
    if pressed := f"pressed into soil {soil.name}" if soil is not None else f"pressed on a {ground}" if ground else "":
        curves = [replace(curve, source=f"{curve.source}, {pressed}") for curve in curves]
        console.print(pressed, soft_wrap=True)
    peaks, fields = tuple(_peaks(study, curves)), field_files(entries)
    table = {f"{model}_peak_stress.csv": _peaks_csv(peaks)} if peaks else {}
    texts = beside_fields(study, fields) | table
    every = [*curves, *(one.curve for one in back.values())]
    tell_kept(publish(out, f"stiffness {model}", texts, every, copies=fields))
    _print(model, curves, peaks, soil is not None)
    _print_back(back.values())
    for what in (*(["curves"] if curves else []), *sorted({name.split("/")[0] for name in fields})):
        console.print(f"{what}: {out / what}", soft_wrap=True)
    for name in table:
        console.print(f"peak stresses of every part: {out / name}", soft_wrap=True)
    warn(study_path, [f"{task}: {told}" for task, told in losses_of_stability(folders).items()])
    complain_of_early_ends(study_path, early_ends(folders))
    return 0


def check_orientation(orientation: float) -> None:
    """Raise InputError for an orientation [deg] that is not one of a turn."""
    if not (math.isfinite(orientation) and 0.0 <= orientation < 360.0):
        rule = "must be finite, at least 0 and less than 360"
        raise InputError("orientation", f"{orientation} deg", rule, "give degrees such as 15")


def _peaks(study: Study, curves: Sequence[StiffnessCurve]) -> Iterator[tuple[float, PeakStress]]:
    """Peak stress of each part at each snapshot load that a curve reaches."""
    strengths = yield_strengths(study)
    for curve in curves:
        if curve.orientation_deg is None:  # an average has no stress
            continue
        for load in study.fe.snapshot_loads:
            if load <= curve.load.max():
                for peak in peak_stresses(curve, strengths, load):
                    yield curve.orientation_deg, peak


def _peaks_csv(peaks: Peaks) -> str:
    lines = ["orientation_deg,load_N,deflection_m,part,stress_Pa,max_von_mises_Pa,yield_strength_Pa,utilisation"]
    for angle, p in peaks:
        lines.append(
            f"{angle:.12g},{p.load:.12g},{p.deflection:.12g},{p.part},"
            f"{p.stress:.12g},{p.local:.12g},{p.strength:.12g},{p.used:.12g}"
        )
    return "\n".join(lines) + "\n"


def _print_back(back: Iterable[Unloading]) -> None:
    """What remains of each way back."""
    for one in back:
        label = f"back from {1e3 * one.curve.deflection[-1]:.1f} mm at {one.orientation_deg:g} deg"
        if one.permanent_set is None or one.lost is None:
            console.print(f"{label}: not until the ground left the wheel (partial)")
            continue
        share = 100.0 * one.lost / one.work
        remains = round(1e3 * one.permanent_set, 3) + 0.0  # no minus before nothing
        told = f"permanent set {remains:.3f} mm, {one.lost:.3g} J lost of {one.work:.3g} J"
        console.print(f"{label}: {told} ({share:.1f} %)", soft_wrap=True)


def _print(model: str, curves: Sequence[StiffnessCurve], peaks: Peaks, soil: bool) -> None:
    """How far curves reach, a rim into soil; at each orientation and load the part that is nearest to its yield."""
    for curve in curves:
        label = "average" if curve.orientation_deg is None else f"{curve.orientation_deg:g} deg"
        reach = f"{curve.deflection[-1] * 1e3:.1f} mm at {curve.load[-1]:.1f} N"
        reach = "no point converged" if curve.unloaded else reach
        part = " (partial)" if curve.partial else ""
        sunk = curve.columns.get(_SUNK) if soil else None
        sinks = "" if sunk is None or curve.unloaded else f", the rim {1e3 * sunk[-1]:.1f} mm in the soil"
        console.print(f"{model} {label}: {reach}{sinks}{part}", soft_wrap=True)
    if not peaks:
        return
    columns = ("orientation", "load", "part", "stress", "yield", "share")
    table = empty_table("stress against yield", columns, texts=["part"])
    worst: dict[tuple[float, float], PeakStress] = {}
    for angle, peak in peaks:
        worst[angle, peak.load] = max(worst.get((angle, peak.load), peak), peak, key=lambda p: p.used)
    for (angle, load), p in worst.items():
        stress, strength = (f"{value / 1e6:.0f} MPa" for value in (p.stress, p.strength))
        table.add_row(f"{angle:g} deg", f"{load:g} N", p.part, stress, strength, f"{100.0 * p.used:.0f} %")
    console.print(table)
