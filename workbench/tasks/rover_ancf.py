"""Task: one run of the rover on six ANCF tires.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ancf_reduced.tire_preset import thesis_preset
from contracts.errors import ConvergenceError
from contracts.series import write_series
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.scenario import ScenarioRun, run_scenario, scenario_series
from workbench.execution.result_files import write_result
from workbench.execution.task import Progress
from workbench.tasks.motion_file import MOTION, write_motion
from workbench.tasks.rover_ancf_runs import ancf_run
from workbench.tasks.rover_tires import resuming

__all__ = ["SERIES", "drive_on_ancf_tires"]

SERIES = "series.csv"


def drive_on_ancf_tires(
    inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress, checkpoint: Path | None = None
) -> int:
    """``result.json`` with outcomes, mean spins of the wheels and why it stopped, ``series.csv`` and ``motion.npz``.

    A motion that stops early keeps its series and has no outcomes; one that stops before time zero has neither.
    Goes on from the motion in ``checkpoint``, if there is one.
    """
    design = read_rover()
    scenario = resuming(ancf_run(inputs["run"], design), checkpoint)
    try:
        run = run_scenario(scenario, design)
    except ConvergenceError as error:
        write_result(out, {"outcomes": [], "spins": [], "stopped": str(error), "steps": 0})
        return 0
    write_series(scenario_series(run), out / SERIES)
    write_motion(run, out / MOTION, thesis_preset().hub_radius)
    outcomes = () if run.stopped else scenario.judge(run)
    numbers = {"outcomes": [asdict(outcome) for outcome in outcomes], "spins": _spins(run), "stopped": run.stopped}
    write_result(out, numbers | {"steps": run.motion.steps})
    return 3 * 6 * 36


def _spins(run: ScenarioRun) -> list[float]:
    """Mean spin of each wheel while the straight path is driven at its speed, 5 to 35 s [rad/s]."""
    times = run.motion.times
    window = (times >= 5.0) & (times <= 35.0)
    return [float(spin) for spin in np.mean(run.spins[window], axis=0)] if window.any() else []
