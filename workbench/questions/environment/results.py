"""Curves of the wheel at each temperature and material.

Verified by tests/unit/test_workbench_environment.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

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
    def yield_strength(self) -> dict[str, float]:
        """Yield strength [Pa] of each part at this temperature."""
        found = {part: material.yield_strength for part, material in self.materials.items()}
        return {part: strength for part, strength in found.items() if strength is not None}


def _common(values: list[float]) -> float | None:
    return values[0] if max(values) - min(values) < 1e-12 else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Series:
    """One wheel at several temperatures: its curve at 20 C and the others, all at one orientation.

    ``around`` : its curves at 20 C at every orientation of the study, of the wheel as designed.
    """

    label: str
    reference: EnvironmentRun
    others: tuple[EnvironmentRun, ...]
    around: Sequence[StiffnessCurve] = ()

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

    def knows_yield_around(self, run: EnvironmentRun) -> bool:
        """Whether first yield at a run's temperature is known at every orientation: of one metal, by similarity."""
        similar = None not in (run.thermal_strain, run.modulus_ratio)
        return bool(self.around) and run.yield_is_known and (similar or run is self.reference)

    def first_yield(self, run: EnvironmentRun) -> FirstYield:
        """That of least load at any orientation where it is known, at the runs' own else."""
        found = self.first_yields(run)
        return min(found, key=lambda one: (one.part is None, one.load))

    def first_yields(self, run: EnvironmentRun) -> list[FirstYield]:
        """First yield along every curve of the similar wheel at a run's temperature; along the run's own else."""
        curves = [run.curve]
        if self.knows_yield_around(run):
            curves = [c if run is self.reference else _similar(c, run) for c in self.around]
        return [first_yield(curve, run.yield_strength) for curve in curves]

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


def _similar(curve: StiffnessCurve, run: EnvironmentRun) -> StiffnessCurve:
    """What a curve at 20 C becomes for the similar wheel at a run's temperature; see docs/theory.md 2.6."""
    assert run.thermal_strain is not None
    assert run.modulus_ratio is not None
    theta, modulus = 1.0 + run.thermal_strain, run.modulus_ratio
    stresses = {name: modulus * values for name, values in curve.columns.items() if name.endswith("_Pa")}
    return replace(curve, deflection=theta * curve.deflection, load=theta**2 * modulus * curve.load, columns=stresses)


def plain_words(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "_", name)
