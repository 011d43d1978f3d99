"""Question: how far the mesh decides the load. Three meshes, grid convergence index, uncertainty of every FE curve.

Verified by tests/unit/test_workbench_mesh_study.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from contracts.curves import StiffnessCurve
from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.fe.graph import fe_inputs, fe_task, without_end
from workbench.questions.mesh_study.figures import mesh_study_figures
from workbench.questions.mesh_study.results import MeshStudy, mesh_run_name, read_mesh_study
from workbench.questions.question import Question
from workbench.questions.wheel.graph import mesh_task
from workbench.study.model import Study, stated
from workbench.study.orientation import degrees, orientation_name
from workbench.study.own_mesh import own_mesh
from workbench.study.strengths import yield_strengths
from workbench.verdict.rules import Claim, at_most

__all__ = ["MESH_STUDY", "mesh_study_inputs", "mesh_study_of", "mesh_study_runs", "read_mesh_study"]


def _tasks(study: Study) -> Sequence[Task]:
    """A mesh for each factor but that of the curves, whose runs are the curves themselves, and a run each way up."""
    tasks = []
    section = stated(study.mesh_study, "mesh_study")
    for factor in section.factors:
        if factor != study.mesh.factor:
            mesh = mesh_task(study, f"mesh_x{factor:g}", factor=factor)
            tasks.append(mesh)
            for orientation in section.orientations:
                inputs = without_end(fe_inputs(study, degrees(orientation), section.deflections))
                tasks.append(fe_task(orientation_name(f"fe_x{factor:g}", degrees(orientation)), inputs, mesh.name))
    return tasks


def mesh_study_inputs(study: Study) -> dict[str, Any]:
    """What `read_mesh_study` needs to know of a study, as JSON values."""
    section = stated(study.mesh_study, "mesh_study")
    refined = {} if own_mesh(study) is None else {"refined_axes": 3}
    return refined | {
        "orientations_deg": [degrees(orientation) for orientation in section.orientations],
        "deflections": list(section.deflections),
        "factors": list(section.factors),
        "curves_factor": study.mesh.factor,
    }


def mesh_study_runs(study: Study) -> tuple[str, ...]:
    """Names of the tasks whose results `read_mesh_study` reads."""
    inputs = mesh_study_inputs(study)
    return tuple(
        mesh_run_name(factor, inputs["curves_factor"], orientation)
        for orientation in inputs["orientations_deg"]
        for factor in inputs["factors"]
    )


def _read(study: Study, folders: Mapping[str, Path]) -> MeshStudy:
    return read_mesh_study(**mesh_study_inputs(study), folders=folders)


def mesh_study_of(study: Study, folders: Mapping[str, Path]) -> MeshStudy | None:
    """The mesh study of a study's results, from which other questions take the uncertainty; None where it has none."""
    return None if study.mesh_study is None else _read(study, folders)


def _checks(study: Study, results: MeshStudy) -> Sequence[Check]:
    places = ", ".join(f"{d * 1e3:g}" for d in results.deflections)
    at = f"{', '.join(f'{family.orientation_deg:g}' for family in results.families)} deg"
    where = f"at {places} mm, {at}"
    claim = Claim(
        id="fe.mesh_uncertainty",
        title=f"FE: largest grid convergence index of the load on the mesh of the curves, {where}",
        quantity="grid convergence index",
        unit="-",
        role="gate",
        source="Celik et al. 2008, J. Fluids Eng. 130, 078001 (ASME V&V 20); the limit is the project's own",
    )
    stress = replace(
        claim,
        id="fe.stress_uncertainty",
        title=f"FE: largest grid convergence index of the stress that decides first yield, {at}, last deflection",
        role="finding",
    )
    strengths, tolerances = yield_strengths(study), study.tolerances
    return [
        at_most(claim, lambda: max(results.index(d) for d in results.deflections), tolerances.mesh_uncertainty),
        at_most(stress, lambda: results.stress_index(strengths), tolerances.stress_uncertainty),
    ]


def _curves(study: Study, results: MeshStudy) -> list[StiffnessCurve]:
    """Those of the other meshes."""
    runs = [run for f in results.families for run in f.runs if run.factor != f.curves_factor]
    return [replace(run.curve, model=f"fe_x{run.factor:g}") for run in runs]


MESH_STUDY = Question(
    name="mesh_study",
    title="Mesh uncertainty",
    group="Wheel",
    tasks=_tasks,
    read=_read,
    checks=_checks,
    figures=mesh_study_figures,
    curves=_curves,
    applies=lambda study: study.mesh_study is not None,
)
