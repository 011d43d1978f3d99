"""Where a motion ends before its time: beside its terrain, up to the axle in soil, deeper than a tire's curves go.

Verified by tests/unit/test_rover_scenarios.py, tests/unit/test_rover_on_soil_told.py and
tests/verification/test_rover_on_soil.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Terrain
from rover_dynamics.rover.rover_file import RoverDesign
from rover_dynamics.soil.lie import footprint_plane
from rover_dynamics.tires.brush_force import BESIDE, DEEP
from rover_dynamics.tires.brush_settings import BrushSettings
from rover_dynamics.vehicle.vehicle import VehicleMotion

__all__ = ["hubs_over", "on_its_soil", "refuse_beside_terrain", "wheel_bodies", "within_curves"]

FloatArray = NDArray[np.float64]
_PENETRATION, _LOAD, _PATCH, _MARK = 0, 1, 4, 9
"""Columns of `rover_dynamics.tires.brush_force.OUTPUT_SIZE`."""


def wheel_bodies(design: RoverDesign) -> slice:
    """Rows of the wheels among the bodies: behind those of the design come arm, spindle and wheel of each leg."""
    return slice(len(design.bodies) + 2, None, 3)


def hubs_over(hubs: FloatArray, terrain: Terrain, radius: float) -> FloatArray:
    """Heights (n, n_w) [m] of hubs (n, n_w, 3) [m] over the planes of their footprints, along the planes' normals."""
    x, y, z = hubs.reshape(-1, 3).T
    ground, normals = footprint_plane(terrain, x, y, radius)
    return np.asarray(((z - ground) * normals[:, 2]).reshape(hubs.shape[:2]))


def refuse_beside_terrain(motion: VehicleMotion) -> None:
    """InputError for a motion in which a hub came to lie beside the terrain's height field."""
    times, wheels = np.nonzero(motion.tires[:, :, _MARK] == BESIDE)
    if times.size:
        x, y = motion.tires[times[0], wheels[0], _PATCH : _PATCH + 2]
        place, when = f"x, y = {x:g}, {y:g} m", motion.times[times[0]]
        rule = f"lies beside the terrain, which the rover left by t = {when:g} s"
        raise InputError("path", place, rule, "give a larger field or another start")


def on_its_soil(motion: VehicleMotion, design: RoverDesign, terrain: Terrain) -> tuple[int, str | None]:
    """Rows up to where a wheel lies in the soil up to its axle or beside the field, and words for that.

    Raises
    ------
    ConvergenceError
        If it is so at rest.
    """
    beside = motion.tires[:, :, _MARK] == BESIDE
    on_it = len(motion.times) if not beside.any() else int(np.argmax(beside.any(axis=1)))
    lost = beside.copy()
    lost[:on_it] = hubs_over(motion.positions[:on_it, wheel_bodies(design)], terrain, design.wheel_radius) <= 0.0
    times, wheels = np.nonzero(lost)
    if not times.size:
        return len(motion.times), None
    k, wheel = int(times[0]), int(wheels[0])
    ends = (
        "slides off the field of soil" if beside[k, wheel] else "lies in the soil up to its axle, where its laws end,"
    )
    message = f"wheel {design.legs[wheel].name} {ends} at t = {motion.times[k]:.4g} s"
    if motion.times[k] <= 0.0:
        raise ConvergenceError(message, [])
    return k, f"{message}; give firmer soil, a smaller load or a gentler slope"


def within_curves(motion: VehicleMotion, design: RoverDesign, settings: BrushSettings) -> tuple[int, str | None]:
    """Rows up to where a wheel is pressed deeper than its curves go, and words for that.

    Raises
    ------
    ConvergenceError
        If it is so at rest.
    """
    times, wheels = np.nonzero(motion.tires[:, :, _MARK] == DEEP)
    if not times.size or settings.potential is None:
        return len(motion.times), None
    k, wheel = int(times[0]), int(wheels[0])
    depth, load = 1e3 * motion.tires[k, wheel, _PENETRATION], motion.tires[k, wheel, _LOAD]
    end, tip = 1e3 * settings.potential.last, 1e3 * settings.potential.tips.height
    message = (
        f"wheel {design.legs[wheel].name} is pressed {depth:.3g} mm deep at t = {motion.times[k]:.4g} s,"
        f" with {load:.0f} N: its curves end at {end:.3g} mm of the rim, {tip:.3g} mm more on a grouser; go deeper"
    )
    if motion.times[k] <= 0.0:
        raise ConvergenceError(message, [])
    return k, message
