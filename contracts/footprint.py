"""Footprint of a wheel: points that press on the ground, as data and as a CSV file.

Verified by tests/unit/test_footprint.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.errors import InputError

__all__ = ["FOOTPRINT", "FOOTPRINT_COLUMNS", "Footprint", "read_footprint", "write_footprint"]

Array = NDArray[np.float64]
FOOTPRINT = "footprint"
"""What the tasks and files of footprints are called."""
FOOTPRINT_COLUMNS = "forward_m", "left_m", "force_N", "pressure_Pa"
_RULE = TableRule(what="footprint file", first=FOOTPRINT_COLUMNS, units="metres, newtons and pascals")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Footprint:
    """What the ground does at the points that feel it, of the whole wheel.

    Attributes
    ----------
    place : (n, 2) deformed, forward and to the left of the point of the ground below the hub's centre [m]
    force : (n,) along the ground's normal, > 0 [N]
    pressure : (n,) per undeformed area [Pa]
    """

    place: Array
    force: Array
    pressure: Array

    @property
    def load(self) -> float:
        """[N]."""
        return float(self.force.sum())

    @property
    def centre(self) -> Array:
        """Centre of pressure, forward and left (2,) [m]."""
        return np.asarray(self.force @ self.place / self.force.sum())

    def spread(self, forward: Array, left: Array) -> Array:
        """Mean pressure (n, m) [Pa] around the places of a grid, evenly spaced (n,) and (m,) [m].

        Each force is shared among the four nearest places, in proportion to how near they are: load and centre of
        pressure are those of the footprint.

        Raises
        ------
        InputError
            For a grid that does not cover the footprint.
        """
        step = np.array([forward[1] - forward[0], left[1] - left[0]])
        at = (self.place - [forward[0], left[0]]) / step
        first = np.floor(at).astype(int)
        if (first < 0).any() or (first > [len(forward) - 2, len(left) - 2]).any():
            raise InputError("grid of a footprint", "", "must cover it", "make it larger")
        share = at - first
        found = np.zeros((len(forward), len(left)))
        for i in (0, 1):
            for j in (0, 1):
                weight = np.abs(1 - i - share[:, 0]) * np.abs(1 - j - share[:, 1])
                np.add.at(found, (first[:, 0] + i, first[:, 1] + j), weight * self.force)
        return np.asarray(found / step.prod())


def write_footprint(footprint: Footprint, path: Path, source: str = "") -> None:
    """One row a point, those behind first."""
    order = np.lexsort((footprint.place[:, 1], footprint.place[:, 0]))
    values = np.column_stack([footprint.place, footprint.force, footprint.pressure])[order]
    table = CsvTable(names=FOOTPRINT_COLUMNS, values=values, source=source, partial=False)
    path.write_text(table_text(table), encoding="utf-8")


def read_footprint(path: Path) -> Footprint:
    """What `write_footprint` writes; raises InputError as `contracts.csv_table.read_table` does."""
    values = read_table(path, _RULE).values
    return Footprint(place=values[:, :2], force=values[:, 2], pressure=values[:, 3])
