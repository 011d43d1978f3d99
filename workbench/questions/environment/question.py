"""Question of the report: the wheel at other temperatures, and of another metal.

Verified by tests/unit/test_workbench_environment.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.materials import Material
from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from contracts.materials_temperature import REFERENCE_TEMPERATURE
from workbench.execution.task import Task
from workbench.questions.environment.checks import EnvironmentRun, Series, environment_checks
from workbench.questions.fe.graph import curve_deflections, fe_inputs, fe_task, material_inputs, without_fields
from workbench.questions.model_curves import CURVE
from workbench.questions.question import Question
from workbench.study.environment import EnvironmentSection
from workbench.study.model import Study
from workbench.study.orientation import degrees, orientation_name
from workbench.study.wheel_design import materials, wheel_design

__all__ = ["ENVIRONMENT", "environment_tasks"]

_DESIGN = ""
"""The wheel of the study's own materials, among variants."""


def environment_tasks(study: Study) -> list[Task]:
    """One run for each temperature but 20 C, which the study's curves have; of a variant at 20 C and the coldest."""
    section = _section(study)
    end = section.max_deflection or study.fe.max_deflection
    deflections = chosen_points([d for d in curve_deflections(study) if d <= end * (1.0 + 1e-9)], section.points)
    inputs = without_fields(fe_inputs(study, degrees(section.orientation), deflections))
    return [
        fe_task(
            _name(study, variant, temperature),
            inputs | {"materials": material_inputs(_materials(study, variant, temperature))},
        )
        for variant, temperature in _wanted(study)
        if (variant, temperature) != (_DESIGN, REFERENCE_TEMPERATURE)
    ]


def chosen_points(deflections: Sequence[float], points: int) -> list[float]:
    """``points`` of the deflections [m], evenly spread, the last one among them."""
    n = len(deflections)
    places = np.unique(np.ceil(np.arange(1, points + 1) * n / points).astype(int) - 1)
    return [deflections[i] for i in places]


def _section(study: Study) -> EnvironmentSection:
    assert study.environment is not None
    return study.environment


def _wanted(study: Study) -> list[tuple[str, float]]:
    """(variant, temperature [K]) of every curve shown, the reference at 20 C first."""
    section = _section(study)
    others = [T for T in section.temperatures if T != REFERENCE_TEMPERATURE]
    design = [(_DESIGN, T) for T in (REFERENCE_TEMPERATURE, *others)]
    ends = (REFERENCE_TEMPERATURE, *(others[:1] if others and others[0] < REFERENCE_TEMPERATURE else others[-1:]))
    return design + [(variant, T) for variant in section.variants for T in ends]


def _materials(study: Study, variant: str, temperature: float) -> dict[str, Material]:
    """Material of each part at a temperature [K]."""
    design = wheel_design(study).materials
    if variant:
        design = dict.fromkeys(design, materials(study)[variant])
    return {part: material.at(temperature) for part, material in design.items()}


def _name(study: Study, variant: str, temperature: float) -> str:
    """Name of a task: the variant in letters that every file system takes, numbered where two would be alike."""
    plain = {name: re.sub(r"[^A-Za-z0-9]+", "_", name) for name in dict.fromkeys(_section(study).variants)}
    alike = [name for name in plain if plain[name] == plain.get(variant)]
    label = plain.get(variant, "") + (f"_{alike.index(variant) + 1}" if len(alike) > 1 else "")
    return f"environment_{label + '_' if label else ''}{_celsius(temperature)}"


def _celsius(temperature: float) -> str:
    return f"{temperature - KELVIN_AT_ZERO_CELSIUS:.6g}C"


def _read(study: Study, folders: Mapping[str, Path]) -> tuple[Series, ...]:
    """One series for the design and each variant: its curve at 20 C and those at other temperatures."""
    orientation = degrees(_section(study).orientation)
    runs: dict[str, list[EnvironmentRun]] = {}
    for variant, temperature in _wanted(study):
        own = (variant, temperature) == (_DESIGN, REFERENCE_TEMPERATURE)
        name = orientation_name("fe", orientation) if own else _name(study, variant, temperature)
        model = f"fe_{_name(study, variant, temperature).removeprefix('environment_')}"
        curve = read_curve(folders[name] / CURVE, model=model, orientation_deg=orientation)
        run = EnvironmentRun(temperature=temperature, curve=curve, materials=_materials(study, variant, temperature))
        runs.setdefault(variant, []).append(run)
    return tuple(
        Series(label=variant or "as designed", reference=found[0], others=tuple(found[1:]))
        for variant, found in runs.items()
    )


def _curves(study: Study, results: tuple[Series, ...]) -> list[StiffnessCurve]:
    """Every curve that is not among the study's own."""
    first, *variants = results
    runs = [*first.others, *(run for series in variants for run in series.runs)]
    return [
        replace(run.curve, source=f"{run.curve.source}; {run.metals} at {_celsius(run.temperature)}") for run in runs
    ]


def _figures(study: Study, results: tuple[Series, ...]) -> dict[str, str]:
    from workbench.questions.environment.figures import environment_figures

    return environment_figures(results)


ENVIRONMENT: Question = Question(
    name="environment",
    title="Temperature",
    group="Wheel",
    tasks=environment_tasks,
    read=_read,
    checks=environment_checks,
    figures=_figures,
    curves=_curves,
    applies=lambda study: study.environment is not None,
)
