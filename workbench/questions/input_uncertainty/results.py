"""Samples beside the solid model: each curve corrected by it, the band they make, and what moves it.

Every sample is computed by the section model. Its load at a deflection is multiplied by the solid average's over that
of the section model, both of the wheel as it is: what the section model leaves out is taken to be the same part of
every sample's load. Verified by tests/unit/test_workbench_input_uncertainty.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.input_uncertainty.samples import Samples
from workbench.questions.input_uncertainty.statistics import (
    at_most_of_all,
    percentiles,
    rank_correlations,
    told_apart,
)

__all__ = ["Output", "Sampled", "corrected", "solid_over_section"]

Array = NDArray[np.float64]
_STEP = 0.5e-3
"""Of the corrected curves [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """One number of every sample.

    Attributes
    ----------
    name : as in a table
    unit : SI
    nominal : of the wheel as it is
    values : (n,) float, not a number where a sample does not reach it
    rank : (inputs,) rank correlation with each input
    """

    name: str
    unit: str
    nominal: float
    values: Array
    rank: Array

    @property
    def band(self) -> tuple[float, float, float]:
        """5th, 50th and 95th percentile of the samples that reach it."""
        low, middle, high = percentiles(self.values)
        return float(low), float(middle), float(high)

    @property
    def beyond(self) -> bool:
        """Whether the wheel as it is lies outside the 5th to 95th percentile of the samples."""
        low, _, high = self.band
        return not low <= self.nominal <= high

    @property
    def missing(self) -> int:
        """Samples that do not reach it."""
        return int(np.isnan(self.values).sum())

    @property
    def limit(self) -> float:
        """Magnitude at which a rank correlation is told from none."""
        return told_apart(len(self.values) - self.missing)


def solid_over_section(solid: StiffnessCurve, section: StiffnessCurve, at: Array) -> Array:
    """Load of the solid average over that of the section model at deflections (m,) [m], both of the wheel as it is [-].

    Beyond the end of either, and before the first step, it stays what it is there.
    """
    end = min(solid.deflection[-1], section.deflection[-1])
    within = np.clip(at, min(_STEP, end), end)
    loads = section.load_at(within)
    if not (loads > 0.0).all():
        raise InputError("section model", "no load", "behind first touch", "see its curve")
    return np.asarray(solid.load_at(within) / loads)


def corrected(samples: Samples, solid: StiffnessCurve) -> tuple[Array, StiffnessCurve, list[StiffnessCurve | None]]:
    """Deflections [m], curve of the wheel as it is, and one for each sample; None where it has less than two points."""
    at = np.append(np.arange(0.0, samples.deflection[-1] - 1e-12, _STEP), samples.deflection[-1])
    section = _curve(samples.deflection, samples.nominal_load)
    if section is None:
        raise InputError("the wheel as it is", "no curve", "in the record", "make it anew")
    ratio = solid_over_section(solid, section, at)

    def scaled(curve: StiffnessCurve | None) -> StiffnessCurve | None:
        if curve is None:
            return None
        reached = at <= curve.deflection[-1] + 1e-12
        within = np.minimum(at[reached], curve.deflection[-1])
        return _curve(at[reached], np.asarray(curve.load_at(within)) * ratio[reached])

    nominal = scaled(section)
    assert nominal is not None
    return at, nominal, [scaled(_curve(samples.deflection, load)) for load in samples.load]


def _curve(deflection: Array, load: Array) -> StiffnessCurve | None:
    there = np.isfinite(load)
    if there.sum() < 2:
        return None
    return StiffnessCurve(
        model="input_uncertainty", orientation_deg=None, deflection=deflection[there], load=load[there]
    )


@dataclass(frozen=True, kw_only=True)
class Sampled:
    """Samples with the corrected curves.

    Attributes
    ----------
    samples : as kept
    solid : average of the solid model, weighted by arc
    solid_stress, solid_used : largest judged stress [Pa], and over yield strength [-], of its orientations at the
        judged load; None where they do not reach it
    up_to : range of the initial tangent [m]
    deflections, loads : where load [m] and deflection [N] are read
    judged_load : where stress is read [N]
    """

    samples: Samples
    solid: StiffnessCurve
    solid_stress: float | None
    solid_used: float | None
    up_to: float
    deflections: Sequence[float]
    loads: Sequence[float]
    judged_load: float

    @cached_property
    def _corrected(self) -> tuple[Array, StiffnessCurve, list[StiffnessCurve | None]]:
        return corrected(self.samples, self.solid)

    @property
    def count(self) -> int:
        """Samples drawn."""
        return len(self.samples.values)

    @cached_property
    def outputs(self) -> tuple[Output, ...]:
        """Slope, loads, deflections, stress, in the table's order."""
        found = [self._read("initial slope", "N/m", lambda c: c.initial_tangent(self.up_to))]
        for d in self.deflections:
            found.append(self._read(f"load at {1e3 * d:g} mm", "N", lambda c, d=d: float(c.load_at(d))))  # type: ignore[misc]
        for f in self.loads:
            found.append(self._read(f"deflection at {f:g} N", "m", lambda c, f=f: c.deflection_at(f)))  # type: ignore[misc]
        own, stress, used = self.samples, self.stress_factor, self.used_factor
        found.append(
            self._output(
                f"largest stress at {self.judged_load:g} N", "Pa", stress * own.nominal_stress, stress * own.stress
            )
        )
        name = f"largest stress over yield strength up to {self.judged_load:g} N"
        return (*found, self._output(name, "-", used * own.nominal_used, used * own.used))

    def _read(self, name: str, unit: str, read: Callable[[StiffnessCurve], float]) -> Output:
        _, nominal, curves = self._corrected
        return self._output(name, unit, _or_nan(nominal, read), np.array([_or_nan(c, read) for c in curves]))

    def _output(self, name: str, unit: str, nominal: float, values: Array) -> Output:
        rank = rank_correlations(self.samples.values, values)
        return Output(name=name, unit=unit, nominal=nominal, values=values, rank=rank)

    @property
    def stress_factor(self) -> float:
        """Largest stress, solid over section model, both of the wheel as it is [-]; 1 where it is not known."""
        return self.solid_stress / self.samples.nominal_stress if self.solid_stress else 1.0

    @property
    def used_factor(self) -> float:
        """The same of the largest stress over yield strength."""
        return self.solid_used / self.samples.nominal_used if self.solid_used else 1.0

    @property
    def yielding(self) -> float:
        """Share of the samples that reach the judged load of which a part yields below it [-]."""
        used = self.outputs[-1].values
        reached = used[np.isfinite(used)]
        return float(np.mean(reached >= 1.0)) if len(reached) else math.nan

    @property
    def yielding_at_most(self) -> float:
        """Share of all such wheels that yield below the judged load at most, with 95 % confidence [-]."""
        used = self.outputs[-1].values
        return at_most_of_all(int((used >= 1.0).sum()), int(np.isfinite(used).sum()))

    @cached_property
    def band(self) -> StiffnessCurve:
        """Curve of the wheel as it is with the samples' percentiles, as far as every sample with a curve comes.

        Raises
        ------
        InputError
            If no sample has a curve.
        """
        at, nominal, curves = self._corrected
        there = [c for c in curves if c is not None]
        if not there:
            raise InputError("samples", f"{self.count}", "have no curve", "see the record's notes")
        end = min(nominal.deflection[-1], *(c.deflection[-1] for c in there))
        within = at[at <= end + 1e-12]
        low, middle, high = percentiles(np.array([c.load_at(within) for c in there]))
        return StiffnessCurve(
            model="input_uncertainty",
            orientation_deg=None,
            deflection=within,
            load=np.asarray(nominal.load_at(within)),
            columns={"load_p5_N": low, "load_p50_N": middle, "load_p95_N": high},
            source=f"wheel as it is, and percentiles of {len(there)} samples; section model, corrected by the solid",
        )

    def half_width(self, deflection: float) -> float:
        """Half the distance of the 5th and 95th percentile of the load at a deflection [m] over the samples' mean [-].

        Raises
        ------
        InputError
            If a sample ends before.
        """
        _, _, curves = self._corrected
        loads = np.array([float(c.load_at(deflection)) for c in curves if c is not None])
        if not len(loads):
            raise InputError("samples", f"{self.count}", "have no curve", "see the record's notes")
        low, high = percentiles(loads, (5.0, 95.0))
        return float(0.5 * (high - low) / loads.mean())


def _or_nan(curve: StiffnessCurve | None, read: Callable[[StiffnessCurve], float]) -> float:
    with suppress(InputError):
        return math.nan if curve is None else read(curve)
    return math.nan
