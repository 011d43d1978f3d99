"""The single-wheel bench: pull, torque and sinkage of a wheel over its slip on a soil, rigid beside flexible.

Verified by tests/unit/test_workbench_soil.py and tests/end_to_end/test_drawbar.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from contracts.csv_table import CsvTable, table_text
from geometry.wheel import WheelDesign
from soil.carcass import RIGID, Carcass
from soil.soil import Soil, with_ends_of_ranges
from soil.steady_wheel import WheelOnSoil, WheelState, steady_wheel, towed_wheel

__all__ = ["COLUMNS", "Bench", "BenchRow", "bench_csv", "carcass_of", "run_bench", "wheel_on_soil"]

COLUMNS = (
    *("slip", "drawbar_pull_N", "torque_N_m", "sinkage_m"),
    *("efficiency", "hub_height_m", "deflection_m", "largest_pressure_Pa"),
    *("drawbar_pull_low_N", "drawbar_pull_high_N", "rigid_drawbar_pull_N", "rigid_torque_N_m", "rigid_sinkage_m"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchRow:
    """One slip.

    Attributes
    ----------
    wheel, rigid : the wheel, and the same with a rigid rim
    low, high : smallest and largest pull [N] over the ends of the soil's ranges
    """

    wheel: WheelState
    rigid: WheelState
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Bench:
    """What the bench measures on one soil.

    Attributes
    ----------
    soil, carcass : names: of the soil, and where the rim's compliance is from
    load, gravity : [N], [m/s^2]
    rows : by slip
    towed : whether the last row is the wheel that is towed
    """

    soil: str
    carcass: str
    load: float
    gravity: float
    rows: tuple[BenchRow, ...]
    towed: bool = False

    @property
    def gain(self) -> float:
        """Largest pull of the flexible wheel less that of the rigid one [N]."""
        return max(row.wheel.drawbar_pull for row in self.rows) - max(row.rigid.drawbar_pull for row in self.rows)

    def to_json(self) -> dict[str, Any]:
        """For a task's result."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> Bench:
        """From `to_json`."""
        rows = tuple(
            BenchRow(
                wheel=WheelState(**row["wheel"]), rigid=WheelState(**row["rigid"]), low=row["low"], high=row["high"]
            )
            for row in values["rows"]
        )
        return cls(**(values | {"rows": rows}))


def carcass_of(found: Mapping[str, Any]) -> Carcass:
    """How the rim gives way, from the result of a task that found it."""
    curve = tuple((float(load), float(way)) for load, way in found["curve"])
    compliance = tuple(float(one) for one in found["compliance"])
    return Carcass(compliance=compliance, load=float(found["load_N"]), curve=curve, source=str(found["source"]))


def wheel_on_soil(design: WheelDesign, carcass: Carcass = RIGID) -> WheelOnSoil:
    """What the soil feels of a design; its grousers are the lugs."""
    lugs = design.grousers
    return WheelOnSoil(
        radius=design.ground_radius,
        width=design.tire.width,
        carcass=carcass,
        lug_height=0.0 if lugs is None else lugs.height,
        lugs=0 if lugs is None else lugs.count,
    )


def run_bench(
    wheel: WheelOnSoil, soil: Soil, load: float, slips: Sequence[float], gravity: float, *, towed: bool = False
) -> Bench:
    """The wheel at slips, and with ``towed`` at that at which it takes no torque, under a load [N]; g [m/s^2].

    Raises
    ------
    InputError
        As `soil.steady_wheel.steady_wheel`.
    """
    rigid = replace(wheel, carcass=RIGID)

    def row(slip: float) -> BenchRow:
        asked = [steady_wheel(wheel, one, load, slip, gravity) for one in with_ends_of_ranges(soil)]
        stiff = asked[0] if wheel.carcass is RIGID else steady_wheel(rigid, soil, load, slip, gravity)
        return _row(asked, stiff)

    rows = [row(slip) for slip in slips]
    if towed:
        free = [towed_wheel(wheel, one, load, gravity) for one in with_ends_of_ranges(soil)]
        rows.append(_row(free, free[0] if wheel.carcass is RIGID else towed_wheel(rigid, soil, load, gravity)))
    source = wheel.carcass.source
    return Bench(soil=soil.name, carcass=source, load=load, gravity=gravity, rows=tuple(rows), towed=towed)


def _row(states: Sequence[WheelState], rigid: WheelState) -> BenchRow:
    pulls = [one.drawbar_pull for one in states]
    return BenchRow(wheel=states[0], rigid=rigid, low=min(pulls), high=max(pulls))


def bench_csv(bench: Bench) -> str:
    """A row a slip, columns as `COLUMNS`."""
    rows = [
        (
            *(row.wheel.slip, row.wheel.drawbar_pull, row.wheel.torque, row.wheel.sinkage),
            *(row.wheel.efficiency, row.wheel.hub_height, row.wheel.deflection, row.wheel.largest_pressure),
            *(row.low, row.high, row.rigid.drawbar_pull, row.rigid.torque, row.rigid.sinkage),
        )
        for row in bench.rows
    ]
    last = "; the last row is towed" if bench.towed else ""
    source = f"wheel on {bench.soil} under {bench.load:g} N, g {bench.gravity:g} m/s^2, rim {bench.carcass}{last}"
    return table_text(CsvTable(names=COLUMNS, values=np.array(rows), source=source, partial=False))
