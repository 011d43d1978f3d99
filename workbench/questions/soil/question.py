"""Question: what the wheel does on soil, and how far the soil's laws carry.

Verified by tests/unit/test_workbench_soil.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from contracts.records import Check
from workbench.questions.kept import OF_ANOTHER
from workbench.questions.question import Question
from workbench.questions.soil.climb import STUCK, Climbs
from workbench.questions.soil.figures import soil_figures
from workbench.questions.soil.graph import soil_tasks
from workbench.questions.soil.measured import QUANTITIES
from workbench.questions.soil.results import REQUIRED_SLOPE, OnSoil, read_on_soil
from workbench.study.model import Study
from workbench.study.off_soil import without_soil
from workbench.verdict.rules import Claim, at_least, at_most, undecided

__all__ = ["SOIL"]

_LIMITS = {"pull": 0.30, "torque": 0.15, "sinkage": 0.30}
"""Median errors that the laws are asked to keep to at the published test [-]."""
_TEST = "Ding et al. (2011), a smooth rigid wheel under 80 N; no number is fitted to these points"
_MISSION = "mission requirements, Samarini 2020, section 1: slopes of 25 degrees; on soil by one wheel's largest pull"


def _checks(study: Study, results: OnSoil) -> Sequence[Check]:
    found = [_held(results, number) for number in range(len(QUANTITIES))]
    if "ancf_wheel" in results.at_rest.curves:
        found.append(_models(study, results))
    found += [_bench(study, results, number) for number in (0, 1)]
    found += [_climbs(results, number) for number in range(len(results.benches))]
    if results.climbs is None:
        return found
    rover = [_rover(climbs) for climbs in results.climbs.best.values()]
    return [*found, *([undecided(one, OF_ANOTHER) for one in rover] if results.climbs.state == "stale" else rover)]


def _held(results: OnSoil, number: int) -> Check:
    quantity = QUANTITIES[number]
    claim = Claim(
        id=f"soil.measured_{quantity}",
        title=f"Laws of soil against a published single-wheel test: {quantity}",
        quantity="median relative error",
        unit="-",
        role="finding",
        source=_TEST,
    )
    return at_most(claim, lambda: results.held.refinements[-1].errors[number], _LIMITS[quantity])


def _models(study: Study, results: OnSoil) -> Check:
    claim = Claim(
        id="soil.ancf_wheel",
        title="Wheel at rest on soil: load by plates against that by the solid model",
        quantity="largest difference of load",
        unit="-",
        role="gate",
        source=f"solid model on {results.benches[0].soil}, {results.at_rest.orientation_deg:g} deg; the limit is ours",
    )
    return at_most(claim, results.at_rest.apart, study.tolerances.soil_models)


def _bench(study: Study, results: OnSoil, number: int) -> Check:
    name, words = (("drop", "way of the hub"), ("sinkage", "sinkage"))[number]
    claim = Claim(
        id=f"soil.bench_{name}",
        title=f"Wheel at rest on soil: {words} by the rim's compliance against that by the solid model",
        quantity="difference",
        unit="-",
        role="finding",
        source=f"solid model on {results.benches[0].soil}; the limit is ours",
    )
    return at_most(claim, lambda: abs(results.at_rest.bench_apart()[number]), study.tolerances.soil_bench)


def _climbs(results: OnSoil, number: int) -> Check:
    bench = results.benches[number]
    claim = Claim(
        id=f"soil.slope_{bench.soil}",
        title=f"Slope that the wheel's pull climbs on {bench.soil}",
        quantity="slope",
        unit="deg",
        role="finding",
        source=_MISSION,
    )
    return at_least(claim, lambda: math.degrees(results.slope(bench)), math.degrees(REQUIRED_SLOPE))


def _rover(climbs: Climbs) -> Check:
    claim = Claim(
        id=f"soil.rover_{climbs.soil}",
        title=f"Slope that the rover climbs on {climbs.soil} with a slip below {STUCK:g}",
        quantity="slope",
        unit="deg",
        role="finding",
        source=f"mission requirements, Samarini 2020, section 1: slopes of 25 degrees; on tire {climbs.tire}",
    )
    check = at_least(claim, lambda: climbs.steepest, math.degrees(REQUIRED_SLOPE))
    return undecided(check, "no steeper slope was driven") if check.status == "fail" and climbs.all_climbed else check


SOIL = Question(
    name="soil",
    title="On soil",
    group="Wheel",
    tasks=soil_tasks,
    read=read_on_soil,
    checks=_checks,
    figures=lambda study, results: soil_figures(results.benches, results.held),
    applies=lambda study: study.soil is not None and without_soil(study) is None,
    budget=340,
)
