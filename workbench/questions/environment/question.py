"""Question: the wheel at other temperatures, and of another metal.

Verified by tests/unit/test_workbench_environment.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve, read_curve
from contracts.errors import InputError
from contracts.materials import Material
from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from contracts.materials_temperature import REFERENCE_TEMPERATURE, TEMPERATURE_DATA
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.environment.figures import environment_figures
from workbench.questions.fe.graph import curve_deflections, fe_inputs, fe_task, material_inputs, without_fields
from workbench.questions.model_curves import CURVE
from workbench.questions.question import Question
from workbench.questions.strength.yielding import FirstYield, first_yield, smallest_yield_load
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees, orientation_name
from workbench.study.wheel_design import materials, wheel_design
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["ENVIRONMENT", "EnvironmentRun", "Series", "environment_checks", "environment_tasks"]

_AS_DESIGNED = "as designed"
_SIMILARITY = 2e-3
_MODULUS_ALONE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class EnvironmentRun:
    """A curve at one temperature [K], and the material of each part there."""

    temperature: float
    curve: StiffnessCurve
    materials: Mapping[str, Material]

    @property
    def metals(self) -> str:
        """Names of the materials."""
        return ", ".join(dict.fromkeys(material.name for material in self.materials.values()))

    @property
    def thermal_strain(self) -> float | None:
        """Thermal strain of every part [-]; None if they differ."""
        return _common([material.thermal_strain for material in self.materials.values()])

    @property
    def modulus_ratio(self) -> float | None:
        """E / E(20 C) of every part [-]; None if they differ."""
        data = [material.temperature_data for material in self.materials.values()]
        return _common([TEMPERATURE_DATA[name].modulus_ratio.at(self.temperature) for name in data if name])

    @property
    def yield_is_known(self) -> bool:
        """Whether every part has a source for its yield strength at this temperature."""
        if self.temperature == REFERENCE_TEMPERATURE:
            return True
        data = [material.temperature_data for material in self.materials.values()]
        return all(name is not None and TEMPERATURE_DATA[name].yield_ratio is not None for name in data)

    @property
    def doubts(self) -> dict[str, str]:
        """What a reader must know of the data, by name of the data."""
        data = dict.fromkeys(material.temperature_data for material in self.materials.values())
        return {name: TEMPERATURE_DATA[name].doubt for name in data if name}

    @property
    def first_yield(self) -> FirstYield:
        """First yield along the curve, with the yield strengths of this run's materials."""
        return first_yield(self.curve, {part: m.yield_strength for part, m in self.materials.items()})


def _common(values: list[float]) -> float | None:
    return values[0] if max(values) - min(values) < 1e-12 else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One wheel at several temperatures: its curve at 20 C and the others."""

    label: str
    reference: EnvironmentRun
    others: tuple[EnvironmentRun, ...]

    @property
    def runs(self) -> tuple[EnvironmentRun, ...]:
        """All of them, that at 20 C first."""
        return (self.reference, *self.others)

    @property
    def id(self) -> str:
        """Beginning of its checks' identifiers, with its label if it is not the design."""
        return "environment" + ("" if self.label == _AS_DESIGNED else f"_{_plain(self.label)}")

    @property
    def where(self) -> str:
        """Its orientation, and its label if it is not the design."""
        variant = "" if self.label == _AS_DESIGNED else f", {self.label}"
        return f"{self.reference.curve.orientation_deg:g} deg{variant}"

    def comparable(self, run: EnvironmentRun) -> bool:
        """Whether both a run and that at 20 C have points under load."""
        return not (run.curve.unloaded or self.reference.curve.unloaded)

    def load_ratio(self, run: EnvironmentRun) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Deflections [m] of the run's points that both curves have, and load over load at 20 C there [-]."""
        own, reference = run.curve, self.reference.curve
        inside = (own.deflection > 0.0) & (own.deflection <= reference.deflection[-1])
        if not inside.any():
            raise InputError("curves", self.label, "share no deflection", "compute them further")
        return own.deflection[inside], own.load[inside] / reference.load_at(own.deflection[inside])

    def mean_load_ratio(self, run: EnvironmentRun) -> float:
        """Mean of the load ratio over the run's points [-]."""
        return float(self.load_ratio(run)[1].mean())

    def similarity_error(self, run: EnvironmentRun) -> float:
        """Largest |F - theta^2 (E/E_20) F_20(d/theta)| / F over the run's points [-]; see docs/theory.md 2.6."""
        strain, modulus = run.thermal_strain, run.modulus_ratio
        if strain is None or modulus is None:
            raise InputError("materials", run.metals, "expand differently", "similarity needs one metal")
        theta, reference = 1.0 + strain, self.reference.curve
        d, load = run.curve.deflection[1:], run.curve.load[1:]
        inside = d / theta <= reference.deflection[-1]
        if not inside.any():
            raise InputError("curves", self.label, "share no point", "a curve is partial: compute it further")
        expected = theta**2 * modulus * reference.load_at(d[inside] / theta)
        return float(np.max(np.abs(load[inside] - expected) / load[inside]))


def environment_checks(study: Study, results: tuple[Series, ...]) -> list[Check]:
    """Similarity of wheels of one metal (gate); mean load ratio and load at first yield at each temperature."""
    checks = []
    for series in results:
        one_metal = [run for run in series.others if None not in (run.thermal_strain, run.modulus_ratio)]
        if one_metal:
            checks.append(_similarity(series, one_metal))
        checks += [_ratio(series, run) for run in one_metal]
        checks += [_yield(series, run, study.judged_load) for run in series.others if run.yield_is_known]
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
    at, words = _celsius(run.temperature), "load at which a part begins to yield (or where the curve ends)"
    claim = Claim(
        id=f"{series.id}.first_yield_{at}",
        title=f"FE at {at}, {series.where}: {words}",
        quantity="load",
        unit="N",
        role="finding",
        source="yield strength of the metal against temperature, docs/theory.md 2.6",
    )
    return at_least(claim, lambda: smallest_yield_load([run.first_yield], up_to), up_to)


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
    plain = {name: _plain(name) for name in stated(study.environment, "environment").variants}
    alike = [name for name in plain if plain[name] == plain.get(variant)]
    label = plain.get(variant, "") + (f"_{alike.index(variant) + 1}" if len(alike) > 1 else "")
    return f"environment_{label + '_' if label else ''}{_celsius(temperature)}"


def _plain(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "_", name)


def _celsius(temperature: float) -> str:
    return f"{temperature - KELVIN_AT_ZERO_CELSIUS:.6g}C"


def _read(study: Study, folders: Mapping[str, Path]) -> tuple[Series, ...]:
    """One series for the design and each variant: its curve at 20 C and those at other temperatures."""
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
        Series(label=variant or _AS_DESIGNED, reference=found[0], others=tuple(found[1:]))
        for variant, found in runs.items()
    )


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
)
