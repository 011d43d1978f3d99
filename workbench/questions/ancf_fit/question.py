"""Question: ANCF tires fitted to the FE curves, beside the study's own.

Verified by tests/unit/test_workbench_ancf_fit.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.ancf_fit.figures import fit_figures
from workbench.questions.ancf_fit.fit import FittedTire, read_fit
from workbench.questions.ancf_fit.graph import AS_IT_IS, fit_name, fit_tasks
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.study.full import rotational_period
from workbench.study.model import Study, stated
from workbench.verdict.rules import Claim, at_most

if TYPE_CHECKING:
    from workbench.questions.ancf_fit.records import Fitted, Held

__all__ = ["ANCF_FIT", "AncfFits"]


@dataclass(frozen=True, slots=True, kw_only=True)
class AncfFits:
    """The study's own tire, the fitted ones, and what they are held against.

    Attributes
    ----------
    own : the tire of [ancf] as it is; None without result
    fitted : those of [ancf_fit], in their order; none without result
    kept : name of the one that ``workbench calibrate ancf`` writes into a study
    fe : the continuum curves
    period : turn after which the FE wheel repeats itself [deg]
    failure : why there is no result, else None
    """

    own: FittedTire[Held] | None
    fitted: tuple[FittedTire[Fitted], ...]
    kept: str
    fe: ModelCurves
    period: float
    failure: InputError | None = None

    @property
    def best(self) -> FittedTire[Fitted]:
        """The one that is kept; raises the reason if there is no result."""
        if self.failure is not None:
            raise self.failure
        return next(tire for tire in self.fitted if tire.name == self.kept)

    @property
    def all(self) -> tuple[FittedTire[Held], ...]:
        """The study's own tire, then the fitted ones."""
        return self.fitted if self.own is None else (self.own, *self.fitted)

    @property
    def periods(self) -> Mapping[str, float]:
        """Turn after which each tire repeats itself [deg]: 360 deg over its spokes."""
        return {tire.name: 360.0 / tire.numbers.preset.spokes for tire in self.all}

    @property
    def half_period(self) -> float | None:
        """How far the FE curves at 0 and half a period differ [-]: rms over load; None where there are not both."""
        pair = [self.fe.loaded.get(o) for o in (0.0, 0.5 * self.period)]
        return _difference(pair[0], pair[1]) if pair[0] is not None and pair[1] is not None else None


def _difference(one: StiffnessCurve, other: StiffnessCurve) -> float:
    """Root mean square of the difference of two curves over that of their mean, where both have points [-]."""
    d = np.linspace(max(one.deflection[0], other.deflection[0]), min(one.deflection[-1], other.deflection[-1]), 101)
    a, b = one.load_at(d), other.load_at(d)
    return float(np.linalg.norm(a - b) / np.linalg.norm(0.5 * (a + b)))


def _read(study: Study, folders: Mapping[str, Path]) -> AncfFits:
    from workbench.questions.ancf_fit.records import Fitted, Held

    section = stated(study.ancf_fit, "ancf_fit")
    fe, period, kept = model_curves("fe", folders), rotational_period(study), section.kept.name
    try:
        own = read_fit("own", folders[AS_IT_IS], Held)
        fitted = tuple(read_fit(tire.name, folders[fit_name(tire.name)], Fitted) for tire in section.tires)
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
)
