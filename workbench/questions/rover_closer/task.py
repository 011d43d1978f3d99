"""Tasks beside the straight path on ANCF tires: rocks, the brush tire, the tires at rest; the path as an animation.

Verified by tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ancf_reduced.tire.mesh import Tire
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.errors import ConvergenceError, InputError
from contracts.series import write_series
from contracts.terrain import Plane
from contracts.terrain_rocks import RandomRocks
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.ground import on_friction, on_terrain
from rover_dynamics.rover.scenarios.level_ground import SPEED, drive_forward, straight_ahead
from rover_dynamics.rover.scenarios.scenario import Scenario, run_scenario
from rover_dynamics.rover.standing import stand_under_loads
from workbench.execution.result_files import FAILURE, write_result
from workbench.questions.rover.brush import on_given_brush
from workbench.questions.rover.close_look import EVERY, body_series, coarse_skin
from workbench.questions.rover.motion_file import MOTION, read_motion
from workbench.questions.rover.tires import DAMPING_RATIO, contact_law, on_ancf_tires
from workbench.study.ancf_tire import drawn_tire, tire_from

if TYPE_CHECKING:
    from workbench.execution.task import Progress

__all__ = ["ANIMATION", "animate", "drive_closely", "stands"]

ANIMATION = "animation.html"
_BEYOND = 0.6
"""Rocks beyond the wheels' places [m]."""
_ASIDE = 0.05
"""Of the wheel load, to either side, over which the stiffness is taken [-]."""


def drive_closely(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``straight_brush.csv``, ``rocks_{brush,ancf}.csv``, and in the result what `stands` finds; why a drive ended.

    The inputs hold both tires, see `on_given_brush` and `workbench.study.ancf_tire`, and the friction.
    """
    design, tire, stopped = read_rover(), tire_from(inputs), dict[str, str]()
    path = on_friction(on_given_brush(_path(inputs["lasts"]), inputs), inputs["friction"])
    rocks = _on_rocks(path, design, inputs["rocks"])
    for ground, scenario in (("straight", path), ("rocks", rocks)):
        write_series(body_series(run_scenario(scenario, design), ground, None), out / f"{ground}_brush.csv")
    progress(0.2)
    try:
        run = run_scenario(on_ancf_tires(rocks, tire), design)
    except (ConvergenceError, InputError) as error:
        stopped["rocks"] = str(error)
    else:
        write_series(body_series(run, "rocks", tire), out / "rocks_ancf.csv")
        if run.stopped:
            stopped["rocks"] = run.stopped
    progress(0.8)
    try:
        found: dict[str, Any] | None = stands(tire, design)
    except (ConvergenceError, InputError) as error:
        found, stopped["at rest"] = None, str(error)
    write_result(out, {"stopped": stopped, "stands": found, FAILURE: None})
    return 0


def stands(tire: Tire, design: RoverDesign) -> dict[str, Any]:
    """The rover at rest on the tires by `rover_dynamics.rover.standing`, in twelve orientations from spoke to spoke.

    ``strain`` and ``stiffness`` [N/m] at the wheel load, a list over the orientations; ``strain_alike``, of a rover
    whose six wheels all stand alike, as it sets out. Raises ConvergenceError or InputError if it does not stand.
    """
    load, skin = design.static_load, coarse_skin(tire)
    tires = wheel_set(
        tire,
        Plane(),
        len(design.legs),
        law=replace(contact_law(tire.preset), friction=0.0),
        damping_ratio=DAMPING_RATIO,
    )
    (alike,) = stand_under_loads(design, tires, np.zeros(len(design.legs)), [load])
    strains, stiffness = list[float](), list[float]()
    apart = 360.0 / tire.preset.spokes / len(design.legs)
    for first in (0.0, 0.5 * apart):
        turned = np.radians(first + apart * np.arange(len(design.legs)))
        loads = [load, (1.0 - _ASIDE) * load, (1.0 + _ASIDE) * load]
        at, below, above = stand_under_loads(design, tires, turned, loads)
        strains += [float(skin.largest_strain(z).max()) for z in at.vectors]
        stiffness += ((above.load - below.load) / (above.deflection - below.deflection)).tolist()
    same = max(float(skin.largest_strain(z).max()) for z in alike.vectors)
    return {"strain": strains, "stiffness": stiffness, "strain_alike": same}


def animate(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """``animation.html`` of the motion a need recorded on ANCF tires; none if it never began."""
    from workbench.questions.rover.animation import write_animation

    recorded = needs[inputs["motion"]] / MOTION
    if recorded.exists():
        motion = read_motion(recorded)
        title, most = inputs["title"], inputs["frames"]
        tire = drawn_tire(motion.tire, motion.vectors.shape[2]) if motion.tire is not None else None
        write_animation(motion.replayed(), read_rover(), Plane(), out / ANIMATION, title=title, tire=tire, most=most)
    write_result(out, {FAILURE: None})
    return 0


def _path(lasts: float) -> Scenario:
    """The thesis' straight path without its end."""
    return replace(
        scenario_named("straight"),
        lasts=lasts,
        every=EVERY,
        actuators=lambda design: drive_forward(design),
        path=straight_ahead(lasts * SPEED),
        study=None,
        search=None,
    )


def _on_rocks(path: Scenario, design: RoverDesign, seed: int) -> Scenario:
    """Small rocks, which the tires bear."""
    assert path.path is not None
    places = path.path(design)
    low, high = places.min(axis=0) - _BEYOND, places.max(axis=0) + _BEYOND
    size = high - low
    rocks = RandomRocks(
        seed=seed,
        size=(float(size[0]), float(size[1])),
        origin=(float(low[0]), float(low[1])),
        abundance=0.2,
        diameters=(0.06, 0.15),
        height_ratio=0.15,
        spacing=0.0125,
    )
    return on_terrain(path, design, rocks.terrain(), f"random rocks up to 22 mm high, seed {seed}")
