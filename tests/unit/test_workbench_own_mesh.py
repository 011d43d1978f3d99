"""A study whose wheel's mesh comes from a file: what its section says, what it cannot have, what asks for [wheel]."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

from contracts.curves import Around
from contracts.errors import InputError, StudyError
from contracts.hub_travel import Way
from geometry.own_mesh.step_body import FaceRule
from workbench.commands.calibrate import run_calibrate
from workbench.execution.runner import Computing
from workbench.questions.curve_graph import mesh_tasks, stiffness_tasks
from workbench.questions.models.wheel_tasks import solved_tire
from workbench.questions.registry import questions_of
from workbench.questions.study_graph import report_tasks
from workbench.questions.sweep.graph import sweep_graph
from workbench.questions.travels import travel_tasks
from workbench.questions.wheel.graph import own_mesh_task
from workbench.questions.wheel.own_mesh_task import own_content, require_rover_wheel, wheel_in
from workbench.study.full import around, full_study
from workbench.study.magnitudes import of_the_file
from workbench.study.model import Study
from workbench.study.model_parameters import rover_radius
from workbench.study.own_mesh import materials_by_part, own_mesh, sized_mesh, sizes_and_rules
from workbench.study.own_mesh_rules import NEEDS_WHEEL
from workbench.study.reading import built_in_study, study_of
from workbench.study.sweep_points import sweep_points

SPIRAL = Path(__file__).parents[2] / "studies" / "spiral.toml"


def _table() -> dict[str, Any]:
    return tomllib.loads(SPIRAL.read_text(encoding="utf-8"))


def _study(**mesh: object) -> Study:
    table = _table()
    table["mesh"] = {key: value for key, value in (table["mesh"] | mesh).items() if value is not None}
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
    """And not its place."""
    keys = []
    for place, text in (("a", "1, 0, 0, 0"), ("a", "1, 0, 0, 1"), ("b", "1, 0, 0, 1")):
        (tmp_path / place).mkdir(exist_ok=True)
        (tmp_path / place / "spiral.inp").write_text(f"*NODE\n{text}\n")
        keys.append(own_mesh_task(study_of(tmp_path / place / "spiral.toml", _table())).key({}))
    assert keys[0] != keys[1]
    assert keys[1] == keys[2]


SECTIONS: dict[str, Any] = {
    **{name: tomllib.loads(built_in_study().read_text(encoding="utf-8")).get(name, {}) for name in NEEDS_WHEEL},
}


@pytest.mark.parametrize("section", NEEDS_WHEEL)
def test_a_section_that_needs_the_dimensions_is_refused_with_its_reason(section: str) -> None:
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, _table() | {section: SECTIONS[section]})
    assert told.value.key == section
    assert told.value.rule == NEEDS_WHEEL[section]


STEP = {
    "file": "wheel.step",
    "units": None,
    "element_size": "20 mm",
    "faces": {"tread": {"radius": "125 mm"}, "bore": {"part": "hub", "radius": ["14 mm", "15 mm"]}},
    "contact": [],
}


def test_solids_are_meshed_by_sizes_and_named_by_rules() -> None:
    parts = {"hub": {"material": "PA 12"}, "rim": {"material": "PA 12", "element_size": "5 mm", "groups": ["a", "b"]}}
    section = own_mesh(_study(**STEP, parts=parts))
    assert section is not None
    sizes, rules = sizes_and_rules(section.model_dump(mode="json"))
    assert (sizes.element_size, sizes.around, sizes.of_solids) == (0.02, 12, {"a": 0.005, "b": 0.005})
    assert rules["tread"] == FaceRule(radius=(0.125, 0.125))
    assert rules["bore"] == FaceRule(solids=("hub",), radius=(0.014, 0.015))


BROKEN: dict[str, tuple[dict[str, object], str, str]] = {
    "no unit": ({"units": "furlong"}, "mesh.units", "must be 'm', 'cm', 'mm' or 'in'"),
    "no hub": ({"hub": []}, "mesh.hub", "must have at least 1 items"),
    "a size": ({"element_size": "8 mm"}, "mesh.element_size", "is for solids in a STEP file"),
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
    "no unit of a mesh": ({"units": None}, "mesh.units", "is missing"),
    "faces of a mesh": ({"faces": {"tread": {"radius": "1 m"}}}, "mesh.faces", "is for solids in a STEP file"),
    "around of a mesh": ({"around": 12}, "mesh.around", "is for solids in a STEP file"),
    "size of a meshed part": (
        {"parts": {"hub": {"material": "PA 12", "element_size": "9 mm"}}},
        "mesh.parts.hub.element_size",
        "is for solids in a STEP file",
    ),
    "a unit of solids": (STEP | {"units": "mm"}, "mesh.units", "is not needed: a STEP file states its own unit"),
    "no size of solids": (STEP | {"element_size": None}, "mesh.element_size", "is missing"),
    "a size of zero": (STEP | {"element_size": "0 mm"}, "mesh.element_size", "must be greater than 0"),
    "a rule that names nothing": (STEP | {"faces": {"tread": {}}}, "mesh.faces.tread", "stands for no face"),
    "a rule of no part": (
        STEP | {"faces": {"tread": {"part": "tire"}}},
        "mesh.faces.tread.part",
        "is not in [mesh.parts], which has hub, spokes, rim",
    ),
    "a rule nobody uses": (STEP | {"faces": {"flank": {"part": "rim"}}}, "mesh.faces.flank", "is named nowhere"),
    "a rule called as a part": (STEP | {"faces": {"rim": {"part": "rim"}}}, "mesh.faces.rim", "is the name of a part"),
    "a falling range": (
        STEP | {"faces": {"tread": {"radius": ["2 m", "1 m"]}}},
        "mesh.faces.tread.radius",
        "must ascend",
    ),
    "a negative radius": (
        STEP | {"faces": {"tread": {"radius": "-125 mm"}}},
        "mesh.faces.tread.radius",
        "is not negative",
    ),
    "no number": (STEP | {"faces": {"tread": {"numbers": []}}}, "mesh.faces.tread.numbers", "is empty"),
    "a face not declared": (
        STEP | {"ground": ["tire"], "hub": ["tread", "bore"]},
        "mesh.ground",
        "is not in [mesh.faces], which has tread, bore",
    ),
    "all held": ({"hub": ["rim", "spokes", "hub"], "ground": ["tread"]}, "mesh.hub", "holds every part"),
    "IGES": ({"file": "wheel.igs", "units": None}, "mesh.file", ".igs is not read; .msh, "),
    "a key of our wheels": ({"axial_size": "9 mm"}, "mesh.axial_size", "is for wheels of [wheel]; a mesh from a file"),
    "a centre far away": ({"centre": ["0 m", "90 m", "0 m"]}, "mesh.centre[1]", ""),
}


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_section_is_one_message(what: str) -> None:
    change, key, words = BROKEN[what]
    with pytest.raises(StudyError) as told:
        _study(**change)
    assert told.value.key == key or not key
    assert words in told.value.rule


def test_a_part_of_our_wheels_beside_the_file_is_told_before_what_it_lacks() -> None:
    with pytest.raises(StudyError, match=r"wheel = a table: describes a wheel of our own"):
        study_of(SPIRAL, _table() | {"wheel": {"tread": {"thickness": "5 mm"}}})


def test_a_length_that_is_refused_is_shown_with_its_unit() -> None:
    with pytest.raises(StudyError, match=r"mesh\.element_size = 20 mm: is for solids"):
        _study(element_size="20 mm")


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


def test_a_sweep_varies_what_is_not_of_the_wheel() -> None:
    table = _table() | {"sweep": {"models": ["fe"], "fe.friction": [0.0, 0.3], "mesh.factor": [1, 2]}}
    points = sweep_points(SPIRAL, table)
    assert len(points) == 5
    graph = sweep_graph(points, ("fe",))
    assert len({task.key({}) for task in graph.tasks if task.name.endswith("/mesh")}) == 2
    assert len([task for task in graph.tasks if task.name.endswith("/fe_phi000")]) == 4


@pytest.mark.parametrize(
    ("sweep", "key"),
    [
        ({"models": ["section"], "fe.friction": [0.0, 0.3]}, "sweep.models"),
        ({"models": ["fe"], "strip_thickness": ["1 mm", "2 mm"]}, "sweep.strip_thickness"),
        ({"models": ["fe"], "wheel.tire.width": ["60 mm"]}, "sweep.wheel.tire.width"),
        ({"models": ["brush"], "fe.friction": [0.0]}, "sweep.models, brush"),
    ],
)
def test_what_a_sweep_needs_of_the_wheel_is_refused(sweep: dict[str, Any], key: str) -> None:
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, _table() | {"sweep": sweep})
    assert told.value.key == key


def _of_the_rover(**more: object) -> Study:
    """The spiral wheel, which has no [wheel], under the rover."""
    table = _table() | {"rover": {"on_ancf_tires": "none"}, "full": {"orientation_step": "9 deg"}}
    table["mesh"] = table["mesh"] | {"repeats": 10} | more
    table["fe"] = table["fe"] | {"max_load": "250 N"}
    return study_of(SPIRAL, table)


def test_a_wheel_that_repeats_is_a_tire_by_the_curves_of_one_sector() -> None:
    """No deeper than its study says, and none the mirror image of another."""
    study = _of_the_rover()
    assert around(study) == Around(period=36.0, mirrored=False)
    values, tasks = solved_tire(study, "fe")
    assert (values["period_deg"], values["tips"]["height"]) == (36.0, 0.0)
    assert [one for one, _ in values["curves"]] == [0.0, 9.0, 18.0, 27.0]
    deep = [task for task in tasks if "deep" in task.name]
    assert len(deep) == 4
    assert {task.inputs["deflections"][-1] for task in deep} == {0.01}
    assert len(solved_tire(_of_the_rover(repeats=5), "fe")[0]["curves"]) == 8
    with pytest.raises(InputError, match=r"must divide 51\.4286 deg.*choose 8\.571428571 or 10\.28571429 deg"):
        solved_tire(_of_the_rover(repeats=7), "fe")


def test_what_repeats_and_a_rover_are_in_the_key_of_the_mesh() -> None:
    """Not where they are not given: what was kept holds."""
    plain, rover = own_mesh_task(_study(repeats=None)).inputs, own_mesh_task(_of_the_rover()).inputs
    assert "repeats" not in plain["mesh"]
    assert "rover_radius" not in plain
    assert (rover["mesh"]["repeats"], rover["rover_radius"]) == (10, rover_radius())


def test_the_rover_s_runs_are_planned() -> None:
    names = {task.name for task in report_tasks(_of_the_rover())}
    assert {"rover_straight", "rover_drop", "rover_step"} <= names


@pytest.mark.parametrize(
    ("found", "least", "words"),
    [
        (0.125, 0.125, "radius of the wheel's own mesh = 125 mm: is not that of the rover's wheels, 142.5 mm"),
        (0.1425, 0.1400, "ground faces of the wheel's own mesh = 140 mm: must reach equally far all around"),
    ],
)
def test_the_rover_stands_on_a_smooth_wheel_of_its_size(found: float, least: float, words: str) -> None:
    require_rover_wheel(0.1425, 0.14249, 0.1425)
    with pytest.raises(InputError) as told:
        require_rover_wheel(found, least, 0.1425)
    assert words in str(told.value)


def test_half_a_wheel_is_not_moved_sideways() -> None:
    with pytest.raises(StudyError) as told:
        _of_the_rover(symmetry="middle")
    assert (told.value.key, "half a wheel" in told.value.rule) == ("rover", True)
    with pytest.raises(InputError, match=r"mesh\.symmetry = middle: is half a wheel"):
        travel_tasks(_study(symmetry="middle"), "fe", (Way.LATERAL,), 40.0)


def test_of_a_full_study_the_step_alone_is_read() -> None:
    with pytest.raises(StudyError) as told:
        study_of(SPIRAL, _table() | {"full": {"orientation_step": "9 deg", "factor": 2.0}})
    assert (told.value.key, told.value.value) == ("full.factor", "2.0")


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
    with pytest.raises(StudyError, match=r"spiral.toml: mesh.file = .*the section model needs the dimensions"):
        run_calibrate(SPIRAL, "8 N/mm", tmp_path / "out.toml", tmp_path / "store", Computing(workers=1))


def test_faults_of_names_are_told_with_their_key() -> None:
    section = own_mesh(_study(ground=["tire"]))
    assert section is not None
    path, table = Path(section.file), section.model_dump(mode="json")
    with pytest.raises(InputError) as told:
        wheel_in(own_content(path, table), table, path)
    assert str(told.value).startswith(
        "mesh.ground: group of faces = tire: is no group of faces in the mesh file, which"
    )
