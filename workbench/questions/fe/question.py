"""Question: how does the continuum wheel carry load, orientation by orientation, and does it meet the reference?

Verified by tests/unit/test_workbench_checks.py and tests/end_to_end/test_report.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contracts.records import Check
from workbench.execution.task import Task
from workbench.questions.fe.checks import overlap_checks, parts_overlap_check, reach_check, spread_checks
from workbench.questions.fe.graph import fe_curve_tasks, footprint_tasks
from workbench.questions.fe.reference_checks import reference_checks
from workbench.questions.fe.results import OVERLAP, ContinuumCurves, read_continuum
from workbench.questions.question import Question
from workbench.questions.wheel.graph import MESH, MESH_WHOLE
from workbench.study.full import around
from workbench.study.model import Study
from workbench.study.orientation import degrees
from workbench.study.own_mesh import own_mesh
from workbench.study.strengths import yield_strengths

__all__ = ["FE"]


def _tasks(study: Study) -> Sequence[Task]:
    curves = fe_curve_tasks(study)
    pictures = Task(
        name="pictures",
        function="workbench.questions.wheel.pictures:draw",
        inputs={
            "orientation_deg": degrees(study.fe.orientations[0]),
            "yield_strength": min(yield_strengths(study).values(), default=None),
        },
        needs=(MESH_WHOLE, MESH, curves[0].name),
        cost=10.0,
    )
    always = [*curves, pictures, *footprint_tasks(study, curves)]
    if not study.fe.keep_points:
        return always
    needs = (MESH, *(curve.name for curve in curves))
    function = "workbench.questions.fe.overlap_task:measure"
    return [*always, Task(name=OVERLAP, function=function, inputs={"mesh": MESH}, needs=needs, cost=5.0)]


def _checks(study: Study, results: ContinuumCurves) -> Sequence[Check]:
    tolerances, fe = study.tolerances, results.fe
    checks: list[Check] = []
    if study.reference is not None:
        checks += reference_checks(fe, study.reference, tolerances, around(study), results.mesh_study)
    checks += [reach_check(fe, tolerances)] if study.asks_for_reach else []
    checks += spread_checks(fe, tolerances, study.judged_deflection, of_the_thesis=study.of_the_thesis)
    if results.overlaps is not None:
        checks.append(parts_overlap_check(results.overlaps, inner_contact=study.fe.inner_contact))
    if own_mesh(study) is None:  # whose springs and rim have names
        checks += overlap_checks(fe, inner_contact=study.fe.inner_contact, up_to=study.judged_load)
    return checks


def _figures(study: Study, results: ContinuumCurves) -> Mapping[str, str]:
    from workbench.charts.packing import picture_link
    from workbench.questions.fe.figures import around_figure, fe_figure, footprint_figure, stress_figure
    from workbench.questions.wheel.scene import stress_scene

    first, *_ = [*results.fe.loaded.values(), results.fe.average]
    strengths = yield_strengths(study)
    weakest = min(strengths.values(), default=None)
    deformed = "" if results.picture is None else picture_link(results.picture)
    return {
        "fe": fe_figure(results, study.reference),
        "around": around_figure(results.fe, around(study)),
        "stress": stress_figure(first, strengths),
        "footprint": footprint_figure(results.footprints),
        "stress_scene": stress_scene(results.mesh_folder, results.solved, weakest, deformed),
    }


FE = Question(
    name="fe",
    title="Finite elements",
    group="Wheel",
    tasks=_tasks,
    read=read_continuum,
    checks=_checks,
    figures=_figures,
    curves=lambda study, results: [*results.curves, *(back.curve for back in results.unloadings.values())],
    budget=1300,
)
