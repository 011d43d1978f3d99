"""Task: one stretch of the way between two samples on one kind of tire: how it ends, and what its wheels carried.

Verified by tests/unit/test_workbench_traverse.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contracts.errors import ConvergenceError
from rover_dynamics.rover.rover_design import RoverDesign
from rover_dynamics.rover.rover_file import read_rover
from rover_dynamics.rover.scenarios.ground import on_friction
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from rover_dynamics.rover.scenarios.stretch import cause_of, stretch
from rover_dynamics.rover.scenarios.way import LONGER, Way, avoided, crossed
from workbench.execution.result_files import write_result
from workbench.questions.rover.brush import on_given_brush
from workbench.questions.traverse.counting import turning_points

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["GATES", "drive_stretch"]

GATES = {"load": 2.0, "deflection": 1e-4}
"""Ranges below which cycles are not counted [N], [m]: a hundredth of the static load, and less than half a hundredth of
its deflection."""


def drive_stretch(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``result.json`` of one stretch.

    The inputs hold ``length`` [m], ``speed`` [m/s], ``abundance`` and ``seed`` of `Way`, the ``stretch`` from 0 on; the
    brush tire, see `on_given_brush`, and the ground's ``friction`` or None; ``wheel`` for a tire of
    `workbench.questions.models.wheel_tasks.solved_tire`, with the ``strengths`` of its parts, or None.
    """
    way = Way(**{name: inputs[name] for name in ("length", "speed", "abundance", "seed")})
    design, number = read_rover(), inputs["stretch"]
    met = crossed(way, number, design)
    found: dict[str, Any] = {
        "rocks": len(met),
        "tallest_m": float(met.max(initial=0.0)),
        "avoided": avoided(way, number, design),
        "yield_N": _first_yield(inputs, needs),
    }
    try:
        run = _driven(inputs, needs, way, design)
    except ConvergenceError as error:
        write_result(out, found | {"ended": {"cause": "computation", "words": str(error)}, "way_m": 0.0})
        return 0
    cause = cause_of(run, way)
    ended = None if cause is None else {"cause": cause, "words": run.stopped or ""}
    write_result(out, found | {"ended": ended} | _read(run, found["yield_N"]))
    return 6 * len(run.motion.positions[0])


def _driven(inputs: Mapping[str, Any], needs: Mapping[str, Path], way: Way, design: RoverDesign) -> ScenarioRun:
    """Once more for longer where the wheels' turns did not take it there."""
    run = run_scenario(_on_tires(stretch(way, inputs["stretch"], design), inputs, needs), design)
    if cause_of(run, way) == "friction":
        run = run_scenario(_on_tires(stretch(way, inputs["stretch"], design, LONGER), inputs, needs), design)
    return run


def _on_tires(scenario: Scenario, inputs: Mapping[str, Any], needs: Mapping[str, Path]) -> Scenario:
    scenario = on_given_brush(scenario, inputs)
    if inputs["wheel"] is not None:
        from workbench.questions.models.wheel_curves import on_solved_tires

        scenario = on_solved_tires(scenario, inputs["wheel"], needs)
    return on_friction(scenario, inputs["friction"])


def _first_yield(inputs: Mapping[str, Any], needs: Mapping[str, Path]) -> float | None:
    """Smallest load at which a part of the study's wheel yields [N]; None of a brush tire, and where none does."""
    if inputs["wheel"] is None:
        return None
    from workbench.questions.models.wheel_curves import curves_around
    from workbench.questions.strength.yielding import first_yield

    found = [first_yield(curve, inputs["strengths"]) for curve in curves_around(inputs["wheel"], needs)]
    return min((one.load for one in found if one.part is not None), default=None)


def _read(run: ScenarioRun, limit: float | None) -> dict[str, Any]:
    """What a run says, JSON values [SI]; lists have one value a wheel. Samples are evenly spaced."""
    times, ahead = run.motion.times, run.place[:, 0] - run.place[0, 0]
    over = None if limit is None else [float(one) for one in np.mean(run.loads > limit, axis=0)]
    return {
        "time_s": float(times[-1]),
        "way_m": float(ahead[-1]),
        "place_m": run.place[-1, :2].tolist(),
        "energy_J": energy_of_drives(run),
        "work_J": float(np.trapezoid((run.torques("drive") * run.drive_speeds).sum(axis=1), times)),
        "aside_m": float(np.abs(run.place[:, 1]).max()),
        "lean_rad": float(run.lean.max()),
        "loads_N": run.loads.max(axis=0).tolist(),
        "deflections_m": run.deflections.max(axis=0).tolist(),
        "airborne": np.mean(run.loads <= 0.0, axis=0).tolist(),
        "over": over,
        "load": [turning_points(column, GATES["load"]) for column in run.loads.T],
        "deflection": [turning_points(column, GATES["deflection"]) for column in run.deflections.T],
    }
