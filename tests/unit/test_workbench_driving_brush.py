"""The brush tire that drives: that of [brush], or the wheel's own from the record beside the study, if it is of it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.tires.brush_settings import BrushSettings, Carcass, yielding
from rover_dynamics.tires.brush_tire import THESIS_BRUSH
from workbench.commands.rover_tires import TireSource, on_tires
from workbench.execution.result_files import read_result
from workbench.questions.kept import keep
from workbench.questions.models.driving_brush import RECORD, calibration_tasks, driving_brush, driving_inputs
from workbench.questions.rover.brush import on_given_brush
from workbench.questions.rover.question import ROVER
from workbench.questions.rover.task import drive_rover
from workbench.questions.rover_closer.question import ROVER_CLOSER
from workbench.questions.rover_mission.graph import mission_tasks
from workbench.study.full import full_study
from workbench.study.model import Study
from workbench.study.model_parameters import rover_on_brush
from workbench.study.orientation import degrees
from workbench.study.reading import built_in_study, read_study

RADIAL, CARCASS = 8.1e3, (2.8e3, 13.6e3)
DESIGN = read_rover()


@pytest.fixture
def study(tmp_path: Path) -> Study:
    """The built-in study, driven by its wheel, of which nothing is kept."""
    path = tmp_path / "own.toml"
    text = built_in_study().read_text(encoding="utf-8")
    assert text.count('\nbrush = "study"') == 1
    path.write_text(text.replace('\nbrush = "study"', '\nbrush = "wheel"'), encoding="utf-8")
    return read_study(path)


def kept_numbers(study: Study, **other: Any) -> Path:
    """A record as the command keeps it."""
    asked = [degrees(o) for o in study.fe.orientations]
    numbers = dict(zip(("forward_N_per_m", "sideways_N_per_m"), CARCASS, strict=True)) | {"radial_N_per_m": RADIAL}
    found = {"model": "ancf_wheel", "load_N": 200.0, "orientations_deg": asked, **numbers, **other}
    return keep(study, RECORD, "make numbers", calibration_tasks(study, "ancf_wheel", 200.0, asked), 1.0, found)


def test_without_a_word_the_studys_own_numbers_drive() -> None:
    """To the last letter: what was driven before is found again."""
    plain = read_study(built_in_study())
    assert driving_inputs(plain) == rover_on_brush(plain)
    assert driving_brush(plain).carcass is None


def test_numbers_that_are_not_kept_are_asked_for(study: Study, tmp_path: Path) -> None:
    told = rf'rover.brush = "wheel": has no numbers.* run workbench calibrate brush {tmp_path / "own.toml"}'
    with pytest.raises(InputError, match=told):
        driving_brush(study)
    with pytest.raises(InputError, match="run workbench calibrate brush"):
        ROVER.tasks(study)


def test_the_wheels_numbers_drive_with_what_the_study_says_of_tire_and_ground(study: Study) -> None:
    kept_numbers(study)
    icy = study.model_copy(update={"brush": study.brush.model_copy(update={"friction_max": 0.7})})
    tire, carcass = driving_brush(icy)
    assert carcass == CARCASS
    assert replace(tire, source="") == replace(THESIS_BRUSH, radial_stiffness=RADIAL, friction_max=0.7, source="")
    assert "make numbers" in tire.source
    other = study.model_copy(update={"brush": study.brush.model_copy(update={"radial_stiffness": 1e4})})
    assert driving_inputs(other) == driving_inputs(study)


def test_a_record_of_another_wheel_is_refused_and_one_of_the_fine_study_is_not(study: Study) -> None:
    kept_numbers(study)
    assert driving_brush(full_study(study)).carcass == CARCASS
    thinner = study.wheel.model_copy(update={"tire": study.wheel.tire.model_copy(update={"thickness": 0.9e-3})})
    with pytest.raises(InputError, match=r"of another wheel than the study's is now; run workbench calibrate brush "):
        driving_brush(study.model_copy(update={"wheel": thinner}))
    light = study.model_copy(update={"fe": study.fe.model_copy(update={"max_load": 150.0})})
    again = r"of another wheel than the study's is now; run .* brush .*own.toml --model ancf_wheel --load 200"
    with pytest.raises(InputError, match=again):
        driving_brush(light)


@pytest.mark.parametrize(
    "damage",
    [
        {"radial_N_per_m": 0.0},
        {"radial_N_per_m": 1e300},
        {"radial_N_per_m": True},
        {"forward_N_per_m": None},
        {"forward_N_per_m": "nan"},
        {"load_N": -1.0},
        {"load_N": 10**400},
        {"model": "wood"},
        {"orientations_deg": 5},
        {"orientations_deg": ["x"]},
    ],
)
def test_a_record_that_makes_no_tire_is_told(study: Study, damage: dict[str, Any]) -> None:
    path = kept_numbers(study)
    record = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(record | {"found": record["found"] | damage}), encoding="utf-8")
    with pytest.raises(InputError, match=r"kept record.*brush.json.*cannot be read"):
        driving_brush(study)


def test_it_reaches_every_run_on_brush_tires_and_no_other(study: Study) -> None:
    kept_numbers(study)
    driven = [t for question in (ROVER, ROVER_CLOSER) for t in question.tasks(study) if "brush" in t.inputs]
    assert len(driven) == len(SCENARIOS) + 1
    for task in (*driven, *mission_tasks(study, ["brush"])):
        assert (task.inputs["carcass"], task.inputs["brush"]["radial_stiffness"]) == (list(CARCASS), RADIAL)
    for task in mission_tasks(study, ["rigid", "ancf"]):
        assert "carcass" not in task.inputs
        assert task.inputs["brush"]["radial_stiffness"] == 8250.0


def test_command_and_report_drive_on_the_same_tire(study: Study) -> None:
    """And rigid wheels on none of it: they need no record."""
    source = TireSource(study=study, path=None, store=Path("nowhere"))
    rigid = on_tires(SCENARIOS["slope_up"], "rigid", source, DESIGN)
    assert rigid.settings == on_tires(SCENARIOS["slope_up"], "rigid", replace(source, study=None), DESIGN).settings
    kept_numbers(study)
    by_name = on_tires(SCENARIOS["slope_up"], "brush", source, DESIGN)
    by_task = on_given_brush(SCENARIOS["slope_up"], json.loads(json.dumps(driving_inputs(study))))
    assert replace(by_name.tire, source="") == replace(by_task.tire, source="")
    assert by_name.settings == by_task.settings == yielding(BrushSettings(), by_name.tire, Carcass(*CARCASS))
    assert by_name.tire_model == "brush"


@pytest.mark.parametrize("scenario", ["static", "drop"])
def test_what_holds_on_every_brush_tire_holds_on_it(study: Study, scenario: str, tmp_path: Path) -> None:
    """Closed forms that are gates of the report: load at rest, rigid wheels beside it, one wheel dropped."""
    kept_numbers(study)
    drive_rover({"scenario": scenario, **driving_inputs(study)}, {}, tmp_path, lambda fraction: None)
    outcomes = read_result(tmp_path)["outcomes"]
    held = {"static": ("mean wheel load at the end", "rigid tires"), "drop": ("largest wheel load",)}[scenario]
    rows = [one for one in outcomes if one["quantity"].startswith(held) and one["reference"] is not None]
    assert rows
    for one in rows:
        assert one["value"] == pytest.approx(one["reference"], rel=1e-3, abs=0.06)
