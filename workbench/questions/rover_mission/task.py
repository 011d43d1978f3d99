"""Task: one scenario of the mission on one kind of tire: met or not, by what margin, what it takes, what ends it.

Verified by tests/unit/test_workbench_rover_mission.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.series import write_series
from rover_dynamics.rover.rover_design import RoverDesign, WheelDrive
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.ground import on_friction, on_rigid_tires
from rover_dynamics.rover.scenarios.needs import ending, smallest_friction, smallest_torque
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.scenario_series import scenario_series
from rover_dynamics.vehicle.motors import Motor
from workbench.execution.result_files import read_result, write_result
from workbench.questions.rover.brush import on_given_brush

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["SPARE", "drive_mission"]

SPARE = 1.05
"""Torque over the smallest one found on another tire with which this one is tried once [-]."""
_EVERY = 0.05
"""Longest spacing of the samples of which loads, torques and power are the largest [s]."""
_GROWS = 1.01
"""Ratio of the loads of two rows of what the heaviest wheel carried."""


def drive_mission(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json``, and ``series.csv`` of the run with drives that have no limits, if it began.

    The inputs hold ``scenario`` and ``tire``; the brush tire, see `on_given_brush`, and the ground's ``friction`` or
    None; ``wheel`` for a tire of `workbench.questions.models.wheel_tasks.solved_tire`, ``ancf`` for an ANCF tire;
    whether smallest torque and friction are ``searched``; and ``confirms``, the task whose torque is tried, or None.
    """
    design, scenario = read_rover(), _on_tires(inputs, needs)
    found: dict[str, Any] = {"scenario": inputs["scenario"], "tire": inputs["tire"], "title": scenario.title}
    try:
        run = run_scenario(scenario, design)
    except ConvergenceError as error:
        write_result(out, found | {"met": False, "stopped": str(error), "outcomes": []})
        return 0
    progress(0.2)
    write_series(scenario_series(run), out / "series.csv")
    found |= _read(run)
    if found["met"] and inputs["searched"]:
        found["smallest_torque"] = _with_least(scenario, design, found["torque_Nm"])
        progress(0.6)
        own = with_own_friction(scenario)
        found["smallest_friction"] = smallest_friction(scenario, design, own)
    if found["met"] and inputs["confirms"] is not None:
        found["confirmed"] = _confirmed(scenario, design, read_result(needs[inputs["confirms"]]))
    write_result(out, found)
    return 6 * len(run.motion.positions[0])


def with_own_friction(scenario: Scenario) -> float:
    """Coefficient of friction that a scenario's ground has at rest [-]."""
    return scenario.tire.friction_max if scenario.friction is None else scenario.friction


def _on_tires(inputs: Mapping[str, Any], needs: Mapping[str, Path]) -> Scenario:
    scenario = on_given_brush(scenario_named(inputs["scenario"]), inputs)
    if inputs["tire"] == "rigid":
        scenario = on_rigid_tires(scenario)
    elif inputs["wheel"] is not None:
        from workbench.questions.models.wheel_curves import on_solved_tires

        scenario = on_solved_tires(scenario, inputs["wheel"], needs)
    elif inputs["ancf"] is not None:
        from workbench.questions.rover.tires import on_ancf_tires
        from workbench.study.ancf_tire import tire_from

        scenario = on_ancf_tires(scenario, tire_from(inputs["ancf"]))
    every = min(scenario.every, _EVERY)
    return replace(on_friction(scenario, inputs["friction"]), study=None, search=None, every=every)


def _read(run: ScenarioRun) -> dict[str, Any]:
    """What a run says, JSON values [SI]."""
    outcomes = () if run.stopped else run.scenario.judge(run)
    end = ending(run)
    return {
        "met": run.met,
        "stopped": run.stopped,
        "outcomes": [asdict(one) for one in outcomes if one.limit is not None],
        "ends": None if end is None else asdict(end),
        "torque_Nm": float(np.abs(run.torques("drive")).max()),
        **_effort(run),
        "loads": _records(run.motion.times, run.place[:, 0] - run.place[0, 0], run.loads.max(axis=1)),
    }


def _effort(run: ScenarioRun) -> dict[str, float]:
    way = float(np.linalg.norm(run.place[-1, :2] - run.place[0, :2]))
    return {"power_W": float(run.drive_power.sum(axis=1).max()), "energy_J": energy_of_drives(run), "way_m": way}


def _records(times: NDArray[np.float64], way: NDArray[np.float64], load: NDArray[np.float64]) -> list[list[float]]:
    """Rows time [s], way [m], load [N]: the heaviest wheel carried a hundredth more than ever before, or most."""
    rows: list[list[float]] = []
    peak = int(np.argmax(load))
    for k, row in enumerate(zip(times.tolist(), way.tolist(), load.tolist(), strict=True)):
        if not rows or row[2] > _GROWS * rows[-1][2] or (k == peak and row[2] > rows[-1][2]):
            rows.append(list(row))
    return rows


def _with_least(scenario: Scenario, design: RoverDesign, unlimited: float) -> dict[str, float] | None:
    """Smallest torque, and power and energy of a run with drives of that limit."""
    torque = smallest_torque(scenario, design, unlimited)
    if torque is None:
        return None
    run = run_scenario(scenario, replace(design, drive=WheelDrive(motor=Motor(torque_limit=torque))))
    return {"torque_Nm": torque, **_effort(run)}


def _confirmed(scenario: Scenario, design: RoverDesign, other: Mapping[str, Any]) -> bool | None:
    """Whether this tire meets it with a little more than the other's smallest torque; None where that has none."""
    least = other.get("smallest_torque")
    if least is None:
        return None
    limited = replace(design, drive=WheelDrive(motor=Motor(torque_limit=SPARE * least["torque_Nm"])))
    try:
        return run_scenario(scenario, limited).met
    except ConvergenceError:
        return False
