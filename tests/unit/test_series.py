"""Time series as CSV: round trip, header, files and numbers that cannot be used."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.series import TimeSeries, read_series, series_text, write_series

SAMPLE = TimeSeries(
    scenario="drop",
    tire="ancf",
    time=np.array([0.0, 0.1, 0.2]),
    columns={"hub_z_m": np.array([0.1525, 0.15, 1.0 / 7.0]), "load_z_N": np.array([0.0, 3.0, 1e5 / 3.0])},
    source="a solver,\n2026",
)


@pytest.mark.parametrize("partial", [False, True])
def test_round_trip_to_twelve_digits(tmp_path: Path, partial: bool) -> None:
    path = tmp_path / "new" / "drop_ancf.csv"
    write_series(replace(SAMPLE, partial=partial), path)
    back = read_series(path, "drop", "ancf")
    np.testing.assert_allclose(back.time, SAMPLE.time, rtol=1e-11)
    for name, values in SAMPLE.columns.items():
        np.testing.assert_allclose(back[name], values, rtol=1e-11)
    assert list(back.columns) == list(SAMPLE.columns)
    assert (back.scenario, back.tire, back.source, back.partial) == ("drop", "ancf", "a solver, 2026", partial)


def test_time_comes_first_below_the_source() -> None:
    assert series_text(SAMPLE).splitlines()[:3] == [
        "# source: a solver, 2026",
        "time_s,hub_z_m,load_z_N",
        "0,0.1525,0",
    ]


def test_a_partial_series_may_hold_the_start_alone(tmp_path: Path) -> None:
    start = TimeSeries(scenario="drop", tire="ancf", time=np.zeros(1), columns={"hub_z_m": np.ones(1)}, partial=True)
    write_series(start, tmp_path / "s.csv")
    assert read_series(tmp_path / "s.csv", "drop", "ancf").partial
    with pytest.raises(InputError, match="needs two or more"):
        replace(start, partial=False)


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"time": np.array([0.0, 0.2, 0.1])}, "must increase strictly"),
        ({"time": np.array([0.0, 0.1])}, "one value per sample"),
        ({"time": np.array([0.0, 0.1, np.nan])}, "must be finite"),
        ({"columns": {"load_z_N": np.array([0.0, np.inf, 1.0])}}, "load_z_N = NaN or infinity: must be finite"),
    ],
)
def test_bad_samples_are_refused(changes: dict[str, object], rule: str) -> None:
    with pytest.raises(InputError, match=rule):
        replace(SAMPLE, **changes)  # type: ignore[arg-type]


def test_a_column_that_is_not_there_is_named() -> None:
    with pytest.raises(InputError, match="is none of hub_z_m, load_z_N"):
        SAMPLE["hub_z"]


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("", "must have a header time_s"),
        ("t,hub_z_m\n0,1\n1,2\n", "must have a header time_s"),
        ("time_s,hub_z_m\n0,1\n", "two or more rows"),
        ("time_s,hub_z_m\n0,1\n1,high\n", "has a bad row"),
        ("time_s,hub_z_m\n1,1\n0,2\n", "must increase strictly"),
    ],
)
def test_bad_files_are_refused(text: str, rule: str, tmp_path: Path) -> None:
    path = tmp_path / "s.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rf"series file = .*s\.csv: .*{rule}"):
        read_series(path, "drop", "ancf")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_series(tmp_path / "none.csv", "drop", "ancf")
