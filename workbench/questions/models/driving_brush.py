"""Which brush tire drives the rover: that of [brush], or the study's own wheel's, kept by `workbench calibrate brush`.

Verified by tests/unit/test_workbench_driving_brush.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from contracts.errors import InputError
from contracts.hub_travel import OVER_GROUND
from rover_dynamics.tires.brush_tire import BrushTireParameters
from workbench.execution.task import Task
from workbench.questions.curve_graph import stiffness_tasks
from workbench.questions.kept import kept, require_numbers
from workbench.questions.models.wheel_tasks import where_it_moves
from workbench.questions.travels import travel_tasks
from workbench.study.brush_tire import brush_values
from workbench.study.model import Study
from workbench.study.model_parameters import rover_brush

__all__ = ["RECORD", "DrivingBrush", "calibration_tasks", "driving_brush", "driving_inputs"]

RECORD, _STIFFEST = "brush", 1e12
"""Name of the record beside the study."""


class DrivingBrush(NamedTuple):
    """A brush tire, and how its wheel yields forwards and sideways while it sticks [N/m]; None: as its bristles do."""

    tire: BrushTireParameters
    carcass: tuple[float, float] | None


def calibration_tasks(study: Study, model: str, load: float, orientations_deg: Sequence[float]) -> tuple[Task, ...]:
    """Curves at orientations [deg], and the hub moved every way from a load [N] where `where_it_moves` says.

    Raises
    ------
    InputError
        For another model than fe and ancf_wheel, and a study whose wheel is not pressed on level ground.
    """
    moved = travel_tasks(study, model, OVER_GROUND, load, where_it_moves(study))
    tasks = {one.name: one for one in (*stiffness_tasks(study, model, orientations_deg), *moved)}
    return tuple(tasks.values())


def driving_brush(study: Study) -> DrivingBrush:
    """The brush tire that [rover] names.

    Raises
    ------
    InputError
        If it is that of the wheel, whose numbers are not kept, or are of another wheel than the study's.
    """
    stated = rover_brush(study)
    if study.rover is None or study.rover.brush == "study":
        return DrivingBrush(stated, None)
    record = kept(study, RECORD, _numbers)
    again = f"run workbench calibrate brush {'STUDY' if study.kept is None else study.kept.with_suffix('.toml')}"
    if record is None:
        raise InputError("rover.brush", '"wheel"', "has no numbers beside the study", again)
    found = record.found
    state = record.state_of(
        lambda: calibration_tasks(study, found["model"], found["load_N"], found["orientations_deg"])
    )
    if state == "stale":
        rule = f"has numbers of {record.date[:10]} that are of another wheel than the study's is now"
        raise InputError("rover.brush", '"wheel"', rule, f"{again} --model {found['model']} --load {found['load_N']:g}")
    stiffness, carcass = _numbers(found)
    older = ", by older sources of ours" if state == "older sources" else ""
    words = f"of the study's wheel at {found['load_N']:g} N, {record.command}{older}; the rest: {stated.source}"
    return DrivingBrush(replace(stated, radial_stiffness=stiffness, source=words), carcass)


def driving_inputs(study: Study) -> dict[str, Any]:
    """The same and the ground's friction as inputs of a task; ``carcass`` only where the tire has one."""
    tire, carcass = driving_brush(study)
    yields = {} if carcass is None else {"carcass": list(carcass)}
    return {"brush": brush_values(tire), "friction": study.ground.friction, **yields}


def _numbers(found: Mapping[str, Any]) -> tuple[float, tuple[float, float]]:
    """Radial stiffness and carcass of a record [N/m]; raises ValueError for what no wheel has."""
    numbers = [found[f"{name}_N_per_m"] for name in ("radial", "forward", "sideways")]
    require_numbers([*numbers, found["load_N"], *found["orientations_deg"]])
    if not (min(*numbers, found["load_N"]) > 0.0 and max(numbers) < _STIFFEST and found["orientations_deg"]):
        raise ValueError(f"stiffnesses and load must be above zero, stiffnesses below {_STIFFEST:g} N/m")
    if found["model"] not in ("fe", "ancf_wheel"):
        raise ValueError("the model is fe or ancf_wheel")
    return numbers[0], (numbers[1], numbers[2])
