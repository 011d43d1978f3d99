"""The task graph of a study: what is computed, in which order, and what a change invalidates."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from contracts.materials import TI_6AL_4V
from workbench.execution.fingerprint import canonical_json
from workbench.execution.task import Task, task_keys
from workbench.questions.ancf_wheel.graph import ancf_wheel_tasks
from workbench.questions.curve_graph import mesh_tasks, stiffness_tasks
from workbench.questions.multibody.question import MULTIBODY
from workbench.questions.registry import QUESTIONS
from workbench.questions.rover.question import ROVER
from workbench.questions.rover_ancf.question import ROVER_ANCF
from workbench.questions.rover_closer.question import ROVER_CLOSER
from workbench.questions.study_graph import report_tasks
from workbench.questions.verification.question import VERIFICATION
from workbench.questions.words.graph import hoops_tasks
from workbench.questions.words.readings import reading_tasks
from workbench.study.model import Study
from workbench.study.orientation import orientation_name
from workbench.study.reading import built_in_study, read_study
from workbench.study.wheel_design import design_from, wheel_design

HERE = built_in_study().parent


@pytest.fixture(scope="module")
def study() -> Study:
    return read_study(built_in_study())


def _changed(study: Study, section: str, **values: object) -> Study:
    part = getattr(study, section).model_copy(update=values)
    return study.model_copy(update={section: part})


def _new_keys(before: tuple[Task, ...], after: tuple[Task, ...]) -> set[str]:
    old, new = task_keys(before), task_keys(after)
    return {name for name in new if new[name] != old.get(name)}


def test_report_has_every_task_and_needs_come_first(study: Study) -> None:
    tasks = report_tasks(study)
    names = [t.name for t in tasks]
    orientations = [f"fe_phi{o:03d}" for o in (0, 15, 25, 40, 60, 80, 95, 105)] + ["ancf_phi000", "ancf_phi045"]
    others = {"mesh", "mesh_whole", "brush", "ancf_surfaces", "metrics", "pictures"}
    questions = {task.name for question in QUESTIONS for task in question.tasks(study)}
    assert set(names) == {*orientations, *others, *questions}
    assert len(names) == len(set(names))
    for i, task in enumerate(tasks):
        assert set(task.needs) <= set(names[:i])


def test_inputs_are_json_that_survives_a_round_trip(study: Study) -> None:
    for task in report_tasks(study):
        assert json.loads(canonical_json(task.inputs)) == json.loads(json.dumps(task.inputs))


def test_wheel_design_survives_the_trip_to_the_worker(study: Study) -> None:
    made = design_from(json.loads(canonical_json(mesh_tasks(study)[0].inputs["wheel"])))
    named = {part: replace(m, name="", source="", temperature_data=None) for part, m in made.materials.items()}
    design = wheel_design(study)
    assert named == {
        part: replace(m, name="", source="", temperature_data=None) for part, m in design.materials.items()
    }
    for part in ("tire", "grousers", "outer_hub", "cone", "impact_springs", "inner_hub"):
        assert replace(getattr(made, part), material=TI_6AL_4V) == replace(getattr(design, part), material=TI_6AL_4V)
    for mine, theirs in zip(made.spring_sets, design.spring_sets, strict=True):
        assert replace(mine, material=TI_6AL_4V) == replace(theirs, material=TI_6AL_4V)


def test_deflections_contain_the_one_where_meshes_are_compared(study: Study) -> None:
    odd = _changed(study, "fe", points=7)
    task = next(t for t in report_tasks(odd) if t.name == "fe_phi000")
    assert 0.03 in task.inputs["deflections"]
    assert task.inputs["deflections"][-1] == pytest.approx(study.fe.max_deflection)


def test_a_change_recomputes_only_what_it_decides(study: Study) -> None:
    before = report_tasks(study)
    assert _new_keys(before, report_tasks(study)) == set()
    ancf = report_tasks(_changed(study, "ancf", young_modulus=281e3))
    refined = {f"ancf_plates_x{factor}" for factor in (1, 2, 4, 8)} | {"ancf_drop", "ancf_drop_share", "ancf_ride"}
    driven = {task.name for question in (ROVER_ANCF, ROVER_CLOSER) for task in question.tasks(study)}
    curves = {"ancf_phi000", "ancf_phi045", "ancf_surfaces", "ancf_as_it_is", "metrics"}
    curves |= {task.name for task in reading_tasks(study)}
    assert _new_keys(before, ancf) == curves | refined | driven
    finest = report_tasks(_changed(study, "mesh_study", factors=(1.0, 2.0, 2.5)))
    assert _new_keys(before, finest) == {"mesh_x2.5", "fe_x2.5_phi000", "fe_x2.5_phi015"}
    tolerance = report_tasks(_changed(study, "tolerances", initial_tangent=0.5))
    assert _new_keys(before, tolerance) == set()
    mesh = report_tasks(_changed(study, "mesh", element_size=7e-3))
    closed = (VERIFICATION, MULTIBODY, ROVER, ROVER_ANCF, ROVER_CLOSER)
    verified = {task.name for question in closed for task in question.tasks(study)}
    kept = {"ancf_phi000", "ancf_phi045", "brush", "ancf_surfaces"} | refined | verified
    kept |= {task.name for task in [*reading_tasks(study), *hoops_tasks(), *ancf_wheel_tasks(study)]}
    kept |= {"soil_measured", "soil_ancf_wheel"}
    kept -= {"ancf_wheel_shape"}  # it reads the solid's fields
    assert kept == set(task_keys(before)) - _new_keys(before, mesh)


def test_stiffness_tasks_take_the_orientations_asked_for(study: Study) -> None:
    assert [t.name for t in stiffness_tasks(study, "fe", [7.5])] == ["mesh", "fe_phi007.5"]
    assert [t.name for t in stiffness_tasks(study, "ancf", [])] == ["ancf_phi000", "ancf_phi045"]
    assert [t.name for t in stiffness_tasks(study, "brush", [])] == ["brush"]
    assert orientation_name("fe", 359.0) == "fe_phi359"


def test_text_of_a_user_curve_is_part_of_the_key(study: Study, tmp_path: Path) -> None:
    from workbench.study.reference import CurveReference, ReferenceSection

    file = str(tmp_path / "mine.csv")
    section = CurveReference(file=file, label="mine", source="me", kind="measured", uncertainty="3 %")
    with_curve = study.model_copy(update={"reference": ReferenceSection(thesis_words=True, curves=(section,))})
    (tmp_path / "mine.csv").write_text("deflection_m,load_N\n0,0\n0.01,82\n", encoding="utf-8")
    before = report_tasks(with_curve)
    (tmp_path / "mine.csv").write_text("deflection_m,load_N\n0,0\n0.01,83\n", encoding="utf-8")
    assert _new_keys(before, report_tasks(with_curve)) == {"metrics"}


def test_the_preset_is_solved_at_the_deflections_of_its_table(study: Study) -> None:
    from workbench.questions.ancf.preset_table import preset_table

    def points(changed: Study) -> list[float]:
        (task,) = (t for t in report_tasks(changed) if t.name == "ancf_phi000")
        return list(task.inputs["deflections"])

    table = set(preset_table()[:, 0].round(12).tolist())
    assert len(points(study)) == 37
    odd = points(_changed(study, "ancf", points=5))
    assert table <= set(odd)
    assert odd == sorted(odd)
    assert len(points(_changed(study, "ancf", points=5, thesis_preset=False))) == 6
    assert max(points(_changed(study, "ancf", max_deflection=0.012))) == 0.012
