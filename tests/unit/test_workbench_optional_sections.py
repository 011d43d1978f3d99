"""Wheel, materials, mesh and continuum runs are enough of a study; every other section adds what it asks for."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomlkit

from contracts.errors import InputError, StudyError
from workbench.commands.calibrate import run_calibrate
from workbench.execution.runner import Computing
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.fe.checks import overlap_checks
from workbench.questions.model_curves import ModelCurves
from workbench.questions.registry import questions_of
from workbench.questions.study_graph import report_tasks
from workbench.report.chosen import chosen_groups
from workbench.report.contents import section_titles
from workbench.study.full import full_study
from workbench.study.model import Study
from workbench.study.reading import built_in_study, study_of
from workbench.study.sweep_points import sweep_points

ENOUGH = {"name", "title", "wheel", "materials", "mesh", "fe"}
ALWAYS = {"models", "wheel", "fe", "orientations", "strength", "section", "numerics", "crosscheck"}
"""The last one because of the record beside the built-in study's file."""
OTHERS = {"mesh", "mesh_whole", "metrics", "pictures", "parts_overlap"}
ADDED = {
    "ancf": {"ancf", "ancf_mesh", "ancf_dynamics"},
    "brush": set(),
    "mesh_study": {"mesh_study"},
    "hub_study": {"hub"},
    "soil": {"soil"},
    "ancf_wheel": {"ancf_wheel"},
    "penalty_study": {"contact"},
    "input_uncertainty": {"input_uncertainty"},
    "verification": {"multibody", "verification", "speed"},
    "environment": {"environment"},
    "rover": {"rover", "rover_ancf", "rover_mission", "traverse"},
    "full": set(),
    "reference": {"ancf_wheels", "validation"},
    "tolerances": set(),
    "inferred": set(),
}
"""Section of the built-in study that stands by itself -> the questions it adds."""


def _table() -> dict[str, Any]:
    return tomllib.loads(built_in_study().read_text(encoding="utf-8"))


def _study(*sections: str) -> Study:
    table = {"full": {}} | _table()
    return study_of(built_in_study(), {name: table[name] for name in (*ENOUGH, *sections)})


def _tasks(study: Study) -> set[str]:
    return {task.name for task in report_tasks(study)}


def test_every_other_section_of_the_built_in_study_is_known_here() -> None:
    assert _table().keys() | {"full"} == ENOUGH | ADDED.keys() | {"ancf_fit"}


def test_the_wheel_alone_is_meshed_and_solved_and_nothing_else() -> None:
    study = _study()
    assert {question.name for question in questions_of(study)} == ALWAYS
    assert all(name.startswith(("fe_phi", "footprint_phi", "section_")) for name in _tasks(study) - OTHERS)
    assert "ancf" not in section_titles(study)
    assert {group.title for group in chosen_groups(study)} == {"What curves are held against", "Continuum model"}


@pytest.mark.parametrize("section", ADDED)
def test_a_section_adds_what_it_asks_for(section: str) -> None:
    alone, more = _study(), _study(section)
    assert {t.name for t in questions_of(more)} - {t.name for t in questions_of(alone)} == ADDED[section]
    assert {t.name for t in questions_of(alone)} <= {t.name for t in questions_of(more)}
    assert _tasks(alone) <= _tasks(more)
    idle = ("full", "reference", "tolerances", "inferred", "input_uncertainty")
    assert (_tasks(more) > _tasks(alone)) == (section not in idle)
    full_study(more)


@pytest.mark.parametrize(("present", "missing"), [("mesh_study", "ancf"), ("ancf", "mesh_study")])
def test_a_fit_needs_a_tire_and_the_uncertainty_of_the_curves(present: str, missing: str) -> None:
    with pytest.raises(StudyError, match=rf"ancf_fit.* needs \[{missing}\]"):
        _study("ancf_fit", present)


@pytest.mark.parametrize("model", ["ancf", "brush"])
def test_a_model_the_study_does_not_have_is_refused(model: str) -> None:
    with pytest.raises(InputError, match=rf"\[{model}\]: is not in the study"):
        stiffness_tasks(_study(), model, ())


