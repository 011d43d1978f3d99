"""Question: largest stress against yield along every curve, and the load at first yield.

Verified by tests/unit/test_workbench_yielding.py, tests/unit/test_workbench_checks.py and
tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.mesh_study.question import mesh_study_of
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.questions.strength.figures import strength_figures
from workbench.questions.strength.yielding import (
    StrengthResults,
    first_yield,
    largest_utilisation,
    smallest_yield_load,
    utilisation,
)
from workbench.study.full import around
from workbench.study.model import LARGEST_WHEEL_LOAD, Study
from workbench.study.strengths import judges_strength, parts_without_strength, yield_strengths
from workbench.verdict.rules import Claim, at_least, at_most

__all__ = ["STRENGTH", "yield_check"]

_MEASURE = (
    "strips by their stress linearised through the thickness, one thickness from every joint and four from free edges"
)


def yield_check(
    fe: ModelCurves, yield_strength: Mapping[str, float], up_to: float, uncertainty: float | None = None
) -> Check:
    """Largest stress over yield strength in any part at any orientation, up to a load [N] that all of them reach.

    Undecided where the stress, so many times larger as its numerical ``uncertainty`` [-] allows, would pass the limit.
    """
    curves = fe.by_orientation.values()
    claim = Claim(
        id="fe.yield",
        title=f"FE: largest stress over yield strength up to {up_to:g} N",
        quantity="stress / yield",
        unit="-",
        role="finding",
        source=f"yield strengths of the study's materials; {_MEASURE}",
    )

    def check(allowed: float) -> Check:
        def largest() -> float:
            return max(largest_utilisation(curve, yield_strength, up_to, allowed) for curve in curves)

        return at_most(claim, largest, 1.0)

    return _noted(check, uncertainty)


def _noted(check: Callable[[float], Check], uncertainty: float | None) -> Check:
    """The check, with the uncertainty of the stress in its tolerance; undecided where that would turn it round."""
    found = check(1.0)
    if uncertainty is None or found.status == "error":
        return found
    factor = 1.0 / (1.0 + uncertainty) if found.status == "pass" else 1.0 + uncertainty
    decided = check(factor).status == found.status
    words = f"numerical uncertainty of the stress ±{100.0 * uncertainty:.2g} %"
    return replace(found, tolerance=f"{found.tolerance}; {words}", status=found.status if decided else "undecided")


def _read(study: Study, folders: Mapping[str, Path]) -> StrengthResults:
    fe = model_curves("fe", folders, around(study))
    curves = fe.loaded
    stressed = {
        part: s for part, s in yield_strengths(study).items() if any(utilisation(c, {part: s}) for c in curves.values())
    }
    by_part = {}
    for part, value in stressed.items():
        found = {o: first_yield(curve, {part: value}) for o, curve in curves.items()}
        weakest = min(found, key=lambda o: (found[o].part is None, found[o].load))
        by_part[part] = (weakest, found[weakest])
    return StrengthResults(
        fe=fe,
        yield_strength=stressed,
        by_orientation={o: first_yield(curve, stressed) for o, curve in curves.items()},
        by_part=by_part,
        uncertainty=_uncertainty(study, folders),
        unjudged=parts_without_strength(study),
    )


def _uncertainty(study: Study, folders: Mapping[str, Path]) -> float | None:
    """Of the stress, by the mesh study [-]; None without one, or where its meshes do not reach a common deflection."""
    found = mesh_study_of(study, folders)
    try:
        return None if found is None else found.stress_index(yield_strengths(study))
    except InputError:
        return None


def _checks(study: Study, results: StrengthResults) -> list[Check]:
    up_to = study.judged_load
    which = "fe.max_load" if up_to < LARGEST_WHEEL_LOAD else "the upper wheel load of the thesis' sweep"
    claim = Claim(
        id="fe.first_yield_load",
        title="FE: smallest load of any orientation at which a part begins to yield (or where the curve ends)",
        quantity="load",
        unit="N",
        role="finding",
        source=f"yield strengths of the study's materials; {up_to:g} N is {which}; {_MEASURE}",
    )

    strengths, uncertainty = yield_strengths(study), results.uncertainty

    def check(allowed: float) -> Check:
        def smallest() -> float:
            if results.missing:
                raise InputError("curve", f"{results.missing[0]:g} deg", "is missing", "see its run's message")
            found = [first_yield(curve, strengths, allowed) for curve in results.curves.values()]
            return smallest_yield_load(found, up_to)

        return at_least(claim, smallest, up_to)

    return [yield_check(results.fe, strengths, up_to, uncertainty), _noted(check, uncertainty)]


STRENGTH: Question = Question(
    name="strength",
    title="Strength",
    group="Wheel",
    read=_read,
    checks=_checks,
    figures=strength_figures,
    budget=740,
    applies=judges_strength,
)
