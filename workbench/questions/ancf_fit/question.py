"""Question: ANCF tires fitted to the FE curves, beside the study's own.

Verified by tests/unit/test_workbench_ancf_fit.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.ancf_fit.figures import fit_figures
from workbench.questions.ancf_fit.fit import FittedTire, read_fit
from workbench.questions.ancf_fit.graph import AS_IT_IS, fit_name, fit_tasks
from workbench.questions.ancf_fit.results import AncfFits
from workbench.questions.model_curves import model_curves
from workbench.questions.question import Question
from workbench.study.full import around, rotational_period
from workbench.study.model import Study, stated
from workbench.verdict.rules import Claim, at_most

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.records import Fitted

__all__ = ["ANCF_FIT"]


def _read(study: Study, folders: Mapping[str, Path]) -> AncfFits:
    from workbench.questions.ancf_fit.records import Fitted, Held

    section = stated(study.ancf_fit, "ancf_fit")
    fe, period, kept = model_curves("fe", folders, around(study)), rotational_period(study), section.kept.name
    try:
        own = read_fit("own", folders[AS_IT_IS], Held, around(study))
        fitted = tuple(
            read_fit(tire.name, folders[fit_name(tire.name)], Fitted, around(study)) for tire in section.tires
        )
    except InputError as error:
        return AncfFits(own=None, fitted=(), kept=kept, fe=fe, period=period, failure=error)
    return AncfFits(own=own, fitted=fitted, kept=kept, fe=fe, period=period)


def _checks(study: Study, fits: AncfFits) -> Sequence[Check]:
    return [_check(tire, study.tolerances.ancf_fit) for tire in fits.fitted]


def _check(tire: FittedTire[Fitted], limit: float) -> Check:
    preset, (low, high) = tire.numbers.preset, tire.numbers.load_range_N
    mesh = f"{preset.spokes} spokes, {preset.circumferential_plates} rim plates"
    claim = Claim(
        id=f"ancf_fit.{tire.name}",
        title=f"Fitted ANCF tire ({mesh}) against the FE average, {low:.0f} to {high:.0f} N",
        quantity="difference",
        unit="-",
        role="finding",
        source="our own continuum model; largest difference over its load at equal deflection",
    )
    return at_most(claim, lambda: abs(tire.numbers.average.largest), limit)


def _curves(study: Study, fits: AncfFits) -> Sequence[StiffnessCurve]:
    return [curve for tire in fits.fitted for curve in (*tire.curves.values(), tire.average)]


ANCF_FIT = Question(
    name="ancf_fit",
    title="Fit of the ANCF tire",
    group="ANCF tire",
    tasks=fit_tasks,
    read=_read,
    checks=_checks,
    figures=fit_figures,
    curves=_curves,
    applies=lambda study: study.ancf_fit is not None,
    budget=990,
)
