"""The rover's slopes on soil: what a record says, when it is of another study, and what its drives are given.

Claims: the steepest slope is one that was driven, from fresh soil into the rover's own ruts, as the statement says; a
record follows the study, its soils and its rim; the task tells slip and energy of the drive it makes, which ruts spare,
and looks for the steepest slope between two; a rover that gets stuck late is stuck. Negative controls: a rover that
slips from the start climbs nothing; a changed wheel makes the record stale.
"""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contracts.errors import ConvergenceError, InputError
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.level_ground import SPEED
from rover_dynamics.rover.scenarios.scenario import Scenario
from soil.carcass import RIGID
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil
from workbench.commands.climb import _print
from workbench.commands.steps import steps_of
from workbench.execution.result_files import read_result
from workbench.questions.kept import keep
from workbench.questions.soil import climb_task
from workbench.questions.soil.climb import RECORD, STUCK, Climb, Climbs, climb_tasks, climbs_of, found_of
from workbench.questions.soil.climb_task import LASTS, _ends, _slips, _ways
from workbench.questions.soil.held_climbs import held_climbs, rim_and_settling
from workbench.questions.soil.question import _rover
from workbench.study.model import Study
from workbench.study.reading import built_in_study, read_study
from workbench.verdict.statements import statement_of


def climbs(slips: list[float | None], soil: str = "ding2011") -> Climbs:
    """Upwards at 0, 5, 10 degrees."""
    rows = tuple(
        Climb(angle_deg=5.0 * k, slip=s, largest=s, energy=None if s is None or s >= 1.0 else 100.0)
        for k, s in enumerate(slips)
    )
    return Climbs(soil=soil, tire="rigid", direction="up", rows=rows)


@pytest.mark.parametrize(
    ("slips", "steepest"),
    [([0.0, 0.2, 1.0], 5.0), ([0.0, 0.1, 0.2], 10.0), ([0.7, 0.8, 0.9], 0.0), ([0.0, None, 0.1], 0.0)],
)
def test_the_steepest_slope_was_driven(slips: list[float | None], steepest: float) -> None:
    assert climbs(slips).steepest == steepest


def test_a_slope_beyond_those_driven_is_a_bound_and_decides_nothing() -> None:
    open_end, ends = climbs([0.0, 0.1, 0.2]), climbs([0.0, 0.2, 1.0])
    assert (open_end.shown, ends.shown) == ("≥10.0", "5.0")
    assert (_rover(open_end).status, _rover(ends).status) == ("undecided", "fail")
    assert _rover(replace(open_end, rows=(Climb(angle_deg=25.0, slip=0.3, largest=0.3),))).status == "pass"


def test_why_a_drive_stopped_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    stopped = Climb(angle_deg=10.0, stopped="a wheel lies in the soil up to its axle")
    going = Climb(angle_deg=5.0, slip=-1e-4, largest=0.0, drift=-1e-9, torque=3.0, energy=100.0)
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


def test_a_drive_comes_into_its_ruts_as_the_statement_says() -> None:
    places = sorted({round(leg.drive[0], 6) for leg in read_rover().legs})
    fresh, ruts, way = _ways(read_rover())
    radius = read_rover().wheel_radius
    assert fresh < min(b - a for a, b in pairwise(places)) - 2.0 * 0.99 * radius  # two contacts end to end
    assert max(b - a for a, b in pairwise(places)) + radius <= ruts < way < LASTS * SPEED
    for soil in ("ding2011", "fjs1", "grc1"):
        assert "from fresh soil into its own ruts" in statement_of(f"soil.rover_{soil}", "slope", "").claim


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
    assert held.best["ding2011"].steepest == 5.0
    assert study.kept is not None
    file = study.kept.with_suffix(".toml")
    text = file.read_text(encoding="utf-8")
    assert 'height = "3 mm"' in text
    file.write_text(text.replace('height = "3 mm"', 'height = "4 mm"'), encoding="utf-8")
    other = held_climbs(read_study(file))
    assert other is not None
    assert other.state == "stale"


def test_a_rover_that_gets_stuck_late_is_stuck() -> None:
    """0.2 of slip for 30 s, then 0.9: the mean of all is below 0.6."""
    times = np.arange(0.0, 45.0, 0.1)
    places = SPEED * np.where(times < 30.0, 0.8 * times, 24.0 + 0.1 * (times - 30.0))
    slips = _slips(times, places, 15.0)
    assert slips.min() == pytest.approx(0.2)
    assert slips.max() == pytest.approx(0.9)
    assert 1.0 - (places[-1] - places[0]) / (times[-1] * SPEED) < STUCK
    ends = _ends(read_rover())
    ended = [t for t, x in zip(times, places, strict=True) if ends(float(t), np.array([[x, 0.0, 0.0]]))]
    assert ended[0] == pytest.approx(30.0 + 0.5 * (STUCK - 0.2) / 0.7 * 10.0 + 10.0, abs=0.5)


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


ROW = {
    "angle_deg": 0.0,
    "slip": 0.1,
    "largest": 0.1,
    "drift": 0.0,
    "torque": 3.0,
    "energy": 100.0,
    "sinkage": 0.02,
    "stopped": "",
}
DRIVES = {"soil": "ding2011", "tire": "rigid", "direction": "up", "rows": [ROW, ROW | {"angle_deg": 5.0}]}


@pytest.mark.parametrize(
    "found",
    [
        {"climbs": []},
        {"climbs": [DRIVES | {"rows": []}]},
        {"climbs": [DRIVES | {"rows": [ROW, ROW]}]},
        {"climbs": [DRIVES, DRIVES | {"direction": "down", "rows": [ROW | {"angle_deg": 7.0}]}]},
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


def test_the_steepest_slope_is_halved_for_upwards_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rovers that are stuck above 12 degrees."""
    monkeypatch.setattr(climb_task, "run_scenario", lambda scenario, design: SimpleNamespace(stopped=None))
    monkeypatch.setattr(
        climb_task, "_row", lambda angle, run: Climb(angle_deg=math.degrees(angle), largest=0.1 + (angle > 0.21))
    )
    wheels = {"rigid": (WheelOnSoil(radius=0.1425, width=0.12), None)}
    tasks = climb_tasks([soil_named("ding2011")], wheels, [math.radians(a) for a in (0.0, 10.0, 20.0)], 0.02)
    found = {}
    for task in tasks:
        climb_task.climb(task.inputs, {}, tmp_path, lambda share: None)
        found[task.inputs["direction"]] = [round(row["angle_deg"], 6) for row in read_result(tmp_path)["rows"]]
    assert found == {"up": [0.0, 10.0, 11.25, 12.5, 15.0, 20.0], "down": [0.0, 10.0, 20.0], "across": [0.0, 10.0, 20.0]}


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
    assert found.largest is not None
    assert found.slip <= found.largest + 1e-9
    assert found.climbs
    assert found.energy_in_ruts is not None
    assert found.energy_in_ruts < 0.9 * found.energy
    assert abs(found.drift or 0.0) < 1e-3
    weight = 6.0 * 198.0 * math.sin(math.radians(5.0))
    assert found.energy > weight / (1.0 - found.slip)  # lifting alone, at this slip
    assert asdict(found)["sinkage"] > 0.01
