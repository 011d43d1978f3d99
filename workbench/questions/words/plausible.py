"""The plausible set: wheels that satisfy the statements, as the search of studies/words_search.toml found them.

``plausible.json`` and studies/words_search.csv are written by ``make search`` (`keeping`).
Verified by tests/unit/test_workbench_plausible.py and tests/verification/test_plausible_wheels.py.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.execution.task import task_keys
from workbench.questions.section.graph import section_tasks
from workbench.study.sweep import Value
from workbench.study.sweep_points import Point, study_point

__all__ = ["RECORD", "SHOWN", "STRESS", "TWIN_SPREAD", "Plausible", "PlausibleWheel", "plausible", "record_key"]

RECORD = Path(__file__).parent / "plausible.json"
SHOWN = 5
"""Wheels drawn side by side."""
STRESS = "max_linearised_at_250N_Pa"
"""Number by which the wheels are ordered."""
TWIN_SPREAD = "twin_spread_at_20mm"
"""Of the wheel with all springs in phase."""

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlausibleWheel:
    """One wheel of the set.

    Attributes
    ----------
    point : number in the table
    values : parameters of the search, as in a study file
    misses : of each aim or group [-]; 1 or less is good
    chosen : group -> alternative that is met best, ``tire`` -> ``hub55_centres``
    numbers : columns of the table [SI]
    deflection : (n,) float [m]
    orientation_deg : (m,) float [deg]
    load : (m, n) float [N], NaN beyond a curve's end
    average : (n,) float [N], weighted by arc, NaN where not every orientation reaches
    """

    point: int
    values: Mapping[str, Value]
    misses: Mapping[str, float]
    chosen: Mapping[str, str]
    numbers: Mapping[str, float]
    deflection: Array
    orientation_deg: Array
    load: Array
    average: Array

    @property
    def stress(self) -> float:
        """Largest linearised stress at the largest load of the thesis' sweep [Pa]; infinite where it is not reached."""
        return float(self.numbers.get(STRESS, np.inf))


@dataclass(frozen=True, slots=True, kw_only=True)
class Plausible:
    """What the search found.

    Attributes
    ----------
    study : content of the search's study file without [sweep]
    searched, confirmed : number of points, and of those that ran again at every orientation
    empty : whether no wheel satisfies every statement; then ``wheels`` are those that miss least
    strength : yield strength that statement 5 asks for [Pa]: the alloy solution treated and aged
    annealed : how many wheels satisfy it with the alloy annealed
    wheels : in order of stress
    stale : whether sources have changed since they were computed
    """

    study: Mapping[str, Any]
    searched: int
    confirmed: int
    empty: bool
    strength: float
    annealed: int
    wheels: tuple[PlausibleWheel, ...]
    stale: bool

    @property
    def shown(self) -> tuple[PlausibleWheel, ...]:
        """Five of them, from the least stress to the largest."""
        count = min(SHOWN, len(self.wheels))
        return tuple(self.wheels[round(i)] for i in np.linspace(0, len(self.wheels) - 1, count))

    def point(self, wheel: PlausibleWheel) -> Point:
        """A wheel as a whole study."""
        return _point(self.study, wheel.point, wheel.values)

    @property
    def band(self) -> StiffnessCurve:
        """Mean of the averages, between what the averages and what all orientations of the set span.

        Columns ``load_low_N`` and ``load_high_N`` (averages), ``load_low_any_N`` and ``load_high_any_N``
        (orientations); as far as every wheel's average reaches.
        """
        at = self.wheels[0].deflection
        averages = np.array([wheel.average for wheel in self.wheels])
        reached = np.isfinite(averages).all(axis=0)
        every = np.concatenate([wheel.load for wheel in self.wheels])[:, reached]
        columns = {
            "load_low_N": averages[:, reached].min(axis=0),
            "load_high_N": averages[:, reached].max(axis=0),
            "load_low_any_N": every.min(axis=0),
            "load_high_any_N": every.max(axis=0),
        }
        return StiffnessCurve(
            model="words_band",
            orientation_deg=None,
            deflection=np.append(0.0, at[reached]),
            load=np.append(0.0, averages[:, reached].mean(axis=0)),
            columns={name: np.append(0.0, values) for name, values in columns.items()},
            source=f"{len(self.wheels)} wheels of the search for what the thesis' words allow, section model",
        )

    def outside(self, curve: StiffnessCurve) -> float:
        """By how much a curve leaves the band of the averages, largest |F/F_edge - 1|, 0 within it [-]."""
        band = self.band
        within = (band.deflection > 0.0) & (band.deflection <= curve.deflection[-1])
        if not within.any():
            rule = f"ends before the band's first point, {1e3 * band.deflection[1]:g} mm"
            raise InputError("curve", f"{1e3 * curve.deflection[-1]:.3g} mm", rule, "compute it further")
        load = curve.load_at(band.deflection[within])
        low, high = (band.columns[f"load_{end}_N"][within] for end in ("low", "high"))
        return float(max(np.max(1.0 - load / low), np.max(load / high - 1.0), 0.0))


@cache
def plausible() -> Plausible:
    """The set as the package holds it."""
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    return Plausible(
        study=record["study"],
        searched=record["searched"],
        confirmed=record["confirmed"],
        empty=record["empty"],
        strength=record["strength"],
        annealed=record["annealed"],
        wheels=tuple(_wheel(one) for one in record["wheels"]),
        stale=record["key"] != record_key(record),
    )


def record_key(record: Mapping[str, Any]) -> str:
    """Key of a record: that of the section model's task of its first wheel, with all sources that it can reach."""
    first = record["wheels"][0]
    study = _point(record["study"], first["point"], first["values"]).study
    return next(iter(task_keys(tuple(section_tasks(study)[:1])).values()))


def _point(study: Mapping[str, Any], number: int, values: Mapping[str, Value]) -> Point:
    return study_point(RECORD, study, number, values)


def _wheel(record: Mapping[str, Any]) -> PlausibleWheel:
    return PlausibleWheel(
        point=record["point"],
        values=record["values"],
        misses=record["misses"],
        chosen=record["chosen"],
        numbers=record["numbers"],
        deflection=np.array(record["deflection_m"]),
        orientation_deg=np.array(record["orientation_deg"]),
        load=np.array(record["load_N"], dtype=np.float64),
        average=np.array(record["average_N"], dtype=np.float64),
    )
