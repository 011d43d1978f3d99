"""Topic: how far the mesh decides the load. Three meshes, grid convergence index, uncertainty of every FE curve.

Verified by tests/unit/test_workbench_mesh_study.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from contracts.curves import read_curve
from contracts.records import Check
from workbench.check_rules import Claim, at_most
from workbench.graph_fe import degrees, fe_inputs, fe_task, mesh_task, orientation_name
from workbench.mesh_study import MeshRun, MeshStudy, sorted_runs
from workbench.result_files import read_result
from workbench.results import CURVE
from workbench.study import Study
from workbench.task import Task
from workbench.topic import Topic

if TYPE_CHECKING:
    from workbench.comparison import Comparison

__all__ = ["MESH_STUDY"]

_NO_LIMIT = 1e6
"""Load [N] that ends no run: every mesh is solved at every deflection."""


def _tasks(study: Study) -> Sequence[Task]:
    """A mesh and a run for each factor but that of the curves, whose run is the curve itself."""
    tasks = []
    section = study.mesh_study
    for factor in section.factors:
        if factor != study.mesh.factor:
            mesh = mesh_task(study, f"mesh_x{factor:g}", cost=1000.0, factor=factor)
            inputs = fe_inputs(study, degrees(section.orientation), section.deflections)
            inputs |= {"snapshot_loads": [], "max_load": _NO_LIMIT}
            tasks += [mesh, fe_task(f"fe_x{factor:g}", inputs, mesh.name, cost=100.0 * factor**3)]
    return tasks


def _read(study: Study, folders: Mapping[str, Path]) -> MeshStudy:
    section = study.mesh_study
    orientation = degrees(section.orientation)
    runs = []
    for factor in section.factors:
        own = factor == study.mesh.factor
        folder = folders[orientation_name("fe", orientation) if own else f"fe_x{factor:g}"]
        curve = read_curve(folder / CURVE, model="fe", orientation_deg=orientation)
        runs.append(MeshRun(factor=factor, curve=curve, numbers=read_result(folder)))
    return MeshStudy(
        orientation_deg=orientation,
        deflections=section.deflections,
        runs=sorted_runs(runs),
        curves_factor=study.mesh.factor,
    )


def _checks(study: Study, found: Comparison, results: MeshStudy) -> Sequence[Check]:
    places = ", ".join(f"{d * 1e3:g}" for d in results.deflections)
    where = f"at {places} mm, {results.orientation_deg:g} deg"
    claim = Claim(
        id="fe.mesh_uncertainty",
        title=f"FE: largest grid convergence index of the load on the mesh of the curves, {where}",
        quantity="grid convergence index",
        unit="-",
        role="gate",
        source="Celik et al. 2008, J. Fluids Eng. 130, 078001 (ASME V&V 20); the limit is the project's own",
    )
    return [
        at_most(claim, lambda: max(results.index(d) for d in results.deflections), study.tolerances.mesh_uncertainty)
    ]


def _figures(study: Study, results: MeshStudy) -> Mapping[str, str]:
    from workbench.figures_plotly import mesh_study_figure

    return {"mesh_study": mesh_study_figure(results)}


MESH_STUDY = Topic(
    name="mesh_study", title="Mesh uncertainty", tasks=_tasks, read=_read, checks=_checks, figures=_figures
)
