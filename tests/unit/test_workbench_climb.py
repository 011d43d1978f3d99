"""The rover's slopes on soil: what a record says, when it is of another study, and what its drives are given.

Claims: the steepest slope is one that was driven, from fresh soil into the rover's own ruts, as the statement says; a
record follows the study, its soils and its rim; the task tells slip and energy of the drive it makes, which ruts spare,
and looks for the steepest slope between two; a rover that gets stuck late is stuck. Negative controls: a rover that
slips from the start climbs nothing; a changed wheel makes the record stale.
"""

from __future__ import annotations

import math
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.level_ground import SPEED
from soil.carcass import RIGID
from soil.soil import soil_named
from soil.steady_wheel import WheelOnSoil
from workbench.questions.kept import keep
from workbench.questions.soil.climb import RECORD, STUCK, Climb, Climbs, climb_tasks, climbs_of, found_of
from workbench.questions.soil.climb_task import LASTS, _ends, _slips, _ways
from workbench.questions.soil.held_climbs import held_climbs, rim_and_settling
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


@pytest.mark.slow
def test_a_drive_tells_slip_and_energy(tmp_path: Path) -> None:
    from workbench.execution.result_files import read_result
    from workbench.questions.soil.climb_task import climb

    wheel = WheelOnSoil(radius=0.1425, width=0.12)
    (task,) = [
        one
        for one in climb_tasks([soil_named("ding2011")], {"rigid": (wheel, None)}, [math.radians(5.0)], 0.02)
        if one.inputs["direction"] == "up"
    ]
    assert climb(task.inputs, {}, tmp_path, lambda share: None) == 1
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
