"""Curves of the wheel at each temperature and material.

Verified by tests/unit/test_workbench_environment.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.materials import Material
from contracts.materials_temperature import REFERENCE_TEMPERATURE, TEMPERATURE_DATA
from workbench.questions.strength.yielding import FirstYield, first_yield

__all__ = ["AS_DESIGNED", "EnvironmentRun", "Series", "plain_words"]


AS_DESIGNED = "as designed"


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
        return "environment" + ("" if self.label == AS_DESIGNED else f"_{plain_words(self.label)}")

    @property
    def where(self) -> str:
        """Its orientation, and its label if it is not the design."""
        variant = "" if self.label == AS_DESIGNED else f", {self.label}"
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


def plain_words(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "_", name)
