"""A scenario on soil that keeps its ruts, with wheels of the study's kind.

Verified by tests/verification/test_rover_on_soil.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from contracts.errors import InputError
from contracts.terrain_cover import extent
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.outcome import Outcome
from rover_dynamics.rover.scenarios.readings import energy_of_drives
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun
from rover_dynamics.rover.scenarios.walking import WALKED
from rover_dynamics.soil.field import CELL, SoilBed
from soil.soil import Soil
from soil.steady_wheel import WheelOnSoil

__all__ = ["on_soil"]

MARGIN, ASIDE = 1.0, 0.25
"""A field beyond the wheels' places [m], and more by this share of the way, along which slopes turn a rover."""
_LAST, _STRAIGHT, _AT_SPEED = 5.0, 0.98, 0.95
"""Time over which the slip is taken [s], the cosine of a turn beyond which there is none, and the share of its largest
speed from which on a rover drives at speed."""


def on_soil(
    scenario: Scenario, soil: Soil, wheel: WheelOnSoil, *, cell: float = CELL, settling: float | None = None
) -> Scenario:
    """The same drive on soil, as the ground of the scenario lies: level, or a height field.

    Parameters
    ----------
    scenario : what the rover does; a slope is a tilt of gravity, or one of its height field
    soil, wheel : numbers of the soil; radius, width, rim and lugs of all six wheels
    cell : length of a cell [m]
    settling : see `rover_dynamics.soil.field.SoilBed`; its own if None

    Raises
    ------
    InputError
        For a scenario that has a ground of its own, or drives on a rough one; when it is driven, for a wheel of another
        radius than the rover's.
    """
    path = scenario.path
    if path is None:
        rule = "has a ground of its own, or does not drive"
        raise InputError(f"soil of scenario {scenario.name}", soil.name, rule, "drive e.g. straight, or leave it out")

    def bed(design: RoverDesign) -> SoilBed:
        if abs(wheel.radius - design.wheel_radius) > 1e-9:
            rule = f"is not that of the rover's wheels, {1e3 * design.wheel_radius:g} mm"
            raise InputError(
                "radius of the wheel on soil",
                f"{1e3 * wheel.radius:g} mm",
                rule,
                "give a study and a rover of one wheel",
            )
        places = path(design)
        beyond = MARGIN + design.wheel_radius + ASIDE * float(np.ptp(places, axis=0).max())
        terrain = scenario.terrain(design)
        low, high = extent(terrain)
        x, y = np.maximum(places.min(axis=0) - beyond, low).tolist()
        end_x, end_y = np.minimum(places.max(axis=0) + beyond, high - cell).tolist()
        more = {} if settling is None else {"settling": settling}
        numbers = {"load": design.static_load, "gravity": design.gravity, "cell": cell, **more}
        return SoilBed(soil=soil, wheel=wheel, low=(x, y), high=(end_x, end_y), terrain=terrain, **numbers)

    return replace(
        scenario,
        title=f"{scenario.title}; on soil {soil.name}",
        soil=bed,
        judge=_judging(scenario),
        has_closed_forms=False,
        study=None,
        search=None,
    )


def _judging(scenario: Scenario) -> Callable[[ScenarioRun], tuple[Outcome, ...]]:
    def judge(run: ScenarioRun) -> tuple[Outcome, ...]:
        return *scenario.judge(run), *_told(run)

    return judge


def _told(run: ScenarioRun) -> tuple[Outcome, ...]:
    """What the soil adds: sinkage, ruts, slip and energy over the way."""
    times, ruts, R = run.motion.times, run.motion.ruts, run.motion.rotations[:, 0]
    found = [
        Outcome(quantity="deepest sinkage of a wheel", value=1e3 * float(run.sinkages.max()), unit="mm"),
        Outcome(quantity="deepest rut", value=1e3 * float(ruts.depth.max()) if ruts is not None else 0.0, unit="mm"),
    ]
    ahead = R[0, :2, 0]
    by_wheels = run.torques("drive").shape[1] == len(run.design.legs) and not run.scenario.name.endswith(WALKED)
    if not by_wheels or float(R[-1, :2, 0] @ ahead) < _STRAIGHT:
        return tuple(found)
    pace = run.spins.mean(axis=1)
    ends = times[np.flatnonzero(pace >= _AT_SPEED * pace.max())[-1]]
    late = (times >= ends - _LAST) & (times <= ends)
    rolled = float(np.trapezoid(run.spins[late], times[late], axis=0).mean()) * run.design.wheel_radius
    steps = np.diff(run.place, axis=0)
    ahead_of_each = steps[:, :2] @ ahead
    ways = np.copysign(np.hypot(ahead_of_each, steps[:, 2]), ahead_of_each)  # along the ground, however it rises
    gone, way = float(ways[late[1:] & late[:-1]].sum()), float(ways.sum())
    if rolled > 0.0:
        found.append(
            Outcome(quantity="slip of the rover, mean of its last 5 s at speed", value=1.0 - gone / rolled, unit="-")
        )
    if way > 0.0:
        found.append(Outcome(quantity="energy of the drives a metre", value=energy_of_drives(run) / way, unit="J/m"))
    return tuple(found)
