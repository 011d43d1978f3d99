"""The comparison: stored results in, checks and verdict out. Verified by tests/unit/test_workbench_checks.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve, read_curve
from contracts.records import Check, Status
from workbench.checks.convergence import COMPLETE, completeness_check
from workbench.checks.energy import energy_check
from workbench.checks.fe import (
    band_checks,
    mesh_checks,
    reach_check,
    solver_checks,
    spread_checks,
    yield_check,
)
from workbench.checks.limits import circumferential_tangent_check, overlap_checks
from workbench.checks.models import agreement_checks, ancf_checks, surfaces_check, user_checks
from workbench.checks.statements import statement_of
from workbench.comparison.agreement import Agreement, agreements, noted
from workbench.comparison.curves import ModelCurves, UserCurve, model_curves
from workbench.comparison.mesh_study import MeshStudy
from workbench.comparison.results import brush_curve, mesh_numbers
from workbench.execution.result_files import early_ends, read_result
from workbench.graph.surfaces import SURFACES
from workbench.study.full import rotational_period
from workbench.study.model import Study
from workbench.study.sections import ToleranceSection
from workbench.study.wheel_design import part_materials
from workbench.tasks.orientation import degrees
from workbench.topics.mesh_study import MESH_STUDY
from workbench.topics.registry import topics_of

__all__ = ["Comparison", "compare", "exit_status", "overall_status"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Everything the report shows that came out of the results.

    Attributes
    ----------
    fe : curves of the continuum model
    ancf : curves of the ANCF tire, None where the study has none
    brush : the brush line, None where the study has none
    users : the user's own curves
    mesh, mesh_whole : numbers of both meshes
    metrics : distances between curves by pair
    topics : results of each topic by its name
    agreement_limit : relative L2 difference up to which two models agree [-]
    checks : the verdict, line by line
    topic_of : identifier of a check -> topic that made it; those of the models themselves are not among them
    """

    fe: ModelCurves
    ancf: ModelCurves | None
    brush: StiffnessCurve | None
    users: tuple[UserCurve, ...]
    mesh: Mapping[str, Any]
    mesh_whole: Mapping[str, Any]
    metrics: Mapping[str, Any]
    topics: Mapping[str, Any]
    agreement_limit: float
    checks: tuple[Check, ...]
    topic_of: Mapping[str, str]

    @property
    def mesh_study(self) -> MeshStudy | None:
        """Three meshes, and the numerical uncertainty they give every FE curve; None where the study has none."""
        study = self.topics.get(MESH_STUDY.name)
        assert study is None or isinstance(study, MeshStudy)
        return study

    @property
    def curves(self) -> list[StiffnessCurve]:
        """Those of the models, with their numerical uncertainty where it is known."""
        fe, study = [*self.fe.by_orientation.values(), self.fe.average], self.mesh_study
        ancf = [] if self.ancf is None else [*self.ancf.by_orientation.values(), self.ancf.average]
        stated = fe if study is None else [study.stated(curve) for curve in fe]
        return [*stated, *ancf, *([] if self.brush is None else [self.brush])]

    @property
    def agreements(self) -> Mapping[str, Agreement]:
        """Each pair of the metrics judged against the limit and the numerical uncertainty."""
        return agreements(self.metrics, self.fe, self.mesh_study, self.agreement_limit)


def compare(study: Study, folders: Mapping[str, Path]) -> Comparison:
    """Read the results of ``report_tasks`` and hold them against their references.

    Parameters
    ----------
    study : supplies references and tolerances
    folders : result folder of each task by name
    """
    metrics = read_result(folders["metrics"])
    comparison = Comparison(
        fe=model_curves("fe", folders),
        ancf=None if study.ancf is None else model_curves("ancf", folders),
        brush=None if study.brush is None else brush_curve(study, folders["brush"]),
        users=_users(study, folders["metrics"]),
        mesh=mesh_numbers(study, folders["mesh"]),
        mesh_whole=mesh_numbers(study, folders["mesh_whole"]),
        metrics=metrics,
        topics={topic.name: topic.read(study, folders) for topic in topics_of(study)},
        agreement_limit=study.tolerances.model_agreement,
        checks=(),
        topic_of={},
    )
    by_topic = {topic.name: topic.checks(study, comparison.topics[topic.name]) for topic in topics_of(study)}
    checks = [completeness_check(early_ends(folders)), *_checks(study, comparison, folders)]
    checks += [check for made in by_topic.values() for check in made]
    return replace(
        comparison,
        checks=tuple(_with_own_limit(check, study.tolerances) for check in checks),
        topic_of={check.id: name for name, made in by_topic.items() for check in made},
    )


def _with_own_limit(check: Check, tolerances: ToleranceSection) -> Check:
    """Says so where the study sets the limit itself: the reason given is that of the limit by default."""
    setting = statement_of(check.id, check.quantity, check.title).setting
    if not setting or getattr(tolerances, setting) == getattr(ToleranceSection(), setting):
        return check
    return replace(check, why=f"The study sets this limit itself ([tolerances] {setting}). By default: {check.why}")


def _checks(study: Study, found: Comparison, folders: Mapping[str, Path]) -> list[Check]:
    tol, fe = study.tolerances, found.fe
    strength = {part: study.materials[name].yield_strength for part, name in part_materials(study).items()}
    checks = [] if study.reference is None else band_checks(fe, study.reference, tol)
    checks += solver_checks(fe, () if found.mesh_study is None else found.mesh_study.runs, tol)
    checks += [reach_check(fe, tol)] if tol.asks_for_reach else []
    checks.append(energy_check(list(fe.by_orientation.values()), tol.fe_energy))
    checks += mesh_checks(found.mesh, found.mesh_whole, tol)
    if study.ancf is not None and found.ancf is not None:
        checks.append(surfaces_check(read_result(folders[SURFACES])["read_back_m"], tol))
        checks += ancf_checks(found.ancf, tol) if study.ancf.thesis_preset else []
    models = [name for name, curves in (("ancf", found.ancf), ("brush", found.brush)) if curves is not None]
    checks += noted(agreement_checks(models, found.metrics, tol), found.agreements)
    checks += [
        *spread_checks(fe, tol, study.judged_deflection),
        yield_check(fe, strength, study.judged_load),
        *overlap_checks(fe, inner_contact=study.fe.inner_contact, up_to=study.judged_load),
    ]
    if study.reference is not None:
        checks.append(circumferential_tangent_check(fe, study.reference, tol, rotational_period(study)))
    return checks + noted(user_checks(found.users, found.metrics, tol), found.agreements)


def _users(study: Study, folder: Path) -> tuple[UserCurve, ...]:
    return tuple(
        UserCurve(
            label=section.label,
            curve=replace(read_curve(folder / f"user_{i}.csv", model=section.label), source=section.source),
            orientation_deg=None if section.orientation is None else degrees(section.orientation),
        )
        for i, section in enumerate(study.compare.curves)
    )


def overall_status(checks: Sequence[Check]) -> Status:
    """``error`` if a run ended early, else what the gates say: ``fail``, ``error`` without a value, ``pass``."""
    if _ended_early(checks):
        return "error"
    gates = {c.status for c in checks if c.role == "gate"}
    return "fail" if "fail" in gates else "error" if "error" in gates else "pass"


def exit_status(checks: Sequence[Check]) -> int:
    """0 if every gate passed, 2 if a run ended before its target, else 1."""
    if _ended_early(checks):
        return 2
    return 0 if overall_status(checks) == "pass" else 1


def _ended_early(checks: Sequence[Check]) -> bool:
    return any(c.id == COMPLETE and c.status == "error" for c in checks)
