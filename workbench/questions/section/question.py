"""Question: the planar section model beside the solid one. Verified by tests/unit/test_workbench_section.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from contracts.curves import Around, StiffnessCurve
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves, mean_curve, model_curves
from workbench.questions.question import Question
from workbench.questions.section.figures import section_figures
from workbench.questions.section.graph import section_tasks, without_planar_model
from workbench.questions.section.results import SectionRuns, first_difference, largest_difference
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.sections import ToleranceSection
from workbench.verdict.rules import Claim, at_most

__all__ = ["SECTION", "section_checks"]

_SAME_WHEEL = 0.2
"""Largest difference [-] of the first loads that is one of modelling: six times that of the narrowest strips tried."""
_SOURCE = "our own solid model; a planar one leaves out the rim's bending along the axle"


def section_checks(
    section: ModelCurves, fe: ModelCurves, tolerances: ToleranceSection, around: Around | None = None
) -> list[Check]:
    """Each orientation and the average: largest difference of load along the curve, relative to the solid model's.

    The first load of the average is a gate: no other sees a wheel that is half as stiff as it should be.
    """
    solid = fe.by_orientation
    pairs = {orientation_name("vs_solid", o): (curve, solid.get(o)) for o, curve in section.by_orientation.items()}
    pairs["agreement"] = _averages(section, fe, around)
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
    ] + [
        at_most(
            Claim(
                id="section.first_load",
                title="Section model against the solid one, average: difference of the first load",
                quantity="difference",
                unit="-",
                role="gate",
                source="our own section model: another mesh in another dimension, the same wheel",
            ),
            partial(first_difference, *_averages(section, fe, around)),
            _SAME_WHEEL,
        )
    ]


def _averages(section: ModelCurves, fe: ModelCurves, around: Around | None) -> tuple[StiffnessCurve, StiffnessCurve]:
    """Both averages; where a model misses an orientation, over those that neither misses."""
    both = [o for o in section.loaded if o in fe.loaded]
    if not (both and (section.missing or fe.missing)):
        return section.average, fe.average
    of_section, of_solid = (mean_curve([model.by_orientation[o] for o in both], around) for model in (section, fe))
    return of_section, of_solid


def _where(curve: StiffnessCurve) -> str:
    return "average" if curve.orientation_deg is None else f"{curve.orientation_deg:g} deg"


def _read(study: Study, folders: Mapping[str, Path]) -> SectionRuns:
    return SectionRuns(
        section=model_curves("section", folders, around(study)), fe=model_curves("fe", folders, around(study))
    )


def _checks(study: Study, runs: SectionRuns) -> Sequence[Check]:
    return section_checks(runs.section, runs.fe, study.tolerances, around(study))


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
