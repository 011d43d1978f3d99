"""Records of named commands: kept beside the study, told apart once what they are about has changed."""

from __future__ import annotations

import json
import math
import os
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from workbench.execution.task import Task
from workbench.questions.crosscheck.results import crosscheck_tasks
from workbench.questions.kept import Kept, keep, kept, keys_of, replaced, require_place
from workbench.questions.rover_mission.graph import mission_tasks
from workbench.questions.rover_mission.question import ROVER_MISSION
from workbench.questions.traverse.graph import Asked, traverse_tasks
from workbench.questions.traverse.question import TRAVERSE
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study

TASKS = [
    Task(name="a", function="workbench.questions.section.task:solve_orientation", inputs={"x": 1.0}),
    Task(name="b", function="workbench.questions.section.task:solve_orientation", inputs={"x": 2.0}),
]


@pytest.fixture
def study(tmp_path: Path) -> Study:
    path = tmp_path / "own.toml"
    path.write_text(built_in_study().read_text(encoding="utf-8"), encoding="utf-8")
    return read_study(path)


def record(study: Study) -> Kept:
    found = kept(study, "sample")
    assert found is not None
    return found


def test_a_record_lies_beside_the_study_and_comes_back(study: Study, tmp_path: Path) -> None:
    assert kept(study, "sample") is None
    path = keep(study, "sample", "make sample", TASKS, 12.34, {"load_N": [1.0, 2.5], "words": "ä"})
    assert path == tmp_path / "own.kept" / "sample.json"
    found = record(study)
    assert (found.command, found.wall_s, found.found) == ("make sample", 12.3, {"load_N": [1.0, 2.5], "words": "ä"})


def test_it_is_current_for_the_same_tasks_in_any_order_only(study: Study) -> None:
    keep(study, "sample", "make sample", TASKS, 1.0, {})
    found = record(study)
    assert found.state(TASKS) == found.state(TASKS[::-1]) == "current"
    other = replace(TASKS[1], inputs={"x": 2.1})
    assert found.state([TASKS[0], other]) == found.state(TASKS[:1]) == "stale"
    assert replace(found, sources="0").state(TASKS) == "older sources"


def test_it_is_stale_where_the_study_has_no_such_tasks_any_more(study: Study) -> None:
    def none() -> list[Task]:
        raise InputError("load", "200 N", "must lie below 150 N", "change it")

    keep(study, "sample", "make sample", TASKS, 1.0, {})
    assert record(study).state_of(none) == "stale"
    assert record(study).state_of(lambda: TASKS) == "current"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('max_load = "320 N"', 'max_load = "150 N"'),
        ('obstacle = { shape = "plane" }', 'obstacle = { shape = "half_round_rock", radius = "20 mm" }'),
    ],
)
def test_the_records_of_a_study_changed_so_that_none_could_be_made_are_stale(
    tmp_path: Path, old: str, new: str
) -> None:
    """A report had ended in an error after all was computed."""
    built_in, path = read_study(built_in_study()), tmp_path / "exomars.toml"
    shutil.copytree(built_in_study().with_suffix(".kept"), tmp_path / "exomars.kept")
    text = built_in_study().read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    other = read_study(path)
    for name, tasks in (
        ("mission", lambda study: mission_tasks(study, ("rigid", "fe"))),
        ("traverse", lambda study: traverse_tasks(study, ("fe",), Asked())),
        ("crosscheck", lambda study: crosscheck_tasks(study, [0.0])),
    ):
        found = kept(built_in, name)
        assert found is not None
        with pytest.raises(InputError):
            tasks(other)
    for question in (ROVER_MISSION, TRAVERSE):
        assert question.read(other, {}).state == "stale"


def test_names_and_costs_are_no_part_of_the_key() -> None:
    assert keys_of([replace(t, name=f"p/{t.name}", cost=9.0) for t in TASKS]) == keys_of(TASKS)


@pytest.mark.parametrize("text", ["", "{}", "[1]", "NaN", '{"command": 1, "odd": 2}', "[" * 100_000])
def test_a_file_that_is_no_record_is_told(study: Study, text: str) -> None:
    path = keep(study, "sample", "make sample", TASKS, 1.0, {})
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="cannot be read"):
        kept(study, "sample")


def test_a_copy_of_a_study_keeps_its_folder(study: Study) -> None:
    changed = study.model_copy(update={"title": "another"})
    assert changed.kept == study.kept is not None


