"""Curves of a travel: what resists, their CSV there and back, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.hub_travel import Way
from contracts.travel_curve import WRENCH, TravelCurve, read_travel, write_travel


def curve(way: Way = Way.LATERAL) -> TravelCurve:
    columns = {name: np.array([k, k - 10.0, k - 15.0]) for k, name in enumerate(WRENCH)}
    return TravelCurve(
        model="fe",
        way=way,
        orientation_deg=15.0,
        deflection=0.02,
        travel=np.array([0.0, 0.001, 0.002]),
        columns=columns | {"stored_energy_J": np.array([1.0, 2.0, 3.0])},
        source="by hand",
    )


@pytest.mark.parametrize("way", list(Way))
def test_resistance_counts_from_the_wheel_that_stands(way: Way) -> None:
    """A wheel that is pressed on is held back by a load that rises, all others by what falls below zero."""
    sign = -1.0 if way is Way.RADIAL else 1.0
    np.testing.assert_array_equal(curve(way).resistance, [0.0, 10.0 * sign, 15.0 * sign])
    assert curve(way).stiffness == pytest.approx(10e3 * sign)


@pytest.mark.parametrize("way", list(Way))
def test_written_and_read_it_is_the_same(tmp_path: Path, way: Way) -> None:
    write_travel(replace(curve(way), partial=True), tmp_path / "a.csv")
    header = (tmp_path / "a.csv").read_text().splitlines()[2].split(",")
    assert header[:8] == [
        "travel_rad" if way in (Way.TURNING, Way.WIND_UP, Way.LEANING) else "travel_m",
        "deflection_m",
        *WRENCH,
    ]
    found = read_travel(tmp_path / "a.csv", "fe", way, 15.0)
    assert (found.deflection, found.partial, found.source) == (0.02, True, "by hand")
    np.testing.assert_array_equal(found.travel, curve(way).travel)
    assert list(found.columns) == list(curve(way).columns)
    for name, column in curve(way).columns.items():
        np.testing.assert_array_equal(found.columns[name], column)


def test_another_ways_file_is_told(tmp_path: Path) -> None:
    write_travel(curve(Way.TURNING), tmp_path / "a.csv")
    with pytest.raises(InputError, match="travel file"):
        read_travel(tmp_path / "a.csv", "fe", Way.LATERAL, 15.0)


@pytest.mark.parametrize("travel", [[0.0], [0.001, 0.002], [0.0, 0.002, 0.001], [0.0, np.nan]])
def test_a_travel_that_does_not_rise_from_zero_is_refused(travel: list[float]) -> None:
    columns = {name: np.zeros(len(travel)) for name in WRENCH}
    with pytest.raises(InputError, match="increase from zero"):
        replace(curve(), travel=np.array(travel), columns=columns)


def test_columns_that_lack_are_named() -> None:
    with pytest.raises(InputError, match="moment_up_Nm"):
        replace(curve(), columns={name: curve().columns[name] for name in WRENCH[:-1]})
    with pytest.raises(InputError, match="as long as"):
        replace(curve(), columns=curve().columns | {"load_N": np.zeros(2)})
