"""What the report drives on a study's six ANCF tires: the thesis' scenarios, the mission's requirements if asked for.

Verified by tests/unit/test_workbench_rover_ancf.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from ancf_reduced.tire.mesh import Tire, build_tire, tire_on_mesh
from ancf_reduced.tire.preset import TirePreset
from contracts.errors import InputError
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.rover.scenarios.catalogue import SCENARIOS
from rover_dynamics.rover.scenarios.ground import on_friction, on_terrain, rocks_on_the_way
from rover_dynamics.rover.scenarios.level_ground import all_drives, sweep_of_gravity
from rover_dynamics.rover.scenarios.scenario import Scenario
from workbench.questions.rover.close_look import EVERY
from workbench.questions.rover.tires import STEPS, contact_law, on_ancf_tires

__all__ = ["ancf_run", "fitted_run"]

_Variant = Callable[[Tire, RoverDesign], Scenario]
LOADS = (160.0, 190.0, 220.0, 250.0)
"""Of the sweep [N]."""
FINE_GRID = (14, 14)
"""Contact points of a plate, about twice as many as the thesis' 100; stiffness and damping of each are less by as
much."""
ROCK_SEED = 1
LIGHTER = 0.5
"""Density of a fitted tire, of which nothing at rest depends: as fitted it has the mass of the whole wheel, hub
included."""


def _sweep(between: float) -> _Variant:
    """Drives held, so that no wheel rolls off where it starts: so much of the angle between spokes off a spoke."""

    def scenario(tire: Tire, _: RoverDesign) -> Scenario:
        turned = tire.preset.phase + between * 2.0 * math.pi / tire.preset.spokes
        held = replace(
            SCENARIOS["load_sweep"],
            title=f"mean wheel load by scaled gravity, drives held, tires turned by {math.degrees(turned):g} degrees",
            actuators=lambda design: all_drives(design, Hold()),
            composed=partial(sweep_of_gravity, loads=LOADS),
        )
        return on_ancf_tires(held, tire, turned=turned)

    return scenario


def _drop(tire: Tire, _: RoverDesign) -> Scenario:
    return on_ancf_tires(replace(SCENARIOS["drop"], lasts=1.0, every=5e-3, closer=None), tire)


def _traction(
    tire: Tire,
    *,
    half_step: bool = False,
    fine_grid: bool = False,
    undamped: bool = False,
    lasts: float = 2.0,
) -> Scenario:
    title = f"3.5 N m on each drive for {lasts:g} s after 5 s of settling, friction 0.6"
    short = replace(SCENARIOS["traction"], title=title, lasts=lasts, every=5e-3)
    steps = replace(STEPS, tolerance=STEPS.tolerance / 8.0) if half_step else STEPS  # of third order
    law = contact_law(tire.preset)
    if not fine_grid:
        return on_ancf_tires(short, tire, steps=steps, law=law.undamped() if undamped else law)
    share = math.prod(tire.preset.contact_points) / math.prod(FINE_GRID)
    finer = tire_on_mesh(replace(tire.preset, contact_points=FINE_GRID), tire.mesh)
    law = replace(law, stiffness=share * law.stiffness, damping=share * law.damping)
    return on_ancf_tires(short, finer, steps=steps, law=law)


def _rocks(tire: Tire, design: RoverDesign) -> Scenario:
    straight = on_ancf_tires(SCENARIOS["straight"], tire)
    rocks = rocks_on_the_way(straight, design, ROCK_SEED)
    return on_terrain(straight, design, rocks, f"random rocks, seed {ROCK_SEED}")


def _straight(tire: Tire, _: RoverDesign) -> Scenario:
    """Sampled as closely as the body's vibration asks for."""
    return on_ancf_tires(replace(SCENARIOS["straight"], every=EVERY), tire)


_VARIANTS: dict[str, _Variant] = {
    "drop": _drop,
    "load_sweep": _sweep(0.0),
    "load_sweep_between": _sweep(0.5),
    "straight": _straight,
    "traction": lambda tire, _: _traction(tire),
    "traction_half_step": lambda tire, _: _traction(tire, half_step=True),
    "traction_fine_grid": lambda tire, _: _traction(tire, fine_grid=True),
    "traction_whole": lambda tire, _: _traction(tire, lasts=10.0),
    "traction_undamped": lambda tire, _: _traction(tire, undamped=True),
    "rocks": _rocks,
}


def ancf_run(name: str, design: RoverDesign, tire: Tire, friction: float | None = None) -> Scenario:
    """The scenario of a run, which carries the run's name, on tires and ground of a study; None: the run's friction."""
    if name not in _VARIANTS and name not in SCENARIOS:
        raise InputError(
            "run on ANCF tires", repr(name), "is not known", f"give a scenario or one of {', '.join(_VARIANTS)}"
        )
    driven = _VARIANTS[name](tire, design) if name in _VARIANTS else on_ancf_tires(SCENARIOS[name], tire)
    return replace(on_friction(driven, friction), name=name, study=None)


def fitted_run(name: str, preset: TirePreset, design: RoverDesign, friction: float | None = None) -> Scenario:
    """A scenario of the mission, or random rocks, on six tires of a fit; friction as of `ancf_run`."""
    tire = build_tire(replace(preset, density=LIGHTER * preset.density))
    base = SCENARIOS["straight" if name == "rocks" else name]
    scenario = on_ancf_tires(base, tire)
    if name == "rocks":
        rocks = rocks_on_the_way(base, design, ROCK_SEED)
        scenario = on_terrain(scenario, design, rocks, f"random rocks, seed {ROCK_SEED}")
    return replace(on_friction(scenario, friction), name=f"{name}_fitted", study=None)
