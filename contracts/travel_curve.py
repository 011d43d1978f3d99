"""Force and moment of the ground on a pressed wheel whose hub is moved over it, and their CSV.

Verified by tests/unit/test_travel_curve.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.csv_table import CsvTable, TableRule, read_table, table_text
from contracts.errors import InputError
from contracts.hub_travel import Way

__all__ = ["WRENCH", "TravelCurve", "read_travel", "write_travel"]

FloatArray = NDArray[np.float64]
WRENCH = ("force_forward_N", "force_left_N", "load_N", "moment_forward_Nm", "moment_left_Nm", "moment_up_Nm")
"""Columns of the ground's force and moment on the whole wheel at the hub's centre; up is the ground's normal."""
_AGAINST = {
    Way.FORE_AFT: ("force_forward_N", -1.0),
    Way.LATERAL: ("force_left_N", -1.0),
    Way.RADIAL: ("load_N", 1.0),
    Way.LEANING: ("moment_forward_Nm", -1.0),
    Way.WIND_UP: ("moment_left_Nm", -1.0),
    Way.TURNING: ("moment_up_Nm", -1.0),
}
"""What resists a way, and its sign where it does."""
_LEAST = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class TravelCurve:
    """One travel of one model's wheel, from where it was pressed to.

    Attributes
    ----------
    model : fe or ancf_wheel
    way : see `Way`
    orientation_deg : circumferential position that faces the ground [deg]
    deflection : at which the hub moves [m]
    travel : (n,) of the hub over the ground, from 0 on [m; rad of a turn]
    columns : (n,) by name; those of `WRENCH`, and what the model tells besides
    source : one line
    partial : whether the run ended before its target

    Raises
    ------
    InputError
        For fewer than two rows, a travel that does not increase from zero, and columns that are missing or do not fit.
    """

    model: str
    way: Way
    orientation_deg: float
    deflection: float
    travel: FloatArray
    columns: Mapping[str, FloatArray]
    source: str
    partial: bool = False

    def __post_init__(self) -> None:
        rising = len(self.travel) >= _LEAST and self.travel[0] == 0.0 and bool((np.diff(self.travel) > 0.0).all())
        if not rising or not np.isfinite(self.travel).all():
            rule = "must increase from zero over two rows or more"
            raise InputError("travel", f"{len(self.travel)} rows", rule, "move the hub further")
        lacking = [name for name in WRENCH if name not in self.columns]
        if lacking:
            raise InputError("columns of a travel", ", ".join(lacking), "are missing", "write all six of the wrench")
        if any(len(column) != len(self.travel) or not np.isfinite(column).all() for column in self.columns.values()):
            raise InputError("columns of a travel", "", "must be finite and as long as the travel", "")

    @property
    def unit(self) -> str:
        """Of the travel."""
        return "rad" if self.way.turns else "m"

    @property
    def resistance(self) -> FloatArray:
        """What holds the hub back (n,) [N; N m of a turn], less that of the wheel that only stands there."""
        name, sign = _AGAINST[self.way]
        held = self.columns[name]
        return np.asarray(sign * (held - held[0]))

    @property
    def stiffness(self) -> float:
        """Resistance over travel at the first step [N/m; N m/rad]."""
        return float(self.resistance[1] / self.travel[1])


def write_travel(curve: TravelCurve, path: Path) -> None:
    """Write ``travel_m`` or ``travel_rad``, ``deflection_m``, the wrench and the further columns as CSV."""
    path.parent.mkdir(parents=True, exist_ok=True)
    others = [name for name in curve.columns if name not in WRENCH]
    names = (f"travel_{curve.unit}", "deflection_m", *WRENCH, *others)
    deflection = np.full(len(curve.travel), curve.deflection)
    values = np.column_stack([curve.travel, deflection, *(curve.columns[name] for name in names[2:])])
    table = CsvTable(names=names, values=values, source=curve.source, partial=curve.partial)
    path.write_text(table_text(table), encoding="utf-8", newline="")


def read_travel(path: Path, model: str, way: Way, orientation_deg: float) -> TravelCurve:
    """Read what `write_travel` writes, of a model, way and orientation [deg]; the travel is (n,) [m; rad].

    Raises
    ------
    InputError
        If the file is missing or holds something else.
    """
    unit = "rad" if way.turns else "m"
    rule = TableRule(what="travel file", first=(f"travel_{unit}", "deflection_m"), units="SI units")
    table = read_table(path, rule)
    return TravelCurve(
        model=model,
        way=way,
        orientation_deg=orientation_deg,
        deflection=float(table.values[0, 1]),
        travel=table.values[:, 0],
        columns={name: table.values[:, 2 + i] for i, name in enumerate(table.names[2:])},
        source=table.source,
        partial=table.partial,
    )
