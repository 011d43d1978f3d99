"""What a parameter study's columns are called, in words and in units that engineers read.

Verified by tests/unit/test_workbench_sweep.py.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from workbench.questions.sweep.table import Cell, SweepTable

__all__ = ["Column", "column_of", "drawn_rows", "told_columns"]

_SCALED = {
    "_N_per_m": (1e-3, "N/mm"),
    "_N_m_per_rad": (1.0, "N m/rad"),
    "_Pa": (1e-6, "MPa"),
    "_m": (1e3, "mm"),
    "_N": (1.0, "N"),
    "_kg": (1.0, "kg"),
    "_deg": (1.0, "deg"),
}
"""Ending of a column's name -> factor and unit in which it is told."""
_WORDS = {
    "max_von_mises": "largest stress",
    "max_linearised": "stress in strips",
    "relative_l2": "relative L2",
}
"""How a name begins -> in words."""
_TOLD = (
    *("mass_kg", "initial_tangent", "load_at_", "max_linearised_", "utilisation_", "spread_"),
    *("relative_l2", "largest_miss", "cost"),
)
"""How the names of the columns begin that a page shows; all are in the files."""
_OF_THE_LARGEST = ("max_linearised_", "utilisation_", "spread_")
"""Of these the one at the largest load or deflection alone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A column of numbers: its name in the files, what it is called with its unit, what a cell is multiplied by."""

    name: str
    label: str
    factor: float


def column_of(name: str) -> Column:
    """``"deflection_at_40N_m"`` -> ``"deflection at 40 N [mm]"``, 1000."""
    ending = next((ending for ending in _SCALED if name.endswith(ending)), "")
    factor, unit = _SCALED[ending] if ending else (1.0, "-")
    bare = name.removesuffix(ending)
    begun = next((begins for begins in _WORDS if bare.startswith(begins)), "")
    words = _WORDS.get(begun, "") + bare.removeprefix(begun)
    words = re.sub(r"(?<=_)([.\d]+)(mm|N)\b", r"\1 \2", words).replace("_", " ")
    return Column(name=name, label=f"{words} [{unit}]", factor=factor)


def drawn_rows(table: SweepTable) -> list[tuple[Cell, ...]]:
    """Rows with values and numbers: neither the study as it is, nor a point that failed."""
    point, state = table.names.index("point"), table.names.index("state")
    return [row for row in table.rows if row[point] != 0 and row[state] != "failed"]


def told_columns(table: SweepTable) -> list[Column]:
    """What a page shows of what was found: the few columns in which the points differ."""
    rows = drawn_rows(table)
    chosen = []
    for begins in _TOLD:
        named = [name for name in table.outputs if name.startswith(begins)]
        chosen += named[-1:] if begins in _OF_THE_LARGEST else named
    return [column_of(name) for name in chosen if _differ([row[table.names.index(name)] for row in rows])]


def _differ(cells: Sequence[Cell]) -> bool:
    return len({cell for cell in cells if cell is not None}) > 1
