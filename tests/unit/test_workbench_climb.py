"""The rover's slopes on soil: what a record says, when it is of another study, and what its drives are given.

Claims: the steepest slope lies between two drives, by a line; a record follows the study, its soils and its rim; the
task tells slip and energy of the drive it makes. Negative controls: a rover that slips from the start climbs nothing; a
changed wheel makes the record stale.
"""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.rover.scenarios.scenario import Scenario
from soil.carcass import RIGID
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil
from workbench.commands.climb import _print
from workbench.commands.steps import steps_of
from workbench.execution.result_files import read_result
from workbench.questions.kept import keep
from workbench.questions.soil import climb_task
from workbench.questions.soil.climb import RECORD, Climb, Climbs, climb_tasks, climbs_of, found_of
from workbench.questions.soil.held_climbs import held_climbs, rim_and_settling
from workbench.questions.soil.question import _rover
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study


def climbs(slips: list[float | None], soil: str = "ding2011") -> Climbs:
    """Upwards at 0, 5, 10 degrees."""
    rows = tuple(
        Climb(angle_deg=5.0 * k, slip=s, energy=None if s is None or s >= 1.0 else 100.0) for k, s in enumerate(slips)
    )
    return Climbs(soil=soil, tire="rigid", direction="up", rows=rows)


@pytest.mark.parametrize(
    ("slips", "steepest"),
    [([0.0, 0.2, 1.0], 7.5), ([0.0, 0.1, 0.2], 10.0), ([0.7, 0.8, 0.9], 0.0), ([0.0, None, 0.1], 0.0)],
)
def test_the_steepest_slope_lies_between_two_drives(slips: list[float | None], steepest: float) -> None:
    assert climbs(slips).steepest == pytest.approx(steepest)


def test_a_slope_beyond_those_driven_is_a_bound_and_decides_nothing() -> None:
    open_end, ends = climbs([0.0, 0.1, 0.2]), climbs([0.0, 0.2, 1.0])
    assert (open_end.shown, ends.shown) == ("≥ 10.0", "7.5")
    assert (_rover(open_end).status, _rover(ends).status) == ("undecided", "fail")
    assert _rover(replace(open_end, rows=(Climb(angle_deg=25.0, slip=0.3),))).status == "pass"


def test_why_a_drive_stopped_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    stopped = Climb(angle_deg=10.0, stopped="a wheel lies in the soil up to its axle")
    going = Climb(angle_deg=5.0, slip=-1e-4, drift=-1e-9, torque=3.0, energy=100.0)
    one = Climbs(soil="ding2011", tire="rigid", direction="up", rows=(going, stopped))
    _print([one, replace(one, tire="fe", rows=(going,))])
    shown = capsys.readouterr().out
    assert shown.count("axle") == 1
    assert "ding2011, rigid, up, 10 deg: a wheel lies in the soil up to its axle" in shown
    assert "-0.00" not in shown


def test_a_record_is_read_as_it_was_kept() -> None:
    both = (climbs([0.0, 0.2, 1.1]), climbs([0.0, None, None], "grc1"))
    assert climbs_of(found_of(both)) == both
    assert both[0].at(5.0) == both[0].rows[1]
    assert both[0].at(6.0) is None


@pytest.fixture
def study(tmp_path: Path) -> Study:
    copy = tmp_path / "mine.toml"
    copy.write_text(built_in_study().read_text(encoding="utf-8"), encoding="utf-8")
    return read_study(copy)


def test_a_record_of_a_changed_wheel_is_stale(study: Study) -> None:
    assert held_climbs(study) is None
    found = (climbs([0.0, 0.2, 1.1]),)
    angles = [math.radians(row.angle_deg) for row in found[0].rows]
    tasks = climb_tasks([soil_named("ding2011")], {"rigid": rim_and_settling(study, "rigid", RIGID)}, angles, 0.01)
    keep(study, RECORD, "workbench climb", tasks, 1.0, found_of(found))
    held = held_climbs(study)
    assert held is not None
    assert held.state == "current"
    assert held.best["ding2011"].steepest == pytest.approx(5.0 + 5.0 * 0.4 / 0.9)
    assert study.kept is not None
    file = study.kept.with_suffix(".toml")
    text = file.read_text(encoding="utf-8")
    assert 'height = "3 mm"' in text
    file.write_text(text.replace('height = "3 mm"', 'height = "4 mm"'), encoding="utf-8")
    other = held_climbs(read_study(file))
    assert other is not None
    assert other.state == "stale"


