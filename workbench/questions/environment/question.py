"""Question: the wheel at other temperatures, and of another metal.

Verified by tests/unit/test_workbench_environment.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve, read_curve
from contracts.materials import Material
from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from contracts.materials_temperature import REFERENCE_TEMPERATURE
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.environment.figures import environment_figures
from workbench.questions.environment.results import AS_DESIGNED, EnvironmentRun, Series, plain_words
from workbench.questions.fe.graph import curve_deflections, fe_inputs, fe_task, material_inputs, without_fields
from workbench.questions.model_curves import CURVE, model_curves
from workbench.questions.question import Question
from workbench.questions.strength.yielding import smallest_yield_load
from workbench.study.full import around
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees, orientation_name
from workbench.study.wheel_design import materials, wheel_design
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["ENVIRONMENT", "environment_checks", "environment_tasks"]

_SIMILARITY = 2e-3
_MODULUS_ALONE = 0.01


def environment_checks(study: Study, results: tuple[Series, ...]) -> list[Check]:
    """Similarity of wheels of one metal (gate); mean load ratio and load at first yield at each temperature."""
    checks = []
    for series in results:
        one_metal = [run for run in series.others if None not in (run.thermal_strain, run.modulus_ratio)]
        if one_metal:
            checks.append(_similarity(series, one_metal))
        checks += [_ratio(series, run) for run in one_metal]
        checks += [_yield(series, run, study.judged_load) for run in series.others if series.knows_yield_around(run)]
    return checks


def _similarity(series: Series, runs: list[EnvironmentRun]) -> Check:
    why = "one metal everywhere, another modulus; the limit is ours"
    claim = Claim(
        id=f"{series.id}.similarity",
        title=f"FE at other temperatures, {series.where}: largest distance from the similar wheel, over load",
        quantity="difference",
        unit="-",
        role="gate",
        source=f"similarity of elastic bodies, docs/theory.md 2.6: {why}",
    )
    return at_most(claim, lambda: max(series.similarity_error(run) for run in runs), _SIMILARITY)


def _ratio(series: Series, run: EnvironmentRun) -> Check:
    assert run.modulus_ratio is not None
    at, words = _celsius(run.temperature), "mean load over that at 20 C, against what the modulus alone gives"
    claim = Claim(
        id=f"{series.id}.stiffness_{at}",
        title=f"FE at {at}, {series.where}: {words}",
        quantity="ratio",
        unit="-",
        role="finding",
        source="data of the metal against temperature, docs/theory.md 2.6",
    )
    return near(claim, partial(series.mean_load_ratio, run), run.modulus_ratio, _MODULUS_ALONE)


def _yield(series: Series, run: EnvironmentRun, up_to: float) -> Check:
    at = _celsius(run.temperature)
    claim = Claim(
        id=f"{series.id}.first_yield_{at}",
        title=f"FE at {at}: smallest load of any orientation at which a part begins to yield (or where the curve ends)",
        quantity="load",
        unit="N",
        role="finding",
        source="yield strength of the metal against temperature; the similar wheel's curves, docs/theory.md 2.6",
    )
    return at_least(claim, lambda: smallest_yield_load(series.first_yields(run), up_to), up_to)


_DESIGN = ""
"""The wheel of the study's own materials, among variants."""


def environment_tasks(study: Study) -> list[Task]:
    """One run for each temperature but 20 C, which the study's curves have; of a variant at 20 C and the coldest."""
    section = stated(study.environment, "environment")
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


def _wanted(study: Study) -> list[tuple[str, float]]:
    """(variant, temperature [K]) of every curve shown, the reference at 20 C first."""
    section = stated(study.environment, "environment")
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
    plain = {name: plain_words(name) for name in stated(study.environment, "environment").variants}
    alike = [name for name in plain if plain[name] == plain.get(variant)]
    label = plain.get(variant, "") + (f"_{alike.index(variant) + 1}" if len(alike) > 1 else "")
    return f"environment_{label + '_' if label else ''}{_celsius(temperature)}"


def _celsius(temperature: float) -> str:
    return f"{temperature - KELVIN_AT_ZERO_CELSIUS:.6g}C"


def _read(study: Study, folders: Mapping[str, Path]) -> tuple[Series, ...]:
    """One series for the design and each variant: its curve at 20 C and those at other temperatures.

    The design's own curves at every orientation tell, by similarity, where it yields at other temperatures.
    """
    orientation = degrees(stated(study.environment, "environment").orientation)
    runs: dict[str, list[EnvironmentRun]] = {}
    for variant, temperature in _wanted(study):
        own = (variant, temperature) == (_DESIGN, REFERENCE_TEMPERATURE)
        name = orientation_name("fe", orientation) if own else _name(study, variant, temperature)
        model = f"fe_{_name(study, variant, temperature).removeprefix('environment_')}"
        curve = read_curve(folders[name] / CURVE, model=model, orientation_deg=orientation)
        run = EnvironmentRun(temperature=temperature, curve=curve, materials=_materials(study, variant, temperature))
        runs.setdefault(variant, []).append(run)
    return tuple(
        Series(
            label=variant or AS_DESIGNED,
            reference=found[0],
            others=tuple(found[1:]),
            around=() if variant else _around(study, folders),
        )
        for variant, found in runs.items()
    )


def _around(study: Study, folders: Mapping[str, Path]) -> tuple[StiffnessCurve, ...]:
    """The study's curves at 20 C; none if one of them has no point, for then its yield is not known."""
    fe = model_curves("fe", folders, around(study))
    return () if fe.missing else tuple(fe.loaded.values())


def _curves(study: Study, results: tuple[Series, ...]) -> list[StiffnessCurve]:
    """Every curve that is not among the study's own."""
    first, *variants = results
    runs = [*first.others, *(run for series in variants for run in series.runs)]
    return [
        replace(run.curve, source=f"{run.curve.source}; {run.metals} at {_celsius(run.temperature)}") for run in runs
    ]


ENVIRONMENT: Question = Question(
    name="environment",
    title="Temperature",
    group="Wheel",
    tasks=environment_tasks,
    read=_read,
    checks=environment_checks,
    figures=environment_figures,
    curves=_curves,
    applies=lambda study: study.environment is not None,
    budget=1000,
)
