"""Time series as the user gets them: names in the report's folder, and links that keep the page in one file.

Verified by tests/unit/test_workbench_series.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from contracts.errors import InputError
from contracts.series import TimeSeries, series_text
from workbench.charts.packing import file_link

__all__ = ["MOTIONS_FOLDER", "RUTS_FOLDER", "SERIES_FOLDER", "is_ours", "series_file", "series_files", "series_links"]

MOTIONS_FOLDER = "motions"
RUTS_FOLDER = "ruts"
SERIES_FOLDER = "series"
_TIRES = ("ancf", "brush", "rigid")


def series_file(series: TimeSeries) -> str:
    """``{scenario}_{tire}.csv``."""
    return f"{series.scenario}_{series.tire}.csv"


def series_files(found: Sequence[TimeSeries]) -> dict[str, TimeSeries]:
    """Series by the name of their file; raises InputError for two of one name."""
    named: dict[str, TimeSeries] = {}
    for series in found:
        name = series_file(series)
        if name in named:
            raise InputError("series", name, "stands for two scenarios", "name each scenario once for each tire")
        named[name] = series
    return named


def is_ours(name: str) -> bool:
    """Whether a file of the series' folder has a name that a series of ours may have."""
    return name.endswith(tuple(f"_{tire}.csv" for tire in _TIRES))


def series_links(found: Sequence[TimeSeries]) -> dict[str, str]:
    """File name -> a ``data:`` link with the file's whole text, so that the page needs no other file."""
    return {name: file_link(series_text(series)) for name, series in series_files(found).items()}
