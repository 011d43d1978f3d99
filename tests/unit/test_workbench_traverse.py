"""The way between two samples: tasks, one stretch, the whole drive from its stretches, record, checks, evidence."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import InputError
from workbench.commands import traverse as command
from workbench.execution.result_files import read_result
from workbench.execution.task import task_keys
from workbench.execution.terminal import Terminal
from workbench.questions.kept import Kept
from workbench.questions.traverse.graph import Asked, stretch_name, traverse_tasks
from workbench.questions.traverse.question import TRAVERSE, HeldTraverse
from workbench.questions.traverse.results import found_of, run_of, traverse_of
from workbench.questions.traverse.task import drive_stretch
from workbench.report.page import page_environment
from workbench.study.reading import built_in_study, read_study

STUDY = read_study(built_in_study())
WHEELS = ["left", "right"]


def stretch(**values: Any) -> dict[str, Any]:
    """A result of a task, of a rover with two wheels: 20 m in 1000 s."""
    return {
        "rocks": 3,
        "tallest_m": 0.1,
        "avoided": 1,
        "yield_N": None,
        "ended": None,
        "time_s": 1000.0,
        "way_m": 20.0,
        "place_m": [20.0, 0.3],
        "energy_J": 400.0,
        "work_J": 300.0,
        "aside_m": 0.3,
        "lean_rad": 0.05,
        "loads_N": [300.0, 250.0],
        "deflections_m": [0.03, 0.025],
        "airborne": [0.01, 0.0],
        "over": None,
        "load": [[200.0, 300.0, 100.0, 200.0], [200.0]],
        "deflection": [[0.02, 0.03, 0.01, 0.02], [0.02]],
        **values,
    }


def held(*runs: Any, state: Any = "current", **asked: Any) -> HeldTraverse:
    found = json.loads(json.dumps(found_of(Asked(**asked), WHEELS, runs)))
    record = Kept(
        command="workbench traverse", inputs="", sources="", date="2026-11-28", machine="", wall_s=60.0, found=found
    )
    return HeldTraverse(record=record, state=state, traverse=traverse_of(found))


def test_the_way_is_cut_into_equal_stretches_of_their_own() -> None:
    asked = Asked(distance=50.0)
    tasks = traverse_tasks(STUDY, ["brush"], asked)
    assert [task.name for task in tasks] == [stretch_name("brush", k) for k in range(3)]
    assert {task.inputs["length"] for task in tasks} == {50.0 / 3.0}
    assert len(set(task_keys(tasks).values())) == 3
    assert (Asked().stretches, Asked().way.length) == (100, 20.0)
    on_wheel = traverse_tasks(STUDY, ["fe"], Asked(distance=10.0))
    assert {"fe_deep_phi000", "fe_fore_aft_phi000"} <= set(on_wheel[-1].needs) <= {task.name for task in on_wheel}
    assert on_wheel[-1].inputs["strengths"]["tire"] > 1e8


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"distance": -1.0}, r"distance = -1 m: must lie in \[0.1, 20000\] m"),
        ({"distance": math.nan}, "distance"),
        ({"distance": 1e-8}, "distance = 1e-08 m"),
        ({"abundance": 0.0}, "abundance = 0"),
        ({"abundance": 5e-324}, "abundance = 4.94066e-324"),
        ({"abundance": 0.5}, "abundance = 0.5"),
        ({"seed": -2}, "seed = -2"),
        ({"speed": 1.0}, "speed = 3600 m/h"),
    ],
)
def test_what_cannot_be_driven_is_refused(asked: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Asked(**asked)


def test_other_tires_and_a_study_without_rover_are_refused() -> None:
    with pytest.raises(InputError, match="'wood': is not known; give brush or fe"):
        traverse_tasks(STUDY, ["brush", "wood"], Asked())
    with pytest.raises(InputError, match=r"\[rover\]: is missing"):
        traverse_tasks(STUDY.model_copy(update={"rover": None}), ["brush"], Asked())


def test_a_stretch_gets_there_and_tells_what_its_wheels_carried(tmp_path: Path) -> None:
    task = traverse_tasks(STUDY, ["brush"], Asked(distance=1.0, abundance=0.2, speed=0.1))[0]
    drive_stretch(task.inputs, {}, tmp_path, lambda _: None)
    found = read_result(tmp_path)
    assert found["ended"] is None
    assert found["way_m"] == pytest.approx(1.0, abs=0.003)
    assert found["rocks"] > 0
    assert 0.0 < found["work_J"] < found["energy_J"]
    assert len(found["load"]) == len(found["deflection"]) == 6
    for largest, points in zip(found["loads_N"], found["load"], strict=True):
        assert 190.0 < max(points) <= largest
        assert largest - max(points) < 2.0  # the gate
    assert (found["yield_N"], found["over"]) == (None, None)


def test_the_drive_is_the_sum_of_its_stretches_and_its_loads_are_one_history() -> None:
    run = run_of("brush", [stretch(), stretch(time_s=3000.0, loads_N=[310.0, 200.0], airborne=[0.05, 0.0])])
    assert (run.reached, run.way, run.time, run.energy, run.stretches, run.ended) == (40.0, 40.0, 4000.0, 800.0, 2, 0)
    assert (run.energy_per_metre, run.work_per_metre) == (20.0, 15.0)
    assert (run.rocks, run.avoided, run.loads) == (6, 2, [310.0, 250.0])
    assert run.airborne == pytest.approx([0.04, 0.0])
    assert run.typical == pytest.approx([305.0, 309.5])
    assert (run.over, run.overloaded) == (None, None)
    loads = ([300.0, 250.0], [279.0, 280.0], [250.0, 281.0])
    on_wheel = run_of("fe", [stretch(yield_N=280.0, over=[0.02, 0.0], loads_N=each) for each in loads])
    assert (on_wheel.overloaded, on_wheel.stretches) == (2, 3)
    # 200 300 100 200 | 200 300 100 200: half cycles of 100, 200, 200, 200 and 100; apart each 100, 200, 100 twice
    assert run.load_cycles == [[0.0] * 5 + [1.0] + [0.0] * 4 + [1.5], []]
    assert run.ends == ""


def test_the_first_stretch_that_ends_it_ends_the_drive_and_the_others_are_counted() -> None:
    stops = stretch(ended={"cause": "friction", "words": ""}, way_m=5.0, time_s=1500.0, place_m=[5.0, -0.2])
    run = run_of("brush", [stretch(), stops, stretch(loads_N=[900.0, 900.0]), stops])
    assert (run.reached, run.way, run.stretches, run.ended, max(run.loads)) == (25.0, 50.0, 4, 2, 900.0)
    assert run.ends == (
        "ended after 25.0 m by wheels that turn without taking it there: stretch 2, at 1500 s, "
        "5.00 m ahead and -0.20 m aside of its start; 2 of 4 stretches end early"
    )
    broken = {k: v for k, v in stretch().items() if k in ("rocks", "tallest_m", "avoided", "yield_N")}
    run = run_of("brush", [broken | {"ended": {"cause": "computation", "words": "no step"}, "way_m": 0.0}])
    assert (run.way, run.energy_per_metre, run.loads) == (0.0, 0.0, [])
    assert "stretch 1, before it sets out" in run.ends


def test_checks_hold_the_way_against_two_kilometres_and_loads_against_yield() -> None:
    long = [stretch(way_m=1000.0)] * 2
    on_wheel = [stretch(way_m=1000.0, yield_N=280.0, over=[0.02, 0.0])] * 2
    checks = TRAVERSE.checks(STUDY, held(run_of("brush", long), run_of("fe", on_wheel)))
    assert {check.id: check.status for check in checks} == {
        "traverse.brush": "pass",
        "traverse.fe": "pass",
        "traverse.fe_strength": "fail",
    }
    assert {check.role for check in checks} == {"finding"}
    for asked, ended, status in (
        (100.0, None, "undecided"),
        (2000.0, {"cause": "computation", "words": ""}, "undecided"),
        (2000.0, {"cause": "stability", "words": ""}, "fail"),
    ):
        run = run_of("brush", [stretch(ended=ended)])
        assert TRAVERSE.checks(STUDY, held(run, distance=asked))[0].status == status
    stale = TRAVERSE.checks(STUDY, held(run_of("brush", long), state="stale"))
    assert stale[0].status == "undecided"


def test_what_is_no_record_is_refused() -> None:
    found = json.loads(json.dumps(found_of(Asked(), WHEELS, [run_of("brush", [stretch()])])))
    assert traverse_of(found).runs["brush"].way == 20.0
    run = found["runs"][0]
    for wrong in (
        {"runs": []},
        {"runs": [run, run]},
        {"runs": [dict(run, tire="wood")]},
        {"runs": [dict(run, cause="weather")]},
        {"runs": [dict(run, loads=[1.0])]},
        {"runs": [dict(run, way="far")]},
        {"runs": [dict(run, more=1)]},
        {"runs": [dict(run, cause="friction", stretch=1, moment=3.0, place=[1.0])]},
        {"runs": [dict(run, over=[0.1, 0.2])]},
        {"runs": [dict(run, first_yield=200.0)]},
        {"runs": [dict(run, overloaded=1)]},
        {"runs": [dict(run, time="nan")]},
        {"runs": [dict(run, lean=math.inf)]},
        {"runs": [dict(run, stretches=-7)]},
        {"runs": [dict(run, reached=1e30)]},
        {"runs": [dict(run, typical=[1.0])]},
        {"runs": [dict(run, time=-1.0)]},
        {"runs": [dict(run, load_cycles=[[-1.0], [1.0]])]},
        {"wheels": "lr"},
        {"asked": {"distance": -1.0}},
    ):
        with pytest.raises((ValueError, InputError)):
            traverse_of(found | wrong)


def test_the_evidence_tells_both_tires_and_draws_the_cycles() -> None:
    on_wheel = run_of("fe", [stretch(yield_N=280.0, over=[0.02, 0.0])])
    ends = run_of("brush", [stretch(ended={"cause": "stability", "words": ""})])
    results = held(ends, on_wheel, state="older sources")
    figures = TRAVERSE.figures(STUDY, results)
    text = page_environment().get_template("traverse/evidence.html.j2").render(results=results, figures=figures)
    told = (
        "20.0 J/m",
        "15.0 J/m",
        "300 N",
        "1 of 1, 2.000 %",
        "of 280 N",
        "lean of more than 30 degrees",
        "older sources",
    )
    for words in told:
        assert words in text, words
    assert "left, fe" in figures["traverse_cycles"]
    assert replace(results, state="stale").state == "stale"


def test_the_command_kept_makes_this_very_record_anew() -> None:
    """To the last digit: a command rounded to another one's would replace its record unsaid."""
    asked = Asked(distance=0.3000001, abundance=0.0600001)
    kept_as = command._again(None, ["brush"], asked)
    assert kept_as == "workbench traverse --tire brush --distance 0.3000001 --abundance 0.0600001"
    assert command._again(Path("a b.toml"), ["fe"], Asked()) == "workbench traverse 'a b.toml' --tire fe"


def test_what_is_printed_fits_a_narrow_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = Terminal(width=80, file=io.StringIO())
    monkeypatch.setattr(command, "console", narrow)
    on_wheel = run_of("fe", [stretch(yield_N=280.0, over=[0.02, 0.0])])
    command._print([run_of("brush", [stretch()]), on_wheel], Asked(distance=20.0))
    text = narrow.file.getvalue()
    for words in (
        "largest load of a wheel",
        "300 N",
        "20.0 J/m",
        "15.0 J/m",
        "2.000 %",
        "1 of 1",
        "rocks driven around",
    ):
        assert words in text, words
    assert "…" not in text
