"""Tables of numbers as CSV: comment lines with ``#``, a header of names with units, rows.

Two comments mean something: ``# source:`` says where the numbers come from, ``# partial: True`` that a run ended before
its target. No name or source is a formula for a spreadsheet, see `contracts.text.for_cell`. Verified by
tests/unit/test_curves_csv.py, tests/unit/test_series.py and tests/unit/test_text.py.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.input_file import input_text
from contracts.text import cell_text, comment_text, for_cell, for_comment, one_line

__all__ = ["CsvTable", "TableRule", "read_table", "table_text"]


@dataclass(frozen=True, slots=True, kw_only=True)
class CsvTable:
    """What a file says.

    Attributes
    ----------
    names : of the columns, with their units
    values : (n, n_columns) float
    source : where the numbers come from, one line; empty if not said
    partial : whether the run ended before its target
    lines : (n,) place of each row in the file it was read from, counted from 1; empty for a table that was not read
    """

    names: tuple[str, ...]
    values: NDArray[np.float64]
    source: str
    partial: bool
    lines: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class TableRule:
    """What a kind of file must have: ``what`` it is called, its ``first`` names, words on ``units`` for the hint."""

    what: str
    first: tuple[str, ...]
    units: str


def table_text(table: CsvTable) -> str:
    """The file's text; numbers with 12 digits."""
    stream = io.StringIO()
    if table.source:
        stream.write(for_comment(f"# source: {' '.join(table.source.split())}") + "\n")
    if table.partial:
        stream.write("# partial: True\n")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(map(for_cell, table.names))
    writer.writerows([[f"{value:.12g}" for value in row] for row in table.values])
    return stream.getvalue()


def read_table(path: Path, rule: TableRule) -> CsvTable:
    """Read a file; byte order marks, blank lines and spaces in the header are no errors.

    Raises
    ------
    InputError
        If `input_text` refuses the file; if it is empty, without the first names, holds text where a number belongs, or
        has rows that do not match its header, with the number of the line. Two rows or more; one is enough for a
        partial run.
    """
    lines = input_text(path, rule.what).splitlines()
    comments = [comment_text(line[1:].strip()) for line in lines if line.startswith("#")]
    partial = "partial: True" in comments
    numbered = [(n, line) for n, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    names, values = _numbers(numbered, path, rule, partial)
    source = next((one_line(c.removeprefix("source:").strip()) for c in comments if c.startswith("source:")), "")
    places = tuple(n for n, _ in numbered[1:])
    return CsvTable(names=names, values=values, source=source, partial=partial, lines=places)


def _numbers(
    numbered: Sequence[tuple[int, str]], path: Path, rule: TableRule, partial: bool
) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """Header names and the (n, n_columns) numbers below them; raises InputError where they do not fit together."""
    try:
        rows = list(csv.reader(line for _, line in numbered))
    except csv.Error as error:
        raise InputError(rule.what, path, f"has a bad row ({error})", "every cell must be a number") from error
    names = tuple(cell_text(one_line(name.strip())) for name in rows[0]) if rows else ()
    if len(rows) < 3 - partial or names[: len(rule.first)] != rule.first:
        wanted = f"must have a header {','.join(rule.first)} and two or more rows"
        raise InputError(rule.what, path, wanted, rule.units)
    if len(rows) != len(numbered):
        raise InputError(rule.what, path, "has a quotation mark that no other closes in its line", "take it out")
    values = []
    for (place, _), cells in zip(numbered[1:], rows[1:], strict=True):
        if len(cells) != len(names):
            wrong = f"has {len(cells)} value{'s' * (len(cells) != 1)} in line {place} under {len(names)} headers"
            hint = "give every column a header and every row all columns; decimals have a point, no comma"
            raise InputError(rule.what, path, wrong, hint)
        try:
            values.append([_number(cell) for cell in cells])
        except ValueError as error:
            wrong = f"has a bad row, line {place} ({error})"
            raise InputError(rule.what, path, wrong, "every cell must be a number, with a decimal point") from error
    return names, np.array(values, dtype=np.float64)


def _number(cell: str) -> float:
    """A cell's number in ASCII, as every program writes it: Python's own ``3_0`` and other scripts' digits are none."""
    if "_" in cell or not cell.strip().isascii():
        raise ValueError(f"could not convert string to float: {one_line(cell)!r}")
    return float(cell)
