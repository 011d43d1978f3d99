"""What is kept of a drive to look closely at its tires: the body's vibration, each tire's strain, pressure maps.

Verified by tests/unit/test_workbench_rover_closer.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.tire.mesh import Tire
from ancf_reduced.tire.skin import TireSkin, tire_skin
from ancf_reduced.tire.wheel_set import wheel_set
from contracts.csv_table import CsvTable, table_text
from contracts.series import TimeSeries, write_series
from contracts.terrain import Plane
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion
from rover_dynamics.rover.scenarios.level_ground import OBSERVED
from rover_dynamics.rover.scenarios.scenario import ScenarioRun
from workbench.questions.rover.tires import DAMPING_RATIO, contact_law

__all__ = ["CLOSELY", "EVERY", "PRESSURE", "PRESSURES", "body_series", "coarse_skin", "write_close_look"]

FloatArray = NDArray[np.float64]
CLOSELY, PRESSURES = "closely.csv", "pressure.csv"
EVERY = 0.02
"""Spacing of the samples [s]: vibrations up to 25 Hz, beyond which steps of this size follow none."""
PRESSURE = ("time_s", "ahead_m", "aside_m", "pressure_Pa", "area_m2")
"""Columns of the contact points: place from the point below the hub, forwards and to the left; part of the face."""


def coarse_skin(tire: Tire) -> TireSkin:
    """Points at which the largest strain of a tire is looked for: ends, middle and quarters of each plate."""
    return tire_skin(tire, 5, 3)


def body_series(run: ScenarioRun, ground: str, tire: Tire | None) -> TimeSeries:
    """Vertical acceleration (central differences) and pitch rate of the first body; strains with a tire."""
    t, u = run.motion.times, run.motion.velocities[:, 0]
    columns = {"body_az_m_s2": np.gradient(u[:, 2], t), "body_pitch_rate_rad_s": u[:, 4]}
    if tire is not None and isinstance(run.motion, FlexibleMotion):
        skin = coarse_skin(tire)
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


def write_close_look(run: ScenarioRun, ground: str, tire: Tire, pressed_at: Sequence[float], out: Path) -> None:
    """``closely.csv``, see `body_series`, and ``pressure.csv`` at some times [s] as far as the motion gets there."""
    write_series(body_series(run, ground, tire), out / CLOSELY)
    reached = [time for time in pressed_at if time <= run.motion.times[-1] + 1e-9]
    source = f"contact points of the {OBSERVED.replace('_', ' ')} wheel from below its hub, forwards and to the left"
    table = CsvTable(names=PRESSURE, values=_pressed(run, tire, reached), source=source, partial=False)
    (out / PRESSURES).write_text(table_text(table), encoding="utf-8", newline="")


def _pressed(run: ScenarioRun, tire: Tire, times: Sequence[float]) -> FloatArray:
    """Contact points (n, 5) of the wheel the thesis observes, on level ground; columns of `PRESSURE`."""
    motion = run.motion
    assert isinstance(motion, FlexibleMotion)
    tires = wheel_set(tire, Plane(), len(run.design.legs), law=contact_law(tire.preset), damping_ratio=DAMPING_RATIO)
    wheel = [leg.name for leg in run.design.legs].index(OBSERVED)
    rows = [np.zeros((0, len(PRESSURE)))]
    for time in times:
        k = int(np.abs(motion.times - time).argmin())
        z = motion.vectors[k]
        patch = tires.contact.patch(tires.node_coordinates(z), tires.node_rates(motion.rates[k]))
        own = patch.plates * tires.n_wheels // tires.contact.grid.n_plates == wheel
        place = (patch.position[own] - z[wheel, -4])[:, :2]
        rows.append(np.column_stack([np.full(own.sum(), time), place, patch.pressure[own], patch.area[own]]))
    return np.concatenate(rows)
