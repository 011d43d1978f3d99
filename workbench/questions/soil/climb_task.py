"""Task: the rover on slopes of one soil towards one direction: slip, drift, torque and energy over the angle.

A drive ends after a metre, when middle and rear wheels run in the ruts of those before them, or some time after the
rover got stuck. Upwards, slopes between the steepest one climbed and the first that is not are driven too.

Verified by tests/unit/test_workbench_climb.py and tests/end_to_end/test_climb.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.kept_arrays import read_kept, write_kept
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.level_ground import SPEED, straight_ahead
from rover_dynamics.rover.scenarios.on_soil import on_soil
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from soil.soil import Soil
from soil.steady_wheel import WheelOnSoil
from workbench.execution.result_files import write_result
from workbench.questions.soil.bench import carcass_of
from workbench.questions.soil.climb import STUCK, Climb

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["climb"]

FloatArray = NDArray[np.float64]
LASTS, STEADY = 90.0, 10.0
"""Of a drive at most, and when it drives steadily [s]."""
OVER, EVERY = 5.0, 0.1
"""Time the slip is a mean of, above that in which rigid wheels rock, and between samples [s]."""
STAYS = 10.0
"""How long a rover that is stuck is looked at [s]."""
_SAME = 1e-9
"""Difference of equal angles [deg]."""
HALVINGS = 3
"""Of the interval between the steepest slope climbed and the first that is not."""


def climb(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``result.json``: a row for each angle, as `Climb` has them; returns drives.

    Drives in ``checkpoint`` are not driven again.
    """
    soil, design = Soil(**inputs["soil"]), read_rover()
    wheel = WheelOnSoil(**inputs["wheel"], carcass=carcass_of(inputs["carcass"]))
    slope = SCENARIOS[f"slope_{inputs['direction']}"]
    halvings = HALVINGS if inputs["direction"] == "up" else 0
    rows = _kept_rows(checkpoint)

    def drive(angle: float) -> None:
        if any(abs(row.angle_deg - math.degrees(angle)) < _SAME for row in rows):
            return
        drives = replace(
            slope,
            tilt=replace(slope.tilt, angle=angle),
            lasts=LASTS,
            every=EVERY,
            path=straight_ahead(_ways(design)[2]),
            until=_ends,
        )
        rows.append(_driven(angle, on_soil(drives, soil, wheel, cell=inputs["cell"], settling=inputs["settling"])))
        rows.sort(key=lambda row: row.angle_deg)
        if checkpoint is not None:
            write_kept(checkpoint, {"rows": np.array(json.dumps([asdict(row) for row in rows]))})
        progress(len(rows) / (len(inputs["angles"]) + halvings))

    def _driven(angle: float, scenario: Scenario) -> Climb:
        try:
            run = run_scenario(scenario, design)
            why = run.stopped
        except ConvergenceError as error:
            why = str(error)
        return Climb(angle_deg=math.degrees(angle), stopped=why) if why else _row(angle, run)

    for angle in inputs["angles"]:
        drive(angle)
    for _ in range(halvings):
        edge = next(((a, b) for a, b in pairwise(rows) if a.climbs and not b.climbs), None)
        if edge is None or not all(row.climbs for row in rows[: rows.index(edge[1])]):
            break
        drive(math.radians(0.5 * (edge[0].angle_deg + edge[1].angle_deg)))
    progress(1.0)
    write_result(out, {"rows": [asdict(row) for row in rows]})
    return len(rows)


def _kept_rows(checkpoint: Path | None) -> list[Climb]:
    """Of an interrupted run."""
    kept = None if checkpoint is None else read_kept(checkpoint)
    return [] if kept is None else [Climb(**row) for row in json.loads(str(kept["rows"]))]


def _ways(design: RoverDesign) -> tuple[float, float, float]:
    """Ways [m]: to which all wheels press fresh soil, from which middle and rear ones run in ruts, and of a drive."""
    places = sorted({round(leg.drive[0], 6) for leg in design.legs})
    between = [b - a for a, b in pairwise(places)]
    in_ruts = max(between) + design.wheel_radius
    return min(between) - 2.0 * design.wheel_radius, in_ruts, in_ruts + design.wheel_radius


def _ends(design: RoverDesign) -> Callable[[float, FloatArray], bool]:
    """Whether a drive has its way behind it, or has been stuck for long enough."""
    times, places, way = [], [], _ways(design)[2]

    def ends(t: float, positions: FloatArray) -> bool:
        if t < 0.0:
            return False
        times.append(t)
        places.append(float(positions[0, 0]))
        if places[-1] - places[0] >= way:
            return True
        since = STEADY + OVER + STAYS
        return t >= since and bool((_slips(np.array(times), np.array(places), t - STAYS) >= STUCK).all())

    return ends


def _slips(times: FloatArray, places: FloatArray, since: float) -> FloatArray:
    """Means over the last `OVER` seconds at each sample from a time on [-]."""
    steps = round(OVER / EVERY)
    slips = 1.0 - (places[steps:] - places[:-steps]) / (times[steps:] - times[:-steps]) / SPEED
    return slips[times[steps:] >= since - 1e-9]


def _row(angle: float, run: ScenarioRun) -> Climb:
    times, way = run.motion.times, run.place[:, 0] - run.place[0, 0]
    fresh_to, ruts_from, _ = _ways(run.design)
    steady = times >= STEADY
    gone = np.maximum.accumulate(way)
    fresh, ruts = steady & (gone <= fresh_to), gone >= ruts_from

    def paces(when: NDArray[np.bool_]) -> list[float]:
        return [float(np.polyfit(times[when], run.place[when, k], 1)[0]) for k in (0, 1)]

    def energy(when: NDArray[np.bool_], pace: float) -> float | None:
        return float(run.drive_power[when].sum(axis=1).mean()) / pace if pace > 0.0 else None

    ahead, aside = paces(fresh)
    in_ruts = paces(ruts)[0] if times[ruts].size and float(np.ptp(times[ruts])) >= OVER else None
    return Climb(
        angle_deg=math.degrees(angle),
        slip=1.0 - ahead / SPEED,
        largest=float(_slips(times, way, STEADY + OVER).max()),
        drift=aside / SPEED,
        torque=float(run.torques("drive")[fresh].mean()),
        energy=energy(fresh, ahead),
        slip_in_ruts=None if in_ruts is None else 1.0 - in_ruts / SPEED,
        energy_in_ruts=None if in_ruts is None else energy(ruts, in_ruts),
        sinkage=float(run.sinkages[steady].max()),
    )
