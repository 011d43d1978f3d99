"""Links of a check follow from the task graph: its question's tasks with keys, fewer where its words name them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

from workbench.execution.task import task_keys
from workbench.questions.comparison import Comparison
from workbench.questions.study_graph import report_tasks
from workbench.report.evidence import Evidence, evidence_of
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.verdict.rules import Claim, at_most

STUDY = read_study(built_in_study())
KEYS = task_keys(report_tasks(STUDY))
FILES = ["curves/fe_35C_phi015.csv", "curves/fe_AISI_301_20C_phi015.csv", "series/step_ancf.csv"]
FILES += ["curves/fe_phi000.csv", "curves/fe_average.csv", "curves/section_phi015.csv", "series/drop_brush.csv"]
MADE_BY = {
    "fe.energy": "numerics",
    "mesh.mass": "wheel",
    "fe.mesh_uncertainty": "mesh_study",
    "section.vs_solid_phi015": "section",
    "verify.ancf_end_shear_order": "verification",
    "verify.end_shear_path": "verification",
    "fe.hub_compliance": "hub",
    "rover.drop": "rover",
    "fe.first_yield_load": "strength",
    "environment.stiffness_35C": "environment",
    "environment_AISI_301.similarity": "environment",
    "rover_ancf.mission_slope_up": "rover_ancf",
}


def _evidence(study: Study, made_by: dict[str, str]) -> dict[str, Evidence]:
    def check(id: str) -> Any:
        claim = Claim(id=id, title="Mesh, 15 deg: mass", quantity="run", unit="-", role="finding", source="s")
        return at_most(claim, lambda: 1.0, 2.0)

    found = SimpleNamespace(checks=[check(id) for id in made_by], question_of=made_by)
    return {one.check.id: one for one in evidence_of(study, cast(Comparison, found), KEYS, FILES)}


def test_tasks_come_with_the_keys_of_their_results() -> None:
    found = _evidence(STUDY, MADE_BY)
    assert found["rover.drop"].tasks == {"rover_drop": KEYS["rover_drop"]}
    assert list(found["mesh.mass"].tasks) == ["mesh_whole"]
    assert {"fe_phi000", "fe_phi015"} <= set(found["fe.energy"].tasks)
    assert list(found["section.vs_solid_phi015"].tasks) == ["fe_phi015", "section_phi015"]


def test_without_words_the_identifier_or_the_question_decides() -> None:
    found = _evidence(STUDY, MADE_BY)
    assert list(found["verify.ancf_end_shear_order"].tasks) == ["verify_ancf_end_shear"]
    assert list(found["verify.end_shear_path"].tasks) == ["verify_end_shear"]
    assert {"mesh_hub", "fe_hub_0_rigid"} <= set(found["fe.hub_compliance"].tasks)
    assert {"fe_x2_phi000", "fe_x3_phi015"} <= set(found["fe.mesh_uncertainty"].tasks)


def test_a_temperature_and_a_scenario_lead_to_their_own_tasks_and_files() -> None:
    found = _evidence(STUDY, MADE_BY)
    cold, other = found["environment.stiffness_35C"], found["environment_AISI_301.similarity"]
    assert (list(cold.tasks), cold.files) == (["fe_phi015", "environment_35C"], ("curves/fe_35C_phi015.csv",))
    assert list(other.tasks) == ["environment_AISI_301_20C", "environment_AISI_301_-143C"]
    assert other.files == ("curves/fe_AISI_301_20C_phi015.csv",)
    assert list(found["rover_ancf.mission_slope_up"].tasks) == ["rover_ancf_slope_up"]


def test_every_check_leads_to_a_task_a_section_and_its_files() -> None:
    found = _evidence(STUDY, MADE_BY)
    assert all(one.tasks for one in found.values())
    assert found["rover.drop"].files == ("series/drop_brush.csv",)
    assert found["fe.energy"].files == ("curves/fe_phi000.csv",)
    assert (found["fe.energy"].section, found["mesh.mass"].section, found["rover.drop"].section) == (
        "numerics",
        "wheel",
        "rover",
    )
