"""The section model in the workbench: its tasks, and checks that pass on a close curve and fail on a distant one."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from contracts.curves import StiffnessCurve, average_curve
from contracts.errors import IncrementRecord, InputError
from workbench.execution.task import task_keys
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.model_curves import ModelCurves, RunNumbers
from workbench.questions.registry import questions_of
from workbench.questions.section.question import SectionRuns, largest_difference, section_checks
from workbench.questions.study_graph import report_tasks
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.study.sections import ToleranceSection

D = np.linspace(0.0, 0.03, 16)


def curves(model: str, factor: float) -> ModelCurves:
    found = {
        o: StiffnessCurve(model=model, orientation_deg=o, deflection=D, load=factor * (8e3 + 10.0 * o) * D)
        for o in (0.0, 22.5)
    }
    return ModelCurves(model=model, by_orientation=found, average=average_curve(list(found.values())), runs={})


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


@pytest.mark.parametrize(("factor", "status"), [(1.04, "pass"), (0.96, "pass"), (1.06, "fail"), (0.94, "fail")])
def test_five_per_cent_is_the_limit(factor: float, status: str) -> None:
    checks = section_checks(curves("section", factor), curves("fe", 1.0), ToleranceSection())
    assert checks.pop().id == "section.first_load"
    assert [c.id for c in checks] == ["section.vs_solid_phi000", "section.vs_solid_phi022.5", "section.agreement"]
    assert {(c.status, c.role) for c in checks} == {(status, "finding")}


@pytest.mark.parametrize(
    ("factor", "status"), [(0.5, "fail"), (0.79, "fail"), (0.81, "pass"), (1.19, "pass"), (1.21, "fail"), (2.0, "fail")]
)
def test_a_wheel_counted_half_or_twice_breaks_a_gate(factor: float, status: str) -> None:
    check = section_checks(curves("section", factor), curves("fe", 1.0), ToleranceSection())[-1]
    assert (check.id, check.role, check.status) == ("section.first_load", "gate", status)
    assert check.value == pytest.approx(abs(factor - 1.0))


def test_curves_without_a_common_load_leave_the_gate_open() -> None:
    fe = curves("fe", 1.0)
    section = curves("section", 1.0)
    short = replace(section.by_orientation[0.0], orientation_deg=None, deflection=D[:2] * 0.1, load=D[:2] * 800.0)
    assert section_checks(replace(section, average=short), fe, ToleranceSection())[-1].status == "error"


def test_the_difference_is_found_where_it_is_largest() -> None:
    solid = curves("fe", 1.0).by_orientation[0.0]
    bent = replace(solid, load=solid.load + np.where(np.arange(len(D)) == 7, 9.0, 0.0))
    assert largest_difference(bent, solid) == pytest.approx(9.0 / solid.load[7])
    short = replace(bent, deflection=D[:6], load=bent.load[:6])
    assert largest_difference(short, solid) == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(InputError, match="same orientation"):
        largest_difference(bent, None)


def test_an_orientation_the_solid_model_lacks_is_not_evaluated() -> None:
    fe = curves("fe", 1.0)
    lone = replace(fe, by_orientation={0.0: fe.by_orientation[0.0]})
    by_id = {c.id: c for c in section_checks(curves("section", 1.0), lone, ToleranceSection())}
    assert by_id["section.vs_solid_phi022.5"].status == "error"


def test_a_row_without_common_points_has_no_difference() -> None:
    record = IncrementRecord(target=0.0, step=0.0, converged=True, residuals=(1.0, 0.1, 0.01))
    run = RunNumbers(dofs=10, solve_s=1.0, increments=(record,))
    section, fe = (replace(curves(m, 1.02), runs=dict.fromkeys((0.0, 22.5), run)) for m in ("section", "fe"))
    assert [row.section.iterations for row in SectionRuns(section=section, fe=fe).rows] == [2, 2]
    solid = fe.by_orientation[0.0]
    short = replace(section, by_orientation={0.0: replace(solid, deflection=D[:2] * 1e-3, load=solid.load[:2])})
    assert [row.difference for row in SectionRuns(section=short, fe=fe).rows] == [None]


def test_section_tasks_need_no_mesh_and_see_every_size(study: Study) -> None:
    tasks = stiffness_tasks(study, "section", [7.5])
    assert [t.name for t in tasks] == ["section_phi007.5"]
    assert tasks[0].needs == ()
    finer = study.model_copy(update={"mesh": study.mesh.model_copy(update={"element_size": 6e-3})})
    longer = study.model_copy(update={"mesh": study.mesh.model_copy(update={"axial_size": 6e-3})})
    keys = [task_keys(stiffness_tasks(s, "section", [7.5]))["section_phi007.5"] for s in (study, finer, longer)]
    assert keys[0] != keys[1]
    assert keys[0] == keys[2]


def test_a_law_without_planar_form_leaves_the_topic_out(study: Study) -> None:
    neo = study.model_copy(update={"fe": study.fe.model_copy(update={"material_law": "neo_hookean"})})
    assert "section" in {t.name for t in questions_of(study)}
    assert "section" not in {t.name for t in questions_of(neo)}
    assert not any(t.name.startswith("section_") for t in report_tasks(neo))
    with pytest.raises(InputError, match="no planar form"):
        stiffness_tasks(neo, "section", [])


def test_springs_that_bend_out_of_the_plane_leave_it_out_too(study: Study) -> None:
    springs = SimpleNamespace(name="sides", material="Ti-6Al-4V")
    changed = study.wheel.model_copy(update={"sidewall_springs": springs})
    closed = study.model_copy(update={"wheel": changed, "soil": None})
    assert "section" not in {t.name for t in questions_of(closed)}
    with pytest.raises(InputError, match="out of the plane"):
        stiffness_tasks(closed, "section", [])
