"""Question: the planar section model beside the solid one. Verified by tests/unit/test_workbench_section.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves, RunNumbers, mean_curve, model_curves
from workbench.questions.question import Question
from workbench.questions.section.figures import section_figures
from workbench.questions.section.graph import section_tasks, without_planar_model
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most

__all__ = ["SECTION", "SectionRow", "SectionRuns", "largest_difference", "section_checks"]

_SMALLEST_LOAD = 5.0
_SOURCE = "our own solid model; a planar one leaves out the rim's bending along the axle"


def section_checks(section: ModelCurves, fe: ModelCurves, tolerances: ToleranceSection) -> list[Check]:
    """Each orientation and the average: largest difference of load along the curve, relative to the solid model's."""
    solid = fe.by_orientation
    pairs = {orientation_name("vs_solid", o): (curve, solid.get(o)) for o, curve in section.by_orientation.items()}
    pairs["agreement"] = _averages(section, fe)
    return [
        at_most(
            Claim(
                id=f"section.{name}",
                title=f"Section model against the solid one, {_where(curve)}: largest difference along the curve",
                quantity="difference",
                unit="-",
                role="finding",
                source=_SOURCE,
            ),
            partial(largest_difference, curve, other),
            tolerances.section_agreement,
        )
        for name, (curve, other) in pairs.items()
    ]


def _averages(section: ModelCurves, fe: ModelCurves) -> tuple[StiffnessCurve, StiffnessCurve]:
    """Both averages; where a model misses an orientation, over those that neither misses."""
    both = [o for o in section.loaded if o in fe.loaded]
    if not (both and (section.missing or fe.missing)):
        return section.average, fe.average
    of_section, of_solid = (mean_curve([model.by_orientation[o] for o in both]) for model in (section, fe))
    return of_section, of_solid


def largest_difference(curve: StiffnessCurve, solid: StiffnessCurve | None) -> float:
    """Largest |F - F_solid| / max(F_solid, 5 N) at the solid curve's points that both reach [-]."""
    if solid is None:
        raise InputError("solid curve", "none", "is needed at the same orientation", "add it to fe.orientations")
    common = (solid.deflection <= curve.deflection[-1] + 1e-12) & (solid.load > 0.0)
    if not common.any():
        raise InputError("curves", "section, fe", "share no point with a load", "compute the curves further")
    loads = solid.load[common]
    difference = np.abs(curve.load_at(np.minimum(solid.deflection[common], curve.deflection[-1])) - loads)
    return float((difference / np.maximum(loads, _SMALLEST_LOAD)).max())


def _where(curve: StiffnessCurve) -> str:
    return "average" if curve.orientation_deg is None else f"{curve.orientation_deg:g} deg"


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRow:
    """One orientation in the table: runs of both models, largest difference of their curves [-].

    The difference is None where a partial curve leaves no common point.
    """

    orientation: float
    section: RunNumbers
    fe: RunNumbers
    difference: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRuns:
    """Curves of the planar and of the solid model."""

    section: ModelCurves
    fe: ModelCurves

    @property
    def rows(self) -> list[SectionRow]:
        """Orientations that both models have."""
        solid = self.fe.by_orientation
        return [
            SectionRow(
                orientation=o, section=self.section.runs[o], fe=self.fe.runs[o], difference=_difference(curve, solid[o])
            )
            for o, curve in self.section.by_orientation.items()
            if o in solid
        ]


def _difference(curve: StiffnessCurve, solid: StiffnessCurve) -> float | None:
    try:
        return largest_difference(curve, solid)
    except InputError:
        return None


def _read(study: Study, folders: Mapping[str, Path]) -> SectionRuns:
    return SectionRuns(section=model_curves("section", folders), fe=model_curves("fe", folders))


def _checks(study: Study, runs: SectionRuns) -> Sequence[Check]:
    return section_checks(runs.section, runs.fe, study.tolerances)


def _curves(study: Study, runs: SectionRuns) -> Sequence[StiffnessCurve]:
    return [*runs.section.by_orientation.values(), runs.section.average]


SECTION = Question(
    name="section",
    title="Section model",
    group="Wheel",
    tasks=section_tasks,
    read=_read,
    checks=_checks,
    figures=section_figures,
    curves=_curves,
    applies=lambda study: without_planar_model(study) is None,
)
