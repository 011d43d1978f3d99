"""A rover at rest on flexible tires, at one mean wheel load after the other (thesis Figs 15, 20 and 22).

The first equilibrium is reached by strongly damped implicit steps from tires pressed into the ground, the others from
the one before, with gravity scaled. What is at rest depends on neither damping nor friction: the ground is taken
without friction, so that no wheel sticks on its way. Verified by tests/verification/test_rover_standing.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError, InputError
from contracts.nodal_tires import NodalTires
from rover_dynamics.flexible.even_steps import EvenSteps
from rover_dynamics.flexible.flexible_system import Instant
from rover_dynamics.flexible.flexible_vehicle import FlexibleMotion, FlexibleVehicle, on_flexible_tires
from rover_dynamics.flexible.implicit_motion import drive_on_flexible_tires
from rover_dynamics.multibody.motion_law import Hold
from rover_dynamics.rover.rover import Actuators, build_rover
from rover_dynamics.rover.rover_file import RoverDesign

__all__ = ["Standing", "stand_under_loads"]

FloatArray = NDArray[np.float64]
_STEPS = EvenSteps(tolerance=1e-3, first=1e-3, longest=0.5)
"""Errors on the way do not matter; Newton's method ends at a hundredth of the tolerance times the step squared."""
_SETTLES = 20.0
_RESTS = 1e-4
"""Vertical speed of every body at rest, at most [m/s]; along the ground nothing stops a slow slide, or matters."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """The rover at rest.

    Attributes
    ----------
    mean_load : weight over the number of wheels [N]
    orientation : (n_w,) float [rad], circumferential position of each tire that faces the ground
    load : (n_w,) float [N], ground on wheel
    deflection : (n_w,) float [m], drop of each hub from the design's wheel radius over level ground
    vectors : (n_w, n, 3) float [m, -], of the tires, see `contracts.nodal_tires`
    """

    mean_load: float
    orientation: FloatArray
    load: FloatArray
    deflection: FloatArray
    vectors: FloatArray


def stand_under_loads(
    design: RoverDesign, tires: NodalTires, orientations: FloatArray, loads: Sequence[float]
) -> list[Standing]:
    """The rover on level ground with drives held, at each mean wheel load.

    Parameters
    ----------
    design : its wheel radius is where deflection counts from
    tires : one for each wheel, on level ground without friction
    orientations : (n_w,) float [rad], position of each tire that faces the ground
    loads : mean wheel loads [N], > 0; neighbours close to each other

    Raises
    ------
    InputError
        For a load that is not above zero.
    ConvergenceError
        If the rover does not come to rest.
    """
    if not loads or min(loads) <= 0.0:
        raise InputError("mean wheel loads", list(loads), "must be above zero, one or more", "give e.g. 198 N")
    found, place = [], None
    for load in loads:
        vehicle = _vehicle(design, tires, orientations, load)
        motion, place = _settled(vehicle, place)
        hubs = motion.vectors[-1][:, -4:]
        found.append(
            Standing(
                mean_load=load,
                orientation=np.arctan2(-hubs[:, 1, 2], hubs[:, 1, 0]),
                load=motion.tires[-1, :, 1],
                deflection=design.wheel_radius - hubs[:, 0, 2],
                vectors=motion.vectors[-1],
            )
        )
    return found


def _vehicle(design: RoverDesign, tires: NodalTires, angles: FloatArray, load: float) -> FlexibleVehicle:
    """Gravity makes up for tires whose mass has no weight."""
    without = float(
        tires.mass[np.ix_(tires.position_rows, tires.position_rows)].sum() - tires.weight[tires.position_rows].sum()
    )
    weighing = replace(design, gravity=load / (design.mass / len(design.legs) - without))
    held = Actuators(laws={f"drive_{leg.name}": Hold() for leg in design.legs})
    return on_flexible_tires(build_rover(weighing, actuators=held, height=-0.02), tires, angles)


def _settled(vehicle: FlexibleVehicle, place: Instant | None) -> tuple[FlexibleMotion, Instant]:
    ends: list[Instant] = []
    motion = drive_on_flexible_tires(
        vehicle,
        np.array([-_SETTLES, 0.0]),
        _STEPS,
        settles_until=0.0,
        watch=lambda _, instant: ends.append(instant),
        start=place,
    )
    speed = float(np.abs(motion.velocities[-1, :, 2]).max())
    if speed > _RESTS:
        raise ConvergenceError(
            f"the rover still moves at {speed:.2g} m/s upwards or downwards after {_SETTLES:g} s: it does not stand", []
        )
    return motion, ends[-1]
