"""A study whose wheel's mesh comes from a file: what its section says, what it cannot have, what asks for [wheel]."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError, StudyError
from workbench.commands.calibrate import run_calibrate
from workbench.execution.runner import Computing
from workbench.questions.curve_graph import mesh_tasks, stiffness_tasks
from workbench.questions.registry import questions_of
from workbench.questions.study_graph import report_tasks
from workbench.questions.travels import travel_tasks
from workbench.questions.wheel.own_mesh_task import own_wheel
from workbench.study.full import full_study
from workbench.study.magnitudes import of_the_file
from workbench.study.model import Study
from workbench.study.own_mesh import materials_by_part, own_mesh, sized_mesh
from workbench.study.own_mesh_rules import NEEDS_WHEEL
from workbench.study.reading import built_in_study, study_of

SPIRAL = Path(__file__).parents[2] / "studies" / "spiral.toml"


def _table() -> dict[str, Any]:
    return tomllib.loads(SPIRAL.read_text(encoding="utf-8"))


def _study(**mesh: object) -> Study:
    table = _table()
    table["mesh"] |= mesh
    return study_of(SPIRAL, table)


def test_parts_take_the_place_of_the_wheel() -> None:
    study = _study()
    section = own_mesh(study)
    assert section is not None
    assert Path(section.file) == SPIRAL.with_name("spiral.inp")
    assert set(materials_by_part(study)) == {"hub", "spokes", "rim"}
    assert of_the_file(study) == ()
    assert {question.name for question in questions_of(study)} == {"models", "wheel", "fe", "strength", "numerics"}
    assert {task.name for task in report_tasks(study)} == {
        *("mesh", "mesh_whole", "fe_phi000", "fe_phi018", "footprint_phi000", "footprint_phi018", "metrics", "pictures")
    }
    assert [task.name for task in mesh_tasks(study, with_files=True)] == ["mesh", "mesh_files"]


def test_tasks_know_what_is_held_and_what_may_touch() -> None:
    task = stiffness_tasks(_study(hub=["hub", "bore"]), "fe", ())[1]
    assert task.inputs["rigid_parts"] == ["hub"]
    assert task.inputs["faces"] == {
        "ground": ["tread"],
        "held": ["bore"],
        "pairs": [["spoke_front", "rim_inner"], ["spoke_back", "rim_inner"]],
    }


def test_a_mesh_study_divides_the_cells() -> None:
    table = _table() | {"mesh_study": {"orientation": "0 deg", "deflections": ["4 mm"], "factors": [1, 2, 3]}}
    tasks = {task.name: task for task in report_tasks(study_of(SPIRAL, table))}
    assert [tasks[name].inputs["mesh"]["factor"] for name in ("mesh", "mesh_x2", "mesh_x3")] == [1, 2, 3]
    table["mesh_study"]["factors"] = [1, 1.5, 2]
    with pytest.raises(StudyError, match="must be whole numbers"):
        study_of(SPIRAL, table)


def test_the_content_of_the_file_decides_the_key(tmp_path: Path) -> None:
    (tmp_path / "spiral.inp").write_text("*NODE\n1, 0, 0, 0\n")
    keys = []
    for text in ("1, 0, 0, 0", "1, 0, 0, 1"):
        (tmp_path / "spiral.inp").write_text(f"*NODE\n{text}\n")
        keys.append(mesh_tasks(study_of(tmp_path / "spiral.toml", _table()))[0].key({}))
    assert keys[0] != keys[1]


SECTIONS: dict[str, Any] = {
    **{name: tomllib.loads(built_in_study().read_text(encoding="utf-8")).get(name, {}) for name in NEEDS_WHEEL},
    "sweep": {"models": ["fe"], "parameters": {"fe.friction": [0.0, 0.3]}},
}


@pytest.mark.parametrize("section", NEEDS_WHEEL)
def test_a_section_that_needs_the_dimensions_is_refused_with_its_reason(section: str) -> None:
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, _table() | {section: SECTIONS[section]})
    assert told.value.key == section
    assert told.value.rule == NEEDS_WHEEL[section]


BROKEN: dict[str, tuple[dict[str, object], str, str]] = {
    "no unit": ({"units": "furlong"}, "mesh.units", "must be 'm', 'cm', 'mm' or 'in'"),
    "no hub": ({"hub": []}, "mesh.hub", "must have at least 1 items"),
    "a size": ({"element_size": "8 mm"}, "mesh.element_size", "is not a known key"),
    "no parts": ({"parts": {}}, "mesh.parts", ""),
    "a part's name": ({"parts": {"a b": {"material": "PA 12"}}}, "", "must begin with a letter"),
    "no such material": (
        {"parts": {"hub": {"material": "steel"}}},
        "mesh.parts.hub.material",
        "is not in [materials], which has PA 12",
    ),
    "axle up": ({"axle": "z"}, "mesh.up", "must not be the axle"),
    "held and pressed": ({"hub": ["tread"]}, "mesh.hub", "names what mesh.ground names too"),
    "held and touched": ({"hub": ["rim_inner"]}, "mesh.hub", "names what mesh.contact names too"),
    "twice": ({"ground": ["tread", "tread"]}, "mesh.ground", "names it twice"),
    "pair twice": ({"contact": [["a", "b"], ["b", "a"]]}, "mesh.contact", "names it twice"),
    "a group of two parts": (
        {"parts": {"hub": {"material": "PA 12"}, "rim": {"material": "PA 12", "groups": ["hub"]}}},
        "mesh.parts.rim.groups",
        "holds hub, which hub has already",
    ),
    "a factor": ({"factor": 1.5}, "mesh.factor", "must be a whole number"),
    "a centre far away": ({"centre": ["0 m", "90 m", "0 m"]}, "mesh.centre[1]", ""),
}


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_section_is_one_message(what: str) -> None:
    change, key, words = BROKEN[what]
    with pytest.raises(StudyError) as told:
        _study(**change)
    assert told.value.key == key or not key
    assert words in told.value.rule


@pytest.mark.parametrize(
    ("section", "change", "key"),
    [
        ("fe", {"hub": "elastic"}, "fe.hub"),
        ("reference", {"thesis_words": True}, "reference.thesis_words"),
    ],
)
def test_what_is_of_our_wheels_is_refused(section: str, change: dict[str, object], key: str) -> None:
    table = _table()
    table[section] = table.get(section, {}) | change
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, table)
    assert told.value.key == key


def test_a_turned_ground_needs_the_whole_wheel() -> None:
    table = _table()
    table["fe"]["camber"] = "5 deg"
    study_of(SPIRAL, table)
    table["mesh"]["symmetry"] = "middle"
    with pytest.raises(StudyError, match=r"mesh\.symmetry"):
        study_of(SPIRAL, table)


def test_a_study_without_wheel_and_without_mesh_file_is_told() -> None:
    table = _table() | {"mesh": {"element_size": "8 mm", "axial_size": "20 mm"}}
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, table)
    assert (told.value.key, told.value.rule) == ("wheel", "is missing")


def test_models_of_the_dimensions_are_refused_when_asked_for() -> None:
    study = _study()
    for model, words in (("section", "the section model needs the dimensions"), ("ancf_wheel", "mesh.file")):
        with pytest.raises(InputError, match=words):
            stiffness_tasks(study, model, ())
    with pytest.raises(InputError, match=r"\[ancf\].*is not in the study"):
        stiffness_tasks(study, "ancf", ())
    with pytest.raises(InputError, match="a full study needs the dimensions"):
        full_study(study)
    with pytest.raises(InputError, match="needs the dimensions"):
        sized_mesh(study)
    with pytest.raises(InputError, match=r"mesh\.file"):
        travel_tasks(study, "ancf_wheel", (), 40.0)


def test_thicknesses_cannot_be_calibrated(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the section model needs the dimensions"):
        run_calibrate(SPIRAL, "8 N/mm", tmp_path / "out.toml", tmp_path / "store", Computing(workers=1))


def test_faults_of_names_are_told_with_their_key() -> None:
    section = own_mesh(_study(ground=["tire"]))
    assert section is not None
    with pytest.raises(InputError) as told:
        own_wheel(section.model_dump(mode="json"))
    assert str(told.value).startswith(
        "mesh.ground: group of faces = tire: is no group of faces in the mesh file, which"
    )
