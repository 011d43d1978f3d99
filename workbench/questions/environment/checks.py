"""Runs at other temperatures, and what is held against them: similarity, the modulus alone, yield.

Verified by tests/unit/test_workbench_environment.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.materials import Material
from contracts.materials_tables import KELVIN_AT_ZERO_CELSIUS
from contracts.materials_temperature import REFERENCE_TEMPERATURE, TEMPERATURE_DATA
from contracts.records import Check
from workbench.questions.strength.yielding import FirstYield, first_yield, smallest_yield_load
from workbench.study.model import Study
from workbench.verdict.rules import Claim, at_least, at_most, near

__all__ = ["EnvironmentRun", "Series", "environment_checks"]

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
    claim = _claim(
        "similarity",
        "FE at other temperatures, {where}: largest distance from the similar wheel, over load",
        series,
        "similarity of elastic bodies, docs/theory.md 2.6: one metal everywhere, another modulus; the limit is ours",
    )
    gate = Claim(id=claim.id, title=claim.title, quantity="difference", unit="-", role="gate", source=claim.source)
    return at_most(gate, lambda: max(series.similarity_error(run) for run in runs), _SIMILARITY)


def _ratio(series: Series, run: EnvironmentRun) -> Check:
    assert run.modulus_ratio is not None
    claim = _claim(
        f"stiffness_{_celsius(run)}",
        f"FE at {_celsius(run)}, {{where}}: mean load over that at 20 C, against what the modulus alone gives",
        series,
        "data of the metal against temperature, docs/theory.md 2.6",
    )
    return near(claim, partial(series.mean_load_ratio, run), run.modulus_ratio, _MODULUS_ALONE)


def _yield(series: Series, run: EnvironmentRun, up_to: float) -> Check:
    claim = _claim(
        f"first_yield_{_celsius(run)}",
        f"FE at {_celsius(run)}, {{where}}: load at which a part begins to yield (or where the curve ends)",
        series,
        "yield strength of the metal against temperature, docs/theory.md 2.6",
    )
    claim = Claim(id=claim.id, title=claim.title, quantity="load", unit="N", role="finding", source=claim.source)
    return at_least(claim, lambda: smallest_yield_load([run.first_yield], up_to), up_to)


def _celsius(run: EnvironmentRun) -> str:
    return f"{run.temperature - KELVIN_AT_ZERO_CELSIUS:.6g}C"


def _claim(name: str, title: str, series: Series, source: str) -> Claim:
    """A finding on a ratio, named after the series if it is not the design; ``{where}`` in the title is said here."""
    variant = "" if series.label == "as designed" else series.label
    group = "_".join(["environment", *([re.sub(r"[^A-Za-z0-9]+", "_", variant)] if variant else [])])
    where = f"{series.reference.curve.orientation_deg:g} deg{f', {variant}' if variant else ''}"
    words = title.replace("{where}", where)
    return Claim(id=f"{group}.{name}", title=words, quantity="ratio", unit="-", role="finding", source=source)
