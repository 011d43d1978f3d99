"""``workbench mission`` as a user runs it: a record of two kinds of tire, its section in the report, bad input."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from tests.end_to_end.small_study import run, said, small_study_text
from workbench.questions.rover_mission.requirements import MISSION
from workbench.questions.rover_mission.results import mission_of

type Driven = tuple[Path, list[subprocess.CompletedProcess[str]]]


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """Folder with study and record, two runs on one store."""
    folder = tmp_path_factory.mktemp("mission")
    study = folder / "own.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    command = ("mission", study, "--tire", "rigid", "--store", folder / "store")
    return folder, [run(*command) for _ in range(2)]


def test_the_record_holds_every_requirement_and_a_second_run_drives_nothing(driven: Driven) -> None:
    folder, (first, again) = driven
    assert first.returncode == again.returncode == 0, first.stderr
    assert "mission on rigid wheels" in first.stdout
    assert first.stdout.count(": computed in") == len(MISSION)
    assert again.stdout.count(": computed in") == 0
    record = json.loads((folder / "own.kept" / "mission.json").read_text(encoding="utf-8"))
    assert record["command"] == f"workbench mission {folder / 'own.toml'} --tire rigid"
    mission = mission_of(record["found"])
    assert (mission.tires, tuple(mission.scenarios), mission.wheel) == (["rigid"], MISSION, None)
    assert mission.cells["rigid", "step"].decided == "met"
    assert mission.cells["rigid", "step"].least is None  # searched on brush and the solid wheel alone


@pytest.mark.long
def test_on_brush_tires_torque_and_friction_are_searched(driven: Driven) -> None:
    folder, _ = driven
    ended = run("mission", folder / "own.toml", "--tire", "brush", "--tire", "rigid", "--store", folder / "store")
    assert ended.returncode == 0, ended.stderr
    record = json.loads((folder / "own.kept" / "mission.json").read_text(encoding="utf-8"))
    assert record["command"] == f"workbench mission {folder / 'own.toml'} --tire rigid --tire brush"
    mission = mission_of(record["found"])
    assert (mission.tires, tuple(mission.scenarios), mission.wheel) == (["rigid", "brush"], MISSION, None)
    step = mission.cells["brush", "step"]
    assert step.decided == "met"
    assert step.least is not None
    assert step.unlimited is not None
    assert step.least.torque < step.unlimited.torque


def test_what_cannot_be_driven_is_one_message(tmp_path: Path) -> None:
    study = tmp_path / "own.toml"
    study.write_text(small_study_text(), encoding="utf-8")
    for tires in (("--tire", "wood"), ("--tire", "brush", "--tire", "wood")):
        found = said("mission", study, *tires)
        assert found.returncode == 2
        assert "tire of the mission = 'wood': is not known; give of rigid, brush" in found.stderr
    assert not (tmp_path / "own.kept").exists()
    study.write_text(re.sub(r"(?m)^\[rover\]\n(?:[^\[\n].*\n)*", "", small_study_text()), encoding="utf-8")
    found = said("mission", study, "--tire", "brush")
    assert (found.returncode, "own.toml: [rover]: is missing" in found.stderr) == (2, True), found.stderr


@pytest.mark.parametrize("command", ["mission", "check", "report"])
def test_what_is_no_record_is_told_before_anything_runs_and_stays(tmp_path: Path, command: str) -> None:
    study, record = tmp_path / "own.toml", tmp_path / "own.kept" / "mission.json"
    study.write_text(small_study_text(), encoding="utf-8")
    record.parent.mkdir()
    for text in ('{"mine": 1}', '{"command": "workb', ""):
        record.write_text(text, encoding="utf-8")
        found = said(command, study, folder=tmp_path)
        assert (found.returncode, found.stdout) == (2, ""), found.stderr
        assert "mission.json: cannot be read" in found.stderr
        assert found.stderr.count("error:") == 1
        assert record.read_text(encoding="utf-8") == text
