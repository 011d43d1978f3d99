"""Which reduced model may stand in for the wheel, how surely, and in which range of loads.

One limit for all: `model_agreement` of the study, of the average and of each orientation.

Verified by tests/unit/test_workbench_answers.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from workbench.questions.ancf_fit.question import ANCF_FIT
from workbench.questions.ancf_wheel.question import ANCF_WHEEL
from workbench.questions.comparison import Comparison
from workbench.questions.models.agreement import Agreement, verdict
from workbench.questions.models.metrics import compare_curves
from workbench.questions.models.question import MODELS
from workbench.questions.models.results import ComparedModels
from workbench.questions.section.question import SECTION
from workbench.study.model import LARGEST_WHEEL_LOAD
from workbench.verdict.decision import Decision, together

__all__ = ["StandIn", "range_within", "stand_ins"]

_DECISIONS: dict[str, Decision] = {"agrees": "yes", "no difference": "yes", "differs": "no"}
_SAMPLES = 501


@dataclass(frozen=True, slots=True, kw_only=True)
class StandIn:
    """One model beside the continuum.

    Attributes
    ----------
    key : as on the command line, ``"brush"``, ``"ancf_fit:six_spokes"``
    name, section : what it is called, and where the report tells more
    found : its average against the continuum's, over the loads of the thesis' sweep and below
    worst : largest relative L2 difference at a single orientation that both have [-]; None if there is none
    loads : range of loads in which the averages differ by no more than the limit [N]; None if there is none
    """

    key: str
    name: str
    section: str
    found: Agreement
    worst: float | None
    loads: tuple[float, float] | None

    @property
    def on_average(self) -> Decision:
        """Whether its average stands for the wheel's."""
        return _DECISIONS.get(self.found.verdict, "undecided")

    @property
    def decision(self) -> Decision:
        """Whether it may stand in for the wheel: on average, and at every orientation that both have."""
        if self.worst is None:
            return self.on_average
        single = verdict(self.worst, self.found.uncertainty, self.found.limit)
        return together((self.on_average, _DECISIONS.get(single, "undecided")))

    @property
    def tone(self) -> str:
        """Class of the colour."""
        return {"yes": "pass", "no": "fail", "undecided": "error"}[self.decision]

    @property
    def range(self) -> str:
        """Loads at which the averages agree, in words."""
        limit = f"{100.0 * self.found.limit:g} %"
        if self.loads is None:
            return f"within {limit} nowhere"
        low, high = self.loads
        return f"within {limit} {f'up to {high:.0f} N' if low < 1.0 else f'from {low:.0f} to {high:.0f} N'}"

    @property
    def words(self) -> str:
        """The range, and the worst orientation."""
        return self.range + ("" if self.worst is None else f"; {100.0 * self.worst:.1f} % at the worst orientation")

    @property
    def full(self) -> float:
        """Right end of the drawn scale [-]."""
        return max(1.6 * self.found.limit, 1.15 * (self.found.distance + (self.found.uncertainty or 0.0)))

    def at(self, value: float) -> float:
        """Place on the drawn scale [%]."""
        return 100.0 * min(max(value / self.full, 0.0), 1.0)


def stand_ins(found: Comparison) -> list[StandIn]:
    """The thesis' tires, section model, ANCF wheel, fitted tires: those the study has that share a range."""
    models = found.answers[MODELS.name]
    assert isinstance(models, ComparedModels)
    judged = []
    if models.ancf is not None and "ancf_average" in models.metrics:
        judged.append(
            _stand_in(models, ("ancf", "ANCF tire", "models"), models.ancf.average, models.ancf.by_orientation)
        )
    if models.brush is not None and "brush" in models.metrics:
        line = dict.fromkeys(models.continuum.fe.loaded, models.brush)
        judged.append(_stand_in(models, ("brush", "Brush tire", "models"), models.brush, line))
    if (runs := found.answers.get(SECTION.name)) is not None:
        section = runs.section
        judged.append(
            _stand_in(models, ("section", "Section model", "section"), section.average, section.by_orientation)
        )
    if (runs := found.answers.get(ANCF_WHEEL.name)) is not None:
        wheel = runs.ancf
        named = "ancf_wheel", "ANCF wheel", "ancf_wheel"
        judged.append(_stand_in(models, named, wheel.average, wheel.by_orientation))
    fits = found.answers.get(ANCF_FIT.name)
    for tire in () if fits is None else fits.fitted:
        words = f"fitted ANCF tire ({tire.name.replace('_', ' ')})"
        judged.append(_stand_in(models, (f"ancf_fit:{tire.name}", words, "ancf_fit"), tire.average, tire.curves))
    return [one for one in judged if one is not None]


def _stand_in(
    models: ComparedModels,
    named: tuple[str, str, str],
    average: StiffnessCurve,
    curves: Mapping[float, StiffnessCurve],
) -> StandIn | None:
    key, name, section = named
    fe, mesh = models.continuum.fe, models.continuum.mesh_study
    try:
        numbers = compare_curves(average, fe.average, LARGEST_WHEEL_LOAD)
    except InputError:
        return None
    try:
        uncertainty = None if mesh is None else mesh.l2_uncertainty(fe.average, numbers.start, numbers.end)
    except InputError:
        uncertainty = None
    found = Agreement(
        pair=key,
        distance=numbers.relative_l2,
        uncertainty=uncertainty,
        limit=models.limit,
        verdict=verdict(numbers.relative_l2, uncertainty, models.limit),
    )
    pairs = [(curves[o], curve) for o, curve in fe.loaded.items() if o in curves and not curves[o].unloaded]
    worst = [_distance(one, other) for one, other in pairs]
    return StandIn(
        key=key,
        name=name,
        section=section,
        found=found,
        worst=max((d for d in worst if d is not None), default=None),
        loads=range_within(average, fe.average, models.limit),
    )


def _distance(curve: StiffnessCurve, other: StiffnessCurve) -> float | None:
    try:
        return compare_curves(curve, other, LARGEST_WHEEL_LOAD).relative_l2
    except InputError:
        return None


def range_within(curve: StiffnessCurve, reference: StiffnessCurve, limit: float) -> tuple[float, float] | None:
    """Widest range of the reference's loads in which |F/F_ref - 1| <= limit all the way [N], up to 250 N.

    None if there is none.
    """
    end = min(curve.deflection[-1], reference.deflection[-1])
    at = np.linspace(0.0, end, _SAMPLES)[1:]
    loads = reference.load_at(at)
    at, loads = at[(loads > 0.0) & (loads <= LARGEST_WHEEL_LOAD)], loads[(loads > 0.0) & (loads <= LARGEST_WHEEL_LOAD)]
    within = np.abs(curve.load_at(at) / loads - 1.0) <= limit
    edges = np.flatnonzero(np.diff(np.concatenate([[False], within, [False]])))
    spans = [(float(loads[a]), float(loads[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    if not spans:
        return None
    low, high = max(spans, key=lambda span: span[1] - span[0])
    return (0.0 if low == loads[0] else low, high)
