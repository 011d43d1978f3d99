"""A stretch over random rocks: rocks by the law, none too tall; how a drive ends; energy on level ground by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.stretch import cause_of, stretch
from rover_dynamics.rover.scenarios.way import Way, _in_tracks, avoided, crossed, rocks

DESIGN = read_rover()
WAY = Way(length=20.0, speed=70.0 / 3600.0, abundance=0.1, seed=4)
Q = 1.79 + 0.152 / WAY.abundance
FLAT = replace(WAY, length=2.0, abundance=1e-3)
"""So few rocks that none is as large as the smallest."""


def number(low: float, high: float) -> float:
    """Rocks by area [1/m^2] with diameters in a range: the share they cover over the area of one."""
    D = np.linspace(low, high, 20001)
    return float(np.trapezoid(WAY.abundance * Q * np.exp(-Q * D) / (0.25 * math.pi * D**2), D))


def test_rocks_are_as_many_and_cover_as_much_as_the_law_says() -> None:
    fields = [rocks(WAY, k, DESIGN) for k in range(12)]
    area = sum(field.size[0] * field.size[1] for field in fields)
    diameter = np.concatenate([field.rocks()[:, 2] for field in fields])
    expected = area * number(0.05, 0.625)
    assert len(diameter) == pytest.approx(expected, abs=4.0 * math.sqrt(expected))
    share = WAY.abundance * (math.exp(-0.05 * Q) - math.exp(-0.625 * Q))
    assert (0.25 * math.pi * diameter**2).sum() / area == pytest.approx(share, rel=0.03)


def test_seed_and_number_decide() -> None:
    first, again = rocks(WAY, 3, DESIGN).rocks(), rocks(WAY, 3, DESIGN).rocks()
    np.testing.assert_array_equal(first, again)
    for other in (rocks(WAY, 4, DESIGN), rocks(replace(WAY, seed=5), 3, DESIGN)):
        assert not np.array_equal(first[:5], other.rocks()[:5])


def test_nothing_in_the_tracks_is_taller_than_the_rover_crosses_and_the_others_are_counted() -> None:
    for k in range(6):
        ground = rocks(WAY, k, DESIGN).terrain()
        assert ground.heights.max() <= WAY.tallest
        x = np.linspace(-0.7, 20.6, 2000)
        highest = max(float(ground.height(x, np.full_like(x, leg.drive[1])).max()) for leg in DESIGN.legs)
        assert highest <= 1.02 * float(crossed(WAY, k, DESIGN).max(initial=0.0)) + 1e-9
    around = sum(avoided(WAY, k, DESIGN) for k in range(60))
    D = np.linspace(0.625, 3.0, 20001)
    density = WAY.abundance * Q * np.exp(-Q * D) / (0.25 * math.pi * D**2)
    expected = 60.0 * (20.0 + 1.36) * 2.0 * float(np.trapezoid(density * (DESIGN.wheel_width + D), D))
    assert around == pytest.approx(expected, abs=4.0 * math.sqrt(expected))
    assert avoided(replace(WAY, tallest=0.1), 0, DESIGN) > avoided(WAY, 0, DESIGN)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"abundance": 0.0}, "abundance"),
        ({"abundance": 0.41}, r"\[0.001, 0.4\]"),
        ({"abundance": 5e-324}, "abundance = 4.94066e-324"),
        ({"abundance": math.nan}, "abundance"),
        ({"length": -1.0}, "> 0"),
        ({"speed": 0.0}, "1 ... 500 m/h"),
        ({"seed": -1}, "0 or more"),
        ({"tallest": 2.0}, "heights"),
    ],
)
def test_what_cannot_be_is_refused(change: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        replace(WAY, **change)


@pytest.fixture(scope="module")
def level() -> ScenarioRun:
    """Two metres of level ground."""
    return run_scenario(stretch(FLAT, 0, DESIGN), DESIGN)


def test_energy_by_way_on_level_ground_is_that_of_rolling_resistance(level: ScenarioRun) -> None:
    """Every wheel's drive turns against f N (R - d): sum f N (R - d) / R by way, N the static load, d = N / k.

    Left out: slip, and M v^2 / 2 of the start, 0.07 J.
    """
    tire, n, R = level.scenario.tire, len(DESIGN.legs), DESIGN.wheel_radius
    N = DESIGN.static_load
    by_hand = n * tire.rolling_resistance * N * (R - N / tire.radial_stiffness) / R
    way = level.place[-1, 0] - level.place[0, 0]
    assert cause_of(level, FLAT) is None
    assert way == pytest.approx(2.0, abs=0.003)
    assert energy_of_drives(level) / way == pytest.approx(by_hand, rel=0.02)


def test_a_drive_ends_for_what_its_last_sample_shows(level: ScenarioRun) -> None:
    def cut(last: int, **values: Any) -> ScenarioRun:
        rows = {name: getattr(level.motion, name)[:last] for name in ("times", "positions", "rotations", "tires")}
        return replace(level, motion=replace(level.motion, **{**rows, **values}))

    half = len(level.motion.times) // 2
    assert cause_of(cut(half), FLAT) == "friction"
    assert cause_of(replace(level, stopped="no step converges"), FLAT) == "computation"
    beside = level.motion.positions[:half].copy()
    beside[-1, :, 1] += 0.6
    assert cause_of(cut(half, positions=beside), FLAT) == "heading"
    down = level.motion.positions[:half].copy()
    down[-1, :, 2] -= 0.5
    assert cause_of(cut(half, positions=down), FLAT) == "clearance"
    leans = level.motion.rotations[:half].copy()
    c, s = math.cos(0.6), math.sin(0.6)
    leans[-1, 0] = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
    assert cause_of(cut(half, rotations=leans), FLAT) == "stability"


def test_a_wheel_that_cannot_grip_is_stuck_before_a_rock() -> None:
    way = replace(WAY, length=1.0, abundance=0.3, seed=7)
    slippery = replace(stretch(way, 0, DESIGN, 1.5), friction=0.02)
    run = run_scenario(slippery, DESIGN)
    assert cause_of(run, way) == "friction"
    assert run.place[-1, 0] - run.place[0, 0] < way.length


def test_a_rock_is_met_as_far_beside_a_track_as_wheel_and_rock_are_wide() -> None:
    leg, reach = max(DESIGN.legs, key=lambda leg: leg.drive[1]), 0.5 * (DESIGN.wheel_width + 0.2)

    class Two:
        def rocks(self) -> NDArray[np.float64]:
            beside = leg.drive[1] + reach + np.array([-1e-3, 1e-3])
            return np.column_stack([np.full(2, leg.drive[0] + 0.5), beside, np.full(2, 0.2)])

    assert _in_tracks(Two(), WAY, DESIGN).tolist() == [0.2]  # type: ignore[arg-type]
