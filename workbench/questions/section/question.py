"""Question: the planar section model beside the solid one. Verified by tests/unit/test_workbench_section.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from contracts.curves import StiffnessCurve
from contracts.errors import InputError
from contracts.records import Check
from workbench.questions.model_curves import ModelCurves, model_curves
from workbench.questions.question import Question
from workbench.questions.section.checks import largest_difference, section_checks
from workbench.questions.section.graph import section_tasks, without_planar_model
from workbench.study.model import Study

__all__ = ["SECTION", "SectionRow", "SectionRuns"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRow:
    """One orientation in the table: unknowns and wall time [s] of both models, iterations, largest difference [-].

    The difference is None where a partial curve leaves no common point.
    """

    orientation: float
    dofs: int
    solve_s: float
    iterations: int
    solid_dofs: int
    solid_s: float
    difference: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SectionRuns:
    """Curves of the planar and of the solid model."""

    section: ModelCurves
    fe: ModelCurves

    @property
    def rows(self) -> list[SectionRow]:
        """Orientations that both models have."""
        both = [o for o in self.section.by_orientation if o in self.fe.by_orientation]
        return [self._row(orientation) for orientation in both]

    def _row(self, orientation: float) -> SectionRow:
        ours, solid = self.section.runs[orientation], self.fe.runs[orientation]
        curves = self.section.by_orientation[orientation], self.fe.by_orientation[orientation]
        return SectionRow(
            orientation=orientation,
            dofs=ours.dofs,
            solve_s=ours.solve_s,
            iterations=ours.iterations,
            solid_dofs=solid.dofs,
            solid_s=solid.solve_s,
            difference=_difference(*curves),
        )


def _difference(curve: StiffnessCurve, solid: StiffnessCurve) -> float | None:
    try:
        return largest_difference(curve, solid)
    except InputError:
        return None


def _read(study: Study, folders: Mapping[str, Path]) -> SectionRuns:
    return SectionRuns(section=model_curves("section", folders), fe=model_curves("fe", folders))


def _checks(study: Study, runs: SectionRuns) -> Sequence[Check]:
    return section_checks(runs.section, runs.fe, study.tolerances)


def _figures(study: Study, runs: SectionRuns) -> Mapping[str, str]:
    from workbench.questions.section.figures import section_figure

    return {"section": section_figure(runs.section, runs.fe)}


def _curves(study: Study, runs: SectionRuns) -> Sequence[StiffnessCurve]:
    return [*runs.section.by_orientation.values(), runs.section.average]


def _planar(study: Study) -> bool:
    return without_planar_model(study) is None


SECTION = Question(
    name="section",
    title="Section model",
    group="Wheel",
    tasks=section_tasks,
    read=_read,
    checks=_checks,
    figures=_figures,
    curves=_curves,
    applies=_planar,
)
