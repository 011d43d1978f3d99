"""Published numbers that verification is held against: CSV files in this folder, each led by lines on its source.

Tests, reports and both wheel models' benchmarks read them here, so that all are held against the same digits.
Verified by tests/unit/test_published.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError

__all__ = ["PublishedTable", "published_matrix", "published_table"]

_FOLDER = Path(__file__).parent


@dataclass(frozen=True, slots=True, kw_only=True)
class PublishedTable:
    """A table with named columns; ``table["load"]`` is a column of numbers in the unit its name or source says.

    Attributes
    ----------
    name : file name without its ending
    source : the comment lines at its head: where it is from and what its symbols mean
    names : of the columns
    rows : entries as printed
    """

    name: str
    source: str
    names: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def text(self, column: str) -> tuple[str, ...]:
        """A column as printed; InputError if there is none of this name."""
        if column not in self.names:
            hint = f"choose {', '.join(self.names)}"
            raise InputError("column", column, f"is not in the published table {self.name}", hint)
        number = self.names.index(column)
        return tuple(row[number] for row in self.rows)

    def __getitem__(self, column: str) -> NDArray[np.float64]:
        """(n,) float: a column of numbers."""
        return np.array([float(entry) for entry in self.text(column)])


@cache
def published_table(name: str) -> PublishedTable:
    """A table whose first line after the source names its columns, e.g. ``"hertz_line"``; InputError if unknown."""
    source, (header, *rows) = _read(name)
    return PublishedTable(name=name, source=source, names=header, rows=tuple(rows))


def published_matrix(name: str) -> NDArray[np.float64]:
    """(n, m) float: numbers without column names, e.g. ``"ancf_plate_mass"``; InputError if unknown."""
    _, rows = _read(name)
    return np.array(rows, dtype=np.float64)


def _read(name: str) -> tuple[str, list[tuple[str, ...]]]:
    """Comment lines as one text, and the entries of the other lines."""
    path = _FOLDER / f"{name}.csv"
    if not path.is_file():
        known = ", ".join(sorted(p.stem for p in _FOLDER.glob("*.csv")))
        raise InputError("published table", name, "is not known", f"choose {known}")
    lines = path.read_text(encoding="utf-8").splitlines()
    source = "\n".join(line.lstrip("# ") for line in lines if line.startswith("#"))
    return source, [tuple(line.split(",")) for line in lines if line and not line.startswith("#")]
