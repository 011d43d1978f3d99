"""The record of ``workbench climb`` as the report of its study shows it.

Verified by tests/unit/test_workbench_climb.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rover_dynamics.soil.field import CELL
from soil.carcass import RIGID, Carcass
from soil.steady_wheel import WheelOnSoil
from workbench.execution.task import Task
from workbench.questions.kept import Kept, State, kept
from workbench.questions.soil.bench import carcass_of, wheel_on_soil
from workbench.questions.soil.climb import RECORD, Climbs, climb_tasks, climbs_of
from workbench.questions.soil.graph import carcass_name, soils_of
from workbench.study.model import Study
from workbench.study.model_parameters import rover_brush
from workbench.study.soil_file import soil_of
from workbench.study.wheel_design import wheel_design

__all__ = ["HeldClimbs", "brush_rim", "held_climbs", "rim_and_settling"]


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldClimbs:
    """The record, whether it is about the study as it is, and its drives."""

    record: Kept
    state: State
    climbs: tuple[Climbs, ...]

    def of(self, direction: str) -> tuple[Climbs, ...]:
        """Towards one direction."""
        return tuple(one for one in self.climbs if one.direction == direction)

    @property
    def angles(self) -> tuple[float, ...]:
        """Slopes that were asked for [deg]; upwards there are more between."""
        return _asked(self.climbs)

    @property
    def best(self) -> dict[str, Climbs]:
        """Upwards by soil, on the last tire that was driven: the most flexible one, if tires are named as usual."""
        return {one.soil: one for one in self.of("up")}


def held_climbs(study: Study) -> HeldClimbs | None:
    """None where there is no record."""
    record = kept(study, RECORD, climbs_of)
    if record is None:
        return None
    climbs = climbs_of(record.found)
    return HeldClimbs(record=record, state=record.state_of(lambda: _tasks(study, climbs)), climbs=climbs)


def brush_rim(study: Study) -> Carcass:
    """Of the brush tire: a circle that keeps its shape and shifts against the hub."""
    stiffness = rover_brush(study).radial_stiffness
    return Carcass(compliance=(0.0, 1.0 / stiffness), source="brush tire, a rigid circle on a spring")


def rim_and_settling(study: Study, tire: str, rim: Carcass) -> tuple[WheelOnSoil, float | None]:
    """The study's wheel on such a rim, and the time in which that settles [s]; None for the usual one."""
    brush = rover_brush(study)
    settling = brush.radial_damping / brush.radial_stiffness if tire == "brush" else None
    return wheel_on_soil(wheel_design(study), rim), settling


def _tasks(study: Study, climbs: Sequence[Climbs]) -> list[Task]:
    """Those of the record, as the study is now."""
    known = {} if study.soil is None else {one.name: one for one in soils_of(study)}
    soils = [known.get(name) or soil_of(name) for name in dict.fromkeys(one.soil for one in climbs)]
    tires = dict.fromkeys(one.tire for one in climbs)
    wheels = {tire: rim_and_settling(study, tire, _rim(study, tire)) for tire in tires}
    return climb_tasks(soils, wheels, [math.radians(angle) for angle in _asked(climbs)], CELL)


def _asked(climbs: Sequence[Climbs]) -> tuple[float, ...]:
    """As they were typed: 3, not 2.9999999999999996."""
    return tuple(round(row.angle_deg, 12) for row in min((one.rows for one in climbs), key=len))


def _rim(study: Study, tire: str) -> Carcass:
    if tire == "rigid":
        return RIGID
    if tire == "brush":
        return brush_rim(study)
    record = kept(study, carcass_name(tire))
    return RIGID if record is None else carcass_of(record.found)