def test_a_study_without_reference_names_its_own_slope_to_calibrate(tmp_path: Path) -> None:
    table = {name: value for name, value in _table().items() if name in ENOUGH}
    path = tmp_path / "study.toml"
    path.write_text(tomlkit.dumps(table), encoding="utf-8")
    with pytest.raises(InputError, match=r"target.* is missing, and the study has no \[reference\] slope"):
        run_calibrate(path, None, tmp_path / "out", tmp_path / "store", Computing())


def test_reach_is_asked_of_the_wheel_of_the_thesis_and_where_a_study_says_so() -> None:
    """ExoMars' numbers judge no other wheel."""
    assert (_study().reference, _study().asks_for_reach) == (None, False)
    assert _study("reference").asks_for_reach
    table = _table()
    del table["reference"]
    table["tolerances"] = {"reach_load": "100 N"}
    assert study_of(built_in_study(), table).asks_for_reach


def test_loads_beyond_what_the_runs_are_to_carry_are_not_judged() -> None:
    table = _table()
    table["fe"] |= {"max_load": "100 N", "snapshot_loads": []}
    thesis = study_of(built_in_study(), table)
    assert (thesis.judged_load, thesis.judged_deflection) == (250.0, math.inf)
    del table["reference"]
    other = study_of(built_in_study(), table)
    assert (other.judged_load, other.judged_deflection) == (100.0, 0.040)


def test_rover_and_wheel_stay_apart() -> None:
    """A study of another wheel computes nothing of the ExoMars rover."""
    amalia = built_in_study().with_name("amalia.toml")
    study = study_of(amalia, tomllib.loads(amalia.read_text(encoding="utf-8")))
    assert not [name for name in _tasks(study) if "rover" in name or name.startswith(("ancf", "brush"))]
    assert "rover" not in json.dumps([group.title for group in chosen_groups(study)]).lower()


def test_an_overlap_is_judged_at_the_loads_that_are_asked_for() -> None:
    """The two loads of the sweep, or what the study asks for where that is less."""
    from tests.unit.test_workbench_limits import model

    curves: ModelCurves = model({0.0: 8000.0})
    named = [[c.id for c in overlap_checks(curves, inner_contact=True, up_to=load)] for load in (300.0, 200.0, 100.0)]
    start = "fe.spring_rim_overlap_"
    assert named == [[f"{start}160N", f"{start}250N"], [f"{start}160N", f"{start}200N"], [f"{start}100N"]]


def test_the_rover_stands_on_no_wheel_of_another_size() -> None:
    table = _table() | {"name": "larger"}
    table = {name: table[name] for name in (*ENOUGH, "rover")}
    table["wheel"]["tire"]["outer_radius"] = "143 mm"
    with pytest.raises(StudyError, match=r"rover.* is for a wheel of radius 142\.5 mm, the study's has 143 mm"):
        study_of(built_in_study(), table)


def test_a_rover_without_tires_of_the_study_s_own_has_the_thesis() -> None:
    """What a study does not state is the thesis'."""
    own = {t.name: t.key(dict.fromkeys(t.needs, "")) for t in report_tasks(_study("rover", "ancf", "brush"))}
    without = {t.name: t.key(dict.fromkeys(t.needs, "")) for t in report_tasks(_study("rover"))}
    rover = [name for name in without if name.startswith("rover_")]
    assert len(rover) > 20
    assert {name: own[name] for name in rover} == {name: without[name] for name in rover}


@pytest.mark.parametrize(
    ("sweep", "key"),
    [
        ({"strip_thickness": ["0.5 mm"], "models": ["ancf"]}, "sweep.models, ancf"),
        ({"strip_thickness": ["0.5 mm"], "models": ["brush"]}, "sweep.models, brush"),
        ({"plates": [4, 8]}, "sweep.plates"),
    ],
)
def test_a_sweep_of_what_the_study_does_not_have_is_refused(sweep: dict[str, Any], key: str) -> None:
    table = {name: value for name, value in _table().items() if name in ENOUGH} | {"sweep": sweep}
    with pytest.raises(StudyError, match=f"{key}.* needs"):
        sweep_points(built_in_study(), table)
