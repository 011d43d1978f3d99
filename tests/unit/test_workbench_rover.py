"""The question of the rover: tasks, files, checks, figures, section."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from contracts.records import Check
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from workbench.execution.result_files import read_result
from workbench.questions.rover.question import CLOSED_FORMS, MISSION, ROVER, THESIS, RoverResults
from workbench.questions.rover.task import drive_rover
from workbench.report.page import TEMPLATES, page_environment
from workbench.report.series import series_files
from workbench.study.model_parameters import rover_on_brush
from workbench.study.reading import built_in_study, read_study


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> RoverResults:
    """Computed as the report does; stability without its directions."""
    study, folders = read_study(built_in_study()), dict[str, Path]()
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(SCENARIOS, "stability", replace(SCENARIOS["stability"], study=None))
        for task in (one for one in ROVER.tasks(study) if "scenario" in one.inputs):
            folders[task.name] = tmp_path_factory.mktemp(task.name)
            assert drive_rover(task.inputs, {}, folders[task.name], lambda fraction: None) == 6 * 22
    folders["rover_still"] = tmp_path_factory.mktemp("still")
    Image.new("RGB", (4, 3)).save(folders["rover_still"] / "rover.png")
    found = ROVER.read(study, folders)
    assert isinstance(found, RoverResults)
    return found


def _checks(results: RoverResults) -> dict[str, Check]:
    checks = ROVER.checks(read_study(built_in_study()), results)
    return {check.id: check for check in checks}


def test_every_scenario_of_the_catalogue_is_in_the_report() -> None:
    assert list(SCENARIOS) == [*THESIS, *MISSION]


def test_gate_and_closed_forms_hold(results: RoverResults) -> None:
    checks = _checks(results)
    gates = [name.removeprefix("rover.") for name, check in checks.items() if check.role == "gate"]
    assert gates == ["load", "drop", "drop_printed", "traction", "traction_wheel", "table_rigid"]
    for name in (*gates, "table_brush", "speed"):
        assert checks[f"rover.{name}"].status == "pass", name


@pytest.mark.parametrize(("name", "scenario"), [(row[0], row[1]) for row in CLOSED_FORMS] + [("table_rigid", "static")])
def test_two_percent_off_are_seen(results: RoverResults, name: str, scenario: str) -> None:
    """Negative control of every gate."""
    before = results[scenario]
    off = tuple(replace(one, value=1.02 * one.value) for one in before.outcomes)
    damaged = replace(results, by_name={**results.by_name, scenario: replace(before, outcomes=off)})
    assert _checks(damaged)[f"rover.{name}"].status == "fail"
    empty = replace(results, by_name={**results.by_name, scenario: replace(before, outcomes=(), stopped="fell")})
    assert _checks(empty)[f"rover.{name}"].status == "error"


def test_what_holds_on_table_twos_tire_only_is_a_gate_on_it_only(results: RoverResults) -> None:
    other = replace(results, tire=replace(results.tire, radial_damping=1.0))
    assert (results.on_table_two, other.on_table_two) == (True, False)
    gates = [name for name, check in _checks(other).items() if check.role == "gate"]
    assert gates == ["rover.load", "rover.drop", "rover.table_rigid"]
    assert results.first_touch == pytest.approx(2217.6, abs=0.1)


def test_each_requirement_is_a_finding_and_one_without_a_number_an_error(results: RoverResults) -> None:
    checks = _checks(results)
    assert {f"rover.mission_{name}" for name in MISSION} < set(checks)
    assert checks["rover.mission_step"].value == 6.0
    assert checks["rover.mission_stability"].status == "error"  # its study was left out here


def test_a_requirement_that_is_missed_is_said_so(results: RoverResults) -> None:
    """Negative control."""
    step = results["step"]
    four = tuple(replace(o, value=4.0) if o.limit is not None else o for o in step.outcomes)
    damaged = replace(results, by_name={**results.by_name, "step": replace(step, outcomes=four)})
    check = _checks(damaged)["rover.mission_step"]
    assert (check.status, check.role) == ("fail", "finding")
    light = results["static"]
    wrong = tuple(replace(o, value=0.99 * o.value) for o in light.outcomes)
    damaged = replace(results, by_name={**results.by_name, "static": replace(light, outcomes=wrong)})
    assert _checks(damaged)["rover.load"].status == "fail"


def test_the_torque_of_the_drives_is_held_against_the_only_published_one(results: RoverResults) -> None:
    check = _checks(results)["rover.torque_step"]
    assert (check.status, check.role, check.reference) == ("fail", "finding", 3.5)
    step = results["step"]
    weak = tuple(replace(o, value=3.0) if o.quantity == "largest torque of a drive" else o for o in step.outcomes)
    mild = replace(results, by_name={**results.by_name, "step": replace(step, outcomes=weak)})
    assert _checks(mild)["rover.torque_step"].status == "pass"


def test_series_and_figures_of_the_section_exist(results: RoverResults) -> None:
    study = read_study(built_in_study())
    published = series_files(ROVER.series(study, results))
    assert set(published) == {f"{name}_brush.csv" for name in SCENARIOS}
    parts = (TEMPLATES[1] / "rover" / f"{name}.html.j2" for name in ("section", "evidence"))
    text = "".join(part.read_text(encoding="utf-8") for part in parts)
    assert set(re.findall(r"figures\.(\w+)", text)) == set(ROVER.figures(study, results))


def test_the_evidence_shows_the_other_code_and_what_hangs_on_the_lever(results: RoverResults) -> None:
    template = page_environment().get_template("rover/evidence.html.j2")
    nothing: defaultdict[str, str] = defaultdict(str)
    text = str(template.render(results=results, figures=nothing, series=nothing))
    assert results.peer is not None
    for words in ("EXUDYN 1.", "braked on 25 degrees up", "lever R - d", "make bench NAME=rover_exudyn"):
        assert words in text, words
    assert "in another code" not in str(
        template.render(results=replace(results, peer=None), figures=nothing, series=nothing)
    )
    assert {check.id for check in ROVER.checks(read_study(built_in_study()), results)} >= {"rover.exudyn_rest_up_loads"}


def test_a_task_writes_its_outcomes(tmp_path: Path) -> None:
    drive_rover(
        {"scenario": "traction", **rover_on_brush(read_study(built_in_study()))}, {}, tmp_path, lambda fraction: None
    )
    result = read_result(tmp_path)
    assert result["failure"] is None
    assert result["outcomes"][0]["unit"] == "N"
