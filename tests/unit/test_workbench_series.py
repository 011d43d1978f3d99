"""Names and links of time series in the report."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from contracts.series import TimeSeries, series_text
from workbench.charts.packing import unpacked
from workbench.report.series import is_ours, series_file, series_files, series_links


def _series(scenario: str, tire: str) -> TimeSeries:
    return TimeSeries(
        scenario=scenario, tire=tire, time=np.array([0.0, 1.0]), columns={"hub_z_m": np.array([1.0, 2.0])}
    )


def test_names_are_the_contract() -> None:
    assert series_file(_series("straight_path", "brush")) == "straight_path_brush.csv"
    assert all(is_ours(series_file(_series("drop", tire))) for tire in ("rigid", "brush", "ancf"))
    assert not is_ours("measured.csv")


def test_two_of_one_name_are_refused() -> None:
    assert list(series_files([_series("drop", "ancf"), _series("drop", "brush")])) == [
        "drop_ancf.csv",
        "drop_brush.csv",
    ]
    with pytest.raises(InputError, match="stands for two scenarios"):
        series_files([_series("drop", "ancf"), _series("drop", "ancf")])


def test_a_link_holds_the_whole_file() -> None:
    series = _series("drop", "ancf")
    kind, _, text = series_links([series])["drop_ancf.csv"].partition("base64,")
    assert kind == "data:application/gzip;"
    assert unpacked(text).decode("utf-8") == series_text(series)
