"""Task: the rover on slopes of one soil towards one direction: slip, drift, torque and energy over the angle.

Verified by tests/unit/test_workbench_climb.py and tests/end_to_end/test_climb.py.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.errors import ConvergenceError
from contracts.kept_arrays import read_kept, write_kept
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.level_ground import SPEED
from rover_dynamics.rover.scenarios.on_soil import on_soil
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario
from soil.soil import Soil
from soil.steady_wheel import WheelOnSoil
from workbench.execution.result_files import write_result
from workbench.questions.soil.bench import carcass_of
from workbench.questions.soil.climb import Climb

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["climb"]

LASTS, LATE = 30.0, 15.0
"""Of a drive, and its part that is looked at [s]."""


def climb(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``result.json``: a row for each angle, as `Climb` has them; returns drives.

    Goes on behind the last drive in ``checkpoint``, if there is one.
    """
    soil, design = Soil(**inputs["soil"]), read_rover()
    wheel = WheelOnSoil(**inputs["wheel"], carcass=carcass_of(inputs["carcass"]))
    slope, rows = SCENARIOS[f"slope_{inputs['direction']}"], _driven(checkpoint)
    for number, angle in enumerate(inputs["angles"][len(rows) :], len(rows) + 1):
        tilted = replace(slope, tilt=replace(slope.tilt, angle=angle), lasts=LASTS, every=0.1)
        driven = on_soil(tilted, soil, wheel, cell=inputs["cell"], settling=inputs["settling"])
        try:
            run, why = run_scenario(driven, design), None
            why = run.stopped
        except ConvergenceError as error:
            run, why = None, str(error)
        rows.append(asdict(_row(angle, run, why)))
        if checkpoint is not None:
            write_kept(checkpoint, {"rows": np.array(json.dumps(rows))})
        progress(number / len(inputs["angles"]))
    write_result(out, {"rows": rows})
    return len(rows)


def _driven(checkpoint: Path | None) -> list[dict[str, Any]]:
    """Rows that an interrupted run has kept."""
    kept = None if checkpoint is None else read_kept(checkpoint)
    return [] if kept is None else list(json.loads(str(kept["rows"])))


def _row(angle: float, run: ScenarioRun | None, why: str | None) -> Climb:
    if run is None or why is not None:
        return Climb(angle_deg=math.degrees(angle), stopped=why or "")
    times = run.motion.times
    late = times >= LASTS - LATE
    ahead, aside = (float(np.polyfit(times[late], run.place[late, k], 1)[0]) for k in (0, 1))
    power = float(run.drive_power[late].sum(axis=1).mean())
    return Climb(
        angle_deg=math.degrees(angle),
        slip=1.0 - ahead / SPEED,
        drift=aside / SPEED,
        torque=float(run.torques("drive")[late].mean()),
        energy=power / ahead if ahead > 0.0 else None,
        sinkage=float(run.sinkages[late].max()),
    )
