"""Question: largest stress against yield along every curve, and the load at first yield.

Verified by tests/unit/test_workbench_yielding.py, tests/unit/test_workbench_checks.py and
tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.questions.strength.figures import strength_figures
from workbench.questions.strength.yielding import (
    StrengthResults,
    first_yield,
    smallest_yield_load,
    utilisation,
    yield_strengths,
)
from workbench.study.full import around
from workbench.study.model import LARGEST_WHEEL_LOAD, Study
from workbench.verdict.rules import Claim, at_least, at_most

__all__ = ["STRENGTH", "yield_check"]


def yield_check(fe: ModelCurves, yield_strength: Mapping[str, float], up_to: float) -> Check:
    """Largest von Mises stress over yield strength in any part, up to a load [N]."""

    def largest() -> float:
        lowest = min(float(curve.load.max()) for curve in fe.by_orientation.values())
        if lowest < up_to:
            rule = f"does not reach {up_to:g} N at every orientation"
            raise InputError("load", f"{lowest:g} N", rule, "raise fe.max_deflection or fe.max_load")
        return max(
            _largest_up_to(curve, f"max_von_mises_{part}_Pa", up_to) / strength
            for curve in fe.by_orientation.values()
            for part, strength in yield_strength.items()
            if f"max_von_mises_{part}_Pa" in curve.columns
        )

    claim = Claim(
        id="fe.yield",
        title=f"FE: largest von Mises stress over yield strength up to {up_to:g} N",
        quantity="stress / yield",
        unit="-",
        role="finding",
        source="yield strengths of the study's materials",
    )
    return at_most(claim, largest, 1.0)


def _largest_up_to(curve: StiffnessCurve, column: str, load: float) -> float:
    inside = curve.load <= load
    inside[: min(int(inside.sum()) + 1, len(inside))] = True
    return float(curve.columns[column][inside].max())


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
    )


def _checks(study: Study, results: StrengthResults) -> list[Check]:
    up_to = study.judged_load
    which = "fe.max_load" if up_to < LARGEST_WHEEL_LOAD else "the upper wheel load of the thesis' sweep"
    claim = Claim(
        id="fe.first_yield_load",
        title="FE: smallest load of any orientation at which a part begins to yield (or where the curve ends)",
        quantity="load",
        unit="N",
        role="finding",
        source=f"yield strengths of the study's materials; {up_to:g} N is {which}",
    )

    def smallest() -> float:
        if results.missing:
            raise InputError("curve", f"{results.missing[0]:g} deg", "is missing", "see its run's message")
        return smallest_yield_load(list(results.by_orientation.values()), up_to)

    return [yield_check(results.fe, yield_strengths(study), up_to), at_least(claim, smallest, up_to)]


STRENGTH: Question = Question(
    name="strength", title="Strength", group="Wheel", read=_read, checks=_checks, figures=strength_figures
)
