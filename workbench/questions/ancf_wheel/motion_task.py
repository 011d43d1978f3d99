"""Task of an ANCF wheel in motion: it rolls, falls, or rolls over a half-round.

Verified by tests/end_to_end/test_roll.py.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf_reduced.wheel.mesh import AncfWheel, build_ancf_wheel
from ancf_reduced.wheel.static import WheelOnGround
from ancf_reduced.wheel_motion.friction import Friction
from ancf_reduced.wheel_motion.rest import above, standing
from ancf_reduced.wheel_motion.rolling import Hub, Motion, RollingWheel
from ancf_reduced.wheel_motion.travel import Account, TravelSettings, travel
from contracts.errors import ConvergenceError, InputError
from contracts.series import TimeSeries, write_series
from contracts.terrain import Plane, Terrain, TerrainUnion
from contracts.terrain_ridges import HalfRound
from workbench.execution.result_files import FAILURE, write_result
from workbench.study.wheel_design import design_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["SERIES", "move"]

SERIES = "series.csv"
_INERTIA = 0.05
"""Of what turns with the hub [kg m^2]."""
_GAIN = 500.0
"""Of the drive [N m s]: 1 % off the speed of 70 m/h are 0.7 N m."""
_DAMPING = 0.05
"""Of the first mode with the hub held [-]."""
_BEFORE = 1e-3
"""Way from where it stands to where it first touches the half-round [m]."""
_TOLERANCES = {"drop": 1e-5}
"""Local error of a step [m] where it is not `_USUAL`: a drop's load is 0.7 of its largest off with that."""
_USUAL = 3e-5
_ENERGIES = ("kinetic", "strain", "weight", "contact", "damping", "friction", "drive")


@dataclass(slots=True)
class _Watched:
    """States on the way and their account."""

    wheel: RollingWheel
    rows: list[tuple[float, ...]] = field(default_factory=list)
    account: Account = field(default_factory=Account)

    def __call__(self, motion: Motion) -> None:
        hub = self.wheel.hub
        torque = hub.gain * (hub.speed - float(motion.v[-1]))
        self.rows.append((*motion.y[-3:], *self.wheel.load(motion), torque))

    def series(self, case: str, source: str, *, partial: bool) -> TimeSeries:
        names = ("hub_x_m", "hub_z_m", "hub_angle_rad", "load_x_N", "load_z_N", "torque_Nm")
        table, rows = np.array(self.account.rows), np.array(self.rows)
        columns = {name: rows[:, k] for k, name in enumerate(names)}
        columns |= {f"{name}_J": table[:, 1 + k] for k, name in enumerate(_ENERGIES)}
        totals = self.account.totals
        columns["account_J"] = totals - totals[0]
        return TimeSeries(
            scenario=case, tire="ancf_wheel", time=table[:, 0], columns=columns, source=source, partial=partial
        )


def move(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``series.csv`` and ``result.json``: largest load, account, processor time; returns the unknowns."""
    wheel = build_ancf_wheel(design_from(inputs["wheel"]), **inputs["options"])
    rolling, start, ahead = _begun(wheel, inputs)
    watched, seconds = _Watched(rolling), inputs["seconds"]
    watched(start)
    begun, failure = time.process_time(), None

    def watch(motion: Motion) -> None:
        watched(motion)
        progress(motion.time / seconds)

    try:
        settings = TravelSettings(tolerance=_TOLERANCES.get(inputs["case"], _USUAL), largest_step=0.1)
        list(travel(rolling, start, [seconds], settings, watched.account, watch))
    except ConvergenceError as error:
        failure = str(error)
    spent, unknowns = time.process_time() - begun, rolling.size
    source = f"{inputs['title']}: thin ANCF plates, {unknowns} unknowns, hub at x, z above level ground"
    series = watched.series(inputs["case"], source, partial=failure is not None)
    write_series(series, out / SERIES)
    numbers = {
        "dofs": unknowns,
        "steps": len(series.time) - 1,
        "end_s": float(series.time[-1]),
        "largest_load_N": float(series["load_z_N"].max()),
        "last_load_N": float(series["load_z_N"][-1]),
        "account": watched.account.closure(),
        "account_J": float(np.ptp(watched.account.totals)),
        "reached": bool(series["load_z_N"].max() > 0.0 and (ahead is None or series["hub_x_m"].max() >= ahead)),
        "cpu_s": spent,
        FAILURE: failure,
    }
    write_result(out, numbers)
    return unknowns


def _begun(wheel: AncfWheel, inputs: Mapping[str, Any]) -> tuple[RollingWheel, Motion, float | None]:
    """The wheel; at rest, above the ground for a drop, else under its weight; where a half-round stands [m]."""
    rolling = _rolling(wheel, inputs, Plane())
    if inputs["case"] == "drop":
        return rolling, above(rolling, inputs["height"]), None
    start = standing(rolling)
    if inputs["case"] == "rolling":
        return rolling, start, None
    rock, outer = inputs["radius"], float(np.linalg.norm(wheel.plates.reference[:, 0, [0, 2]], axis=1).max())
    if not rock < 0.5 * outer:
        rule = f"must be below {500.0 * outer:.4g} mm, half of the wheel's radius"
        raise InputError("radius", f"{1e3 * rock:g} mm", rule, "10 mm is usual")
    touch = float(np.sqrt((outer + rock) ** 2 - float(start.y[-2]) ** 2))
    ground = TerrainUnion(parts=(Plane(), HalfRound(radius=rock, position=touch + _BEFORE)))
    rolling = _rolling(wheel, inputs, ground)
    return rolling, standing(rolling), touch + _BEFORE


def _rolling(wheel: AncfWheel, inputs: Mapping[str, Any], terrain: Terrain) -> RollingWheel:
    """The wheel with what its load leaves for the hub."""
    problem = WheelOnGround(wheel, 0.0, inputs["contact_stiffness"], inputs["inner_contact_stiffness"], terrain=terrain)
    gravity, mass = inputs["gravity"], inputs["load"] / inputs["gravity"]
    radius = -float(problem.ground.risen(0.0)[1][2])
    drives = inputs["case"] != "drop"
    drive = {"speed": inputs["speed"] / radius, "gain": _GAIN} if drives else {}
    one = np.zeros_like(wheel.plates.reference)
    one[:, 0, 0] = 1.0
    own = wheel.sides * float(one.ravel() @ (wheel.plates.mass() @ one.ravel()))
    if not mass > own:
        rule = f"must be more than the wheel's own weight, {own * gravity:.3g} N"
        raise InputError("load", f"{inputs['load']:g} N", rule, "198 N stand on a wheel of the thesis' rover on Mars")
    hub = Hub(mass=mass - own, inertia=_INERTIA, **drive)
    return RollingWheel(problem, hub, gravity, Friction(coefficient=inputs["friction"]), _DAMPING)
