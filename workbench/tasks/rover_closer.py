"""Task: the rover on ANCF and on brush tires along a straight path and over rocks, looked at closely.

Files: ``{ground}_{tire}.csv``, series of the body's motion and of each tire's largest strain; ``pressure.csv``, contact
points of the front right wheel, standing and rolling; ``animation.html``. Verified by
tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import Tire, build_tire
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.tire.skin import tire_skin
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.csv_table import CsvTable, table_text
from contracts.errors import ConvergenceError
from contracts.series import TimeSeries, write_series
from contracts.terrain import Plane
from contracts.terrain_rocks import RandomRocks
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion
from rover_dynamics.rover.rover_file import RoverDesign, read_rover
from rover_dynamics.rover.scenarios.catalogue import scenario_named
from rover_dynamics.rover.scenarios.ground import on_terrain
from rover_dynamics.rover.scenarios.level_ground import OBSERVED, SPEED, drive_forward, straight_ahead
from rover_dynamics.rover.scenarios.scenario import Scenario, ScenarioRun, run_scenario
from workbench.execution.result_files import FAILURE, write_result
from workbench.execution.task import Progress
from workbench.figures.rover_animation import write_animation
from workbench.tasks.rover_tires import DAMPING_RATIO, LAW, START_HEIGHT, on_ancf_tires

__all__ = ["PRESSURE", "body_series", "drive_closely"]

FloatArray = NDArray[np.float64]
PRESSURE = ("time_s", "ahead_m", "aside_m", "pressure_Pa", "normal_force_N")
"""Columns of the contact points: place from the point below the hub, forwards and to the left."""
_BEYOND = 0.6
"""Rocks beyond the wheels' places [m]."""


def drive_closely(inputs: Mapping[str, Any], needs: Mapping[str, Path], out: Path, progress: Progress) -> int:
    """Both grounds on both tires; a ground that a tire does not bear is left out and said so."""
    design, tire, stopped = read_rover(), build_tire(thesis_preset()), dict[str, str]()
    path = _path(inputs["lasts"], inputs["every"])
    grounds = {"straight": path, "rocks": _on_rocks(path, design, inputs["rocks"])}
    for k, (ground, scenario) in enumerate(grounds.items()):
        write_series(body_series(run_scenario(scenario, design), ground, None), out / f"{ground}_brush.csv")
        try:
            run = run_scenario(on_ancf_tires(scenario, tire), design)
        except ConvergenceError as error:
            stopped[ground] = str(error)
            continue
        if run.stopped:
            stopped[ground] = run.stopped
        write_series(body_series(run, ground, tire), out / f"{ground}_ancf.csv")
        if ground == "straight":
            _write_pressure(run, tire, inputs["pressure_at"], out / "pressure.csv")
            title = "Straight path at 70 m/h on ANCF tires"
            write_animation(
                run.motion, design, Plane(), out / "animation.html", title=title, tire=tire, most=inputs["frames"]
            )
        progress(0.5 * (k + 1.0))
    write_result(out, {"stopped": stopped, FAILURE: None})
    return 0


def _path(lasts: float, every: float) -> Scenario:
    """The thesis' straight path without its end."""
    return replace(
        scenario_named("straight"),
        lasts=lasts,
        every=every,
        actuators=lambda design: drive_forward(design),
        path=straight_ahead(lasts * SPEED),
        study=None,
        search=None,
    )


def _on_rocks(path: Scenario, design: RoverDesign, seed: int) -> Scenario:
    """Small rocks, which the tires bear: the rover comes down on them as softly as on level ground."""
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
    rough = on_terrain(path, design, rocks.terrain(), f"random rocks up to 22 mm high, seed {seed}")
    return replace(rough, height=float(rough.height or 0.0) + START_HEIGHT)


def body_series(run: ScenarioRun, ground: str, tire: Tire | None) -> TimeSeries:
    """Vertical acceleration and pitch acceleration of the first body, central differences; strains with a tire."""
    t, u = run.motion.times, run.motion.velocities[:, 0]
    columns = {
        "body_az_m_s2": np.gradient(u[:, 2], t),
        "body_pitch_rate_rad_s": u[:, 4],
    }
    if tire is not None and isinstance(run.motion, FlexibleMotion):
        skin = tire_skin(tire, 5, 3)
        strains = np.array([[skin.largest_strain(z).max() for z in frame] for frame in run.motion.vectors])
        columns |= {f"{leg.name}_strain_1": strains[:, k] for k, leg in enumerate(run.design.legs)}
    return TimeSeries(
        scenario=f"{ground}_closely",
        tire=run.scenario.tire_model,
        time=t,
        columns=columns,
        source=f"{run.scenario.title}; first body's centre, world; largest principal strain of each tire",
        partial=run.stopped is not None,
    )


def _write_pressure(run: ScenarioRun, tire: Tire, times: list[float], path: Path) -> None:
    """Contact points of the wheel the thesis observes, at some times [s]."""
    motion = run.motion
    assert isinstance(motion, FlexibleMotion)
    tires = wheel_set(tire, Plane(), len(run.design.legs), law=LAW, damping_ratio=DAMPING_RATIO)
    wheel, rows = [leg.name for leg in run.design.legs].index(OBSERVED), []
    for time in times:
        k = min(int(np.searchsorted(motion.times, time - 1e-9)), len(motion.times) - 1)
        z, v = motion.vectors[k], motion.rates[k]
        patch = tires.contact.patch(tires.node_coordinates(z), tires.node_rates(v))
        own = patch.plates * tires.n_wheels // tires.contact.grid.n_plates == wheel
        place = patch.position[own] - z[wheel, -4]
        rows.append(
            np.column_stack([np.full(own.sum(), time), place[:, :2], patch.pressure[own], patch.normal_force[own]])
        )
    source = f"contact points of the {OBSERVED.replace('_', ' ')} wheel from below its hub, forwards and to the left"
    table = CsvTable(names=PRESSURE, values=np.concatenate(rows), source=source, partial=False)
    path.write_text(table_text(table), encoding="utf-8", newline="")