@pytest.mark.parametrize("angle", [1.5, 3.0, 6.0, 12.0, 24.0, 25.0, 0.1])
def test_a_record_of_any_slope_is_current(study: Study, angle: float) -> None:
    radians = math.radians(angle)
    rows = (Climb(angle_deg=math.degrees(radians), slip=0.1),)
    tasks = climb_tasks([soil_named("ding2011")], {"rigid": rim_and_settling(study, "rigid", RIGID)}, [radians], 0.01)
    found = found_of((Climbs(soil="ding2011", tire="rigid", direction="up", rows=rows),))
    keep(study, RECORD, "workbench climb", tasks, 1.0, found)
    held = held_climbs(study)
    assert held is not None
    assert held.state == "current"


ROW = {"angle_deg": 0.0, "slip": 0.1, "drift": 0.0, "torque": 3.0, "energy": 100.0, "sinkage": 0.02, "stopped": ""}
DRIVES = {"soil": "ding2011", "tire": "rigid", "direction": "up", "rows": [ROW, ROW | {"angle_deg": 5.0}]}


@pytest.mark.parametrize(
    "found",
    [
        {"climbs": []},
        {"climbs": [DRIVES | {"rows": []}]},
        {"climbs": [DRIVES | {"rows": [ROW, ROW]}]},
        {"climbs": [DRIVES, DRIVES | {"rows": [ROW]}]},
        {"climbs": [DRIVES | {"rows": [ROW | {"slip": "much"}]}]},
        {"climbs": [DRIVES | {"rows": [ROW | {"stopped": 7}]}]},
        {"climbs": [DRIVES | {"soil": 5}]},
        {"climbs": [DRIVES | {"tire": []}]},
        {"climbs": [DRIVES | {"direction": "inward"}]},
    ],
)
def test_a_record_that_somebody_changed_gets_a_message(study: Study, found: dict[str, Any]) -> None:
    assert climbs_of({"climbs": [DRIVES]})
    keep(study, RECORD, "workbench climb", (), 1.0, found)
    with pytest.raises(InputError, match=r"kept record = .*cannot be read"):
        held_climbs(study)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("0:25:5", (0.0, 5.0, 10.0, 15.0, 20.0, 25.0)),
        ("0:9:5", (0.0, 5.0)),
        ("0:10.6:1", tuple(float(k) for k in range(11))),
        ("0:0.6:0.1", (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)),
        ("3", (3.0,)),
    ],
)
def test_steps_end_at_their_end(text: str, found: tuple[float, ...]) -> None:
    assert steps_of(text, "angle", "0:25:5", 100) == found


def test_steps_too_small_to_tell_apart_are_refused() -> None:
    with pytest.raises(InputError, match="must rise by a step"):
        steps_of("0:1e-12:1e-13", "angle", "0:25:5", 100)


def test_finished_slopes_of_an_interrupted_task_are_not_driven_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    driven: list[float] = []

    def drive(scenario: Scenario, design: object) -> None:
        driven.append(round(math.degrees(scenario.tilt.angle)))
        if len(driven) == 2:
            raise KeyboardInterrupt
        raise ConvergenceError("no step converges", [])

    monkeypatch.setattr(climb_task, "run_scenario", drive)
    wheels = {"rigid": (WheelOnSoil(radius=0.1425, width=0.12), None)}
    task = climb_tasks([soil_named("ding2011")], wheels, [math.radians(a) for a in (0.0, 5.0, 10.0)], 0.02)[0]
    assert task.resumable
    kept = tmp_path / "kept.npz"
    with pytest.raises(KeyboardInterrupt):
        climb_task.climb(task.inputs, {}, tmp_path, lambda share: None, kept)
    assert climb_task.climb(task.inputs, {}, tmp_path, lambda share: None, kept) == 3
    assert driven == [0, 5, 5, 10]
    assert [row["angle_deg"] for row in read_result(tmp_path)["rows"]] == pytest.approx([0.0, 5.0, 10.0])


@pytest.mark.slow
def test_a_drive_tells_slip_and_energy(tmp_path: Path) -> None:
    wheel = WheelOnSoil(radius=0.1425, width=0.12)
    (task,) = [
        one
        for one in climb_tasks([soil_named("ding2011")], {"rigid": (wheel, None)}, [math.radians(5.0)], 0.02)
        if one.inputs["direction"] == "up"
    ]
    assert climb_task.climb(task.inputs, {}, tmp_path, lambda share: None) == 1
    (row,) = read_result(tmp_path)["rows"]
    found = Climb(**row)
    assert found.slip is not None
    assert found.energy is not None
    assert 0.03 < found.slip < 0.4
    assert abs(found.drift or 0.0) < 1e-3
    weight = 6.0 * 198.0 * math.sin(math.radians(5.0))
    assert found.energy > weight / (1.0 - found.slip)  # lifting alone, at this slip
    assert asdict(found)["sinkage"] > 0.01
