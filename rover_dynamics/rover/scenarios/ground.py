"""A scenario on another ground, and on other tires.

On uneven ground the rover starts level, so high that the first of its wheels touches, or as far above or below that as
its scenario says, and comes down on the others while it settles. Requirements are the mission's for its own ground:
what is searched or studied beside the run is left out here.

Verified by tests/unit/test_rover_ground.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contracts.errors import InputError
from contracts.terrain import Terrain
from contracts.terrain_cover import check_covered
from contracts.terrain_rocks import RandomRocks
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.scenario import FloatArray, Scenario
from rover_dynamics.tires.brush_settings import Carcass, yielding
from rover_dynamics.tires.brush_tire import BrushTireParameters
from rover_dynamics.tires.rigid import rigid_parameters, rigid_settings
from rover_dynamics.tires.wheel_potential import WheelPotential, mean_stiffness

__all__ = [
    "on_brush_tires",
    "on_friction",
    "on_rigid_tires",
    "on_terrain",
    "on_wheel_curves",
    "rocks_on_the_way",
    "touching_height",
]

ABUNDANCE = 0.2
"""Share of the ground under random rocks, as in `benchmarks/rover_brush.py`: a rocky site."""
MARGIN, ASIDE = 0.5, 0.25
"""A field of rocks beyond the wheels' places [m], and more by this share of the way, along which rocks turn a rover."""


def on_terrain(scenario: Scenario, design: RoverDesign, terrain: Terrain, words: str) -> Scenario:
    """The same drive over another ground.

    Parameters
    ----------
    scenario, design : what drives
    terrain : the ground, in the rover's frame: it starts over the origin towards +x
    words : what the ground is called

    Raises
    ------
    InputError
        For a scenario that has a ground of its own; if the terrain does not cover the way of the wheels.
    """
    check_covered(terrain, _path(scenario, design), design.wheel_radius)
    height = touching_height(terrain, design) + (scenario.height or 0.0)
    return replace(
        scenario,
        title=f"{scenario.title}; on {words}",
        terrain=lambda _: terrain,
        height=height,
        study=None,
        search=None,
    )


def rocks_on_the_way(scenario: Scenario, design: RoverDesign, seed: int) -> Terrain:
    """Random rocks as far as the wheels are to go, from a seed; see `contracts.terrain_rocks.RandomRocks`."""
    path = _path(scenario, design)
    beyond = MARGIN + design.wheel_radius + ASIDE * float(np.ptp(path, axis=0).max())
    low, high = path.min(axis=0) - beyond, path.max(axis=0) + beyond
    (x, y), (length, width) = low.tolist(), (high - low).tolist()
    return RandomRocks(seed=seed, size=(length, width), origin=(x, y), abundance=ABUNDANCE).terrain()


def on_brush_tires(scenario: Scenario, tire: BrushTireParameters, carcass: Carcass | None = None) -> Scenario:
    """The same on six of these brush tires; with a carcass they yield along the ground as it does, see `yielding`."""
    settings = scenario.settings if carcass is None else yielding(scenario.settings, tire, carcass)
    return replace(scenario, tire=tire, settings=settings)


def on_friction(scenario: Scenario, friction: float | None) -> Scenario:
    """The same on ground of another coefficient of friction [-], on whatever tires; as it is for None.

    A scenario that holds fast keeps its own, as the static stability does, which is asked of a rover that cannot slide.
    """
    if friction is None or scenario.holds_fast:
        return scenario
    own = "" if scenario.friction is None else f", friction {scenario.friction:g}"
    title = f"{scenario.title.removesuffix(own)}, friction {friction:g}"
    return replace(scenario, friction=friction, title=title)


def on_rigid_tires(scenario: Scenario) -> Scenario:
    """The same on rigid wheels, once; see `rover_dynamics.tires.rigid`."""
    if scenario.tire_model == "rigid":
        return scenario
    return replace(
        scenario,
        tire=rigid_parameters(scenario.tire),
        settings=rigid_settings(scenario.settings),
        tire_model="rigid",
    )


def on_wheel_curves(
    scenario: Scenario, potential: WheelPotential, source: str, carcass: Carcass | None = None, model: str = "fe"
) -> Scenario:
    """The same on six wheels that carry as their own curves say, with friction and damper of the brush tire.

    A wheel that rolls slips as the brush tire does. Before it slides it yields as its carcass; without one, as the
    brush's bristles. All six stand on their position 0 at the start, and none is the mirror image of another.

    Parameters
    ----------
    scenario : on brush tires
    potential : of the wheel
    source : in words
    carcass : of the wheel
    model : what series and files call it
    """
    tire = replace(scenario.tire, radial_stiffness=mean_stiffness(potential), source=source)
    settings = replace(scenario.settings, potential=potential)
    if carcass is not None:
        settings = yielding(settings, tire, carcass)
    return replace(scenario, tire=tire, settings=settings, tire_model=model, has_closed_forms=False)


def touching_height(terrain: Terrain, design: RoverDesign) -> float:
    """Height [m] of the level rover's lowest points at which the first wheel touches: largest of h - its rim."""
    s = np.linspace(-1.0, 1.0, 57) * design.wheel_radius
    rim = design.wheel_radius - np.sqrt(design.wheel_radius**2 - s * s)
    x, y, z = np.array([leg.drive for leg in design.legs]).T
    return float(np.max(terrain.height(x[:, None] + s, y[:, None] + 0.0 * s) - rim - z[:, None]))


def _path(scenario: Scenario, design: RoverDesign) -> FloatArray:
    if scenario.path is None:
        rule = "has a ground of its own, or does not drive"
        raise InputError(
            f"terrain of scenario {scenario.name}", "another", rule, "drive e.g. straight, or leave it out"
        )
    return scenario.path(design)
