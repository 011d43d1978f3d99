"""Task: one scenario of the rover on a study's brush tires.

Verified by tests/unit/test_workbench_rover.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contracts.series import write_series
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.ground import on_friction
from rover_dynamics.rover.scenarios.scenario import run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from workbench.execution.result_files import FAILURE, write_result
from workbench.questions.rover.brush import on_given_brush
from workbench.questions.rover.motion_file import MOTION, write_motion

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["drive_rover"]


def drive_rover(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``series.csv``, ``motion.npz``, and ``result.json`` with the outcomes of scenario and study.

    The inputs hold the scenario's name, the brush tire, see `on_given_brush`, and the ground's ``friction`` or None.
    """
    driven = on_given_brush(scenario_named(inputs["scenario"]), inputs)
    scenario, design = on_friction(driven, inputs["friction"]), read_rover()
    run = run_scenario(scenario, design)
    progress(0.5)
    write_series(scenario_series(run), out / "series.csv")
    write_motion(run, out / MOTION)
    outcomes = () if run.stopped else scenario.judge(run) + (scenario.study(scenario, design) if scenario.study else ())
    write_result(out, {"outcomes": [asdict(outcome) for outcome in outcomes], FAILURE: run.stopped})
    return 6 * len(run.motion.positions[0])
