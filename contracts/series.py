"""Time series of a scenario: named columns against time, and the CSV they travel in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.errors import InputError

__all__ = ["TimeSeries", "read_series", "series_text", "write_series"]

FloatArray = NDArray[np.float64]
_RULE = TableRule(what="series file", first=("time_s",), units="give time in seconds, first")


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeSeries:
    """Samples of one scenario on one kind of tire.

    Attributes
    ----------
    scenario : what moves, e.g. ``"drop"``
    tire : ``"rigid"``, ``"brush"``, ``"ancf"`` or an adapter's name
    time : (n,) float [s], strictly increasing
    columns : samples (n,) float by header, a name that ends with its unit: ``hub_z_m``, ``load_z_N``
    source : where the samples come from, printed with them
    partial : True if the run ended before its target; such a series may hold the start alone

    Raises
    ------
    InputError
        For shapes that differ, values that are not finite, or times that do not increase.

    Verified by tests/unit/test_series.py.
    """

    scenario: str
    tire: str
    time: FloatArray
    columns: Mapping[str, FloatArray]
    source: str = ""
    partial: bool = False

    def __post_init__(self) -> None:
        what = f"series {self.scenario}, {self.tire}"
        if self.time.ndim != 1 or len(self.time) < 2 - self.partial:
            raise InputError(f"{what}: time", f"{self.time.shape} samples", "needs two or more", "run it further")
        for name, values in {"time_s": self.time, **self.columns}.items():
            if values.shape != self.time.shape:
                rule = f"must have one value per sample, shape {self.time.shape}"
                raise InputError(f"{what}: {name}", f"shape {values.shape}", rule, "drop the column or fill it")
            if not np.all(np.isfinite(values)):
                rule = "must be finite"
                raise InputError(
                    f"{what}: {name}", "NaN or infinity", rule, "end the series before, and mark it partial"
                )
        if not np.all(np.diff(self.time) > 0.0):
            raise InputError(f"{what}: time", "its order", "must increase strictly", "sort the rows and drop repeats")

    def __getitem__(self, column: str) -> FloatArray:
        """Samples (n,) of a column; raises InputError for one that is not there."""
        if column not in self.columns:
            rule = f"is none of {', '.join(self.columns)}"
            raise InputError(f"column of series {self.scenario}", column, rule, "check the name and its unit")
        return self.columns[column]


def series_text(series: TimeSeries) -> str:
    """The CSV: a source line (comment), ``time_s`` and the columns; 12 digits."""
    values = np.column_stack([series.time, *series.columns.values()])
    names = ("time_s", *series.columns)
    return table_text(CsvTable(names=names, values=values, source=series.source, partial=series.partial))


def write_series(series: TimeSeries, path: Path) -> None:
    """Write the CSV; its folder is made if needed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(series_text(series), encoding="utf-8", newline="")


def read_series(path: Path, scenario: str, tire: str) -> TimeSeries:
    """Read a series that `write_series` wrote, or one from elsewhere with ``time_s`` first.

    Raises
    ------
    InputError
        For a file that cannot be used; see `TimeSeries` and `csv_table.read_table`.
    """
    table = read_table(path, _RULE)
    try:
        return TimeSeries(
            scenario=scenario,
            tire=tire,
            time=table.values[:, 0],
            columns={name: table.values[:, 1 + i] for i, name in enumerate(table.names[1:])},
            source=table.source,
            partial=table.partial,
        )
    except InputError as error:
        raise InputError("series file", path, f"{error.what} {error.rule}", error.hint) from error