@pytest.mark.parametrize(
    "damage",
    [
        {"date": 5},
        {"found": None},
        {"wall_s": "x"},
        {"wall_s": -1},
        {"found": {"load_N": {}}},
        {"found": {"load_N": []}},
        {"found": {}},
        {"found": {"load_N": [2.0], "odd": math.nan}},
        {"schema": 7},
    ],
)
def test_a_record_that_its_question_cannot_read_is_told(study: Study, damage: dict[str, Any]) -> None:
    """Negative control: the record as it was kept is read."""
    path = keep(study, "sample", "make sample", TASKS, 1.0, {"load_N": [2.0]})
    whole = json.loads(path.read_text(encoding="utf-8"))

    def understand(found: Mapping[str, Any]) -> float:
        return 1.0 / float(found["load_N"][0])

    assert kept(study, "sample", understand) is not None
    path.write_text(json.dumps(whole | damage), encoding="utf-8")
    with pytest.raises(InputError, match=r"kept record.*sample.json.*cannot be read"):
        kept(study, "sample", understand)


@pytest.mark.parametrize("place", ["own.kept", "own.kept/sample.json"])
def test_what_lies_in_a_records_place_and_is_none_is_told(study: Study, tmp_path: Path, place: str) -> None:
    """A broken link; as the folder and as the file in it."""
    if "/" in place:
        (tmp_path / "own.kept").mkdir()
    (tmp_path / place).symlink_to(tmp_path / "nowhere")
    with pytest.raises(InputError, match="is not what it should be"):
        kept(study, "sample")


def test_a_folder_in_a_records_place_is_told(study: Study, tmp_path: Path) -> None:
    (tmp_path / "own.kept" / "sample.json").mkdir(parents=True)
    with pytest.raises(InputError, match="is not what it should be"):
        kept(study, "sample")


@pytest.mark.parametrize("number", ["1e999", "-1e999", "Infinity"])
def test_no_number_of_a_record_is_infinite(study: Study, number: str) -> None:
    path = keep(study, "sample", "make sample", TASKS, 1.0, {"x": 0.5})
    path.write_text(path.read_text(encoding="utf-8").replace("0.5", number), encoding="utf-8")
    with pytest.raises(InputError, match="is no finite number"):
        kept(study, "sample")


def test_a_record_takes_the_place_of_a_record_only(study: Study) -> None:
    """Somebody's file of that name stays as it is."""
    path = keep(study, "sample", "make sample", TASKS, 1.0, {})
    keep(study, "sample", "make sample", TASKS, 2.0, {})
    assert record(study).wall_s == 2.0
    path.write_text('{"mine": 1}', encoding="utf-8")
    for attempt in (lambda: require_place(study, "sample"), lambda: keep(study, "sample", "", TASKS, 1.0, {})):
        with pytest.raises(InputError, match=r"sample.json: cannot be read.*move it away"):
            attempt()
    assert path.read_text(encoding="utf-8") == '{"mine": 1}'


def test_a_record_is_written_whole_or_not_at_all(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    path = keep(study, "sample", "make sample", TASKS, 1.0, {})
    before = path.read_text(encoding="utf-8")

    def full(file: Path, text: str, encoding: str) -> None:
        file.write_bytes(text.encode(encoding)[:20])
        raise OSError("no space left")

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(OSError, match="no space left"):
        keep(study, "sample", "make sample", TASKS, 2.0, {})
    assert path.read_text(encoding="utf-8") == before
    assert [one.name for one in path.parent.iterdir()] == ["sample.json"]


def test_a_folder_that_cannot_be_written_is_told_before_anything_runs(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert study.kept is not None
    assert require_place(study, "sample") == study.kept / "sample.json"
    assert not study.kept.exists()
    monkeypatch.setattr(os, "access", lambda place, mode: False)
    with pytest.raises(InputError, match=r"folder of kept records = .*: cannot be written"):
        require_place(study, "sample")


def test_before_a_record_of_another_command_is_replaced_that_is_said(study: Study) -> None:
    """Not where there is none, for the same command on a changed study, and for the same tasks by other words."""
    other = TASKS[:1]
    assert replaced(study, "sample", "make sample", TASKS) == []
    path = keep(study, "sample", "make sample", TASKS, 1.0, {})
    assert replaced(study, "sample", "make sample", other) == []
    assert replaced(study, "sample", "workbench sample own.toml", TASKS) == []
    (said,) = replaced(study, "sample", "workbench sample --few", other)
    assert "`make sample`" in said
    assert str(path) in said
