"""A vehicle as arrays for compiled steps, and the memory these work in.

Verified by tests/verification/test_vehicle_step.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.terrain import TerrainPieces
from rover_dynamics.multibody.tree_kernels import Tree
from rover_dynamics.soil.field import SoilGround
from rover_dynamics.tires.brush_force import BrushResult, BrushScratch, empty_result
from rover_dynamics.tires.brush_settings import WheelNumbers
from rover_dynamics.vehicle.motor_kernels import MotorNumbers

__all__ = ["Newton", "System", "Tires", "Work", "work_for"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Tires(NamedTuple):
    """The vehicle's tires, for the compiled calls.

    Attributes
    ----------
    bodies : (n_w,) int, rows of the wheels' bodies
    numbers, pieces : of the wheels, of the terrain
    scratch, pair : working memory of `brush_derivatives`
    soil : what they stand on instead of the terrain, or None
    """

    bodies: IntArray
    numbers: WheelNumbers
    pieces: TerrainPieces
    scratch: BrushScratch
    pair: BrushResult
    soil: SoilGround | None


class System(NamedTuple):
    """What does not change in time.

    Attributes
    ----------
    tree, tires : of the vehicle
    gravity : (3,) float, acceleration of free fall [m/s^2]
    free, driven : (n_f,), (n_d,) int, velocities that are unknown, and those that follow laws
    driven_q : (n_d,) int, coordinates of the driven velocities
    motors : of the joints
    """

    tree: Tree
    tires: Tires
    gravity: FloatArray
    free: IntArray
    driven: IntArray
    driven_q: IntArray
    motors: MotorNumbers


class Newton(NamedTuple):
    """One linearisation, which serves several steps, see `linearisation.changes`.

    Attributes
    ----------
    inverse : (n_f, n_f) float, of c M - sum J^T E J of the free velocities
    carry : (n_w, n_v, n_s) float, what a residual of the states adds to that of the accelerations
    follow, states : (n_w, n_v, n_s), (n_w, n_s, n_s) float, change of B for that of A, and for the states' residual
    made_for : (2 + n_w,) float, length of the step [s], evaluations since, and 1 for each wheel that touches
    """

    inverse: FloatArray
    carry: FloatArray
    follow: FloatArray
    states: FloatArray
    made_for: FloatArray


class Work(NamedTuple):
    """What a step writes besides its end, and what the next one takes over; of `work_for`.

    Attributes
    ----------
    result : of the tires, as last evaluated
    newton : as last linearised
    derivatives : (n_w, 6 + n_s, 12 + n_s) float, of the tires
    slopes : (n_m,) float, -dT/dv of the motors [N m s/rad]
    """

    result: BrushResult
    newton: Newton
    derivatives: FloatArray
    slopes: FloatArray


def work_for(system: System) -> Work:
    """Working memory of a vehicle's steps."""
    result = empty_result(len(system.tires.bodies), system.tires.pair.rate.shape[1])
    n_w, n_s = result.rate.shape
    n_f, n_v = len(system.free), int(system.tree.v_at[-1])
    newton = Newton(
        np.zeros((n_f, n_f)),
        np.zeros((n_w, n_v, n_s)),
        np.zeros((n_w, n_v, n_s)),
        np.zeros((n_w, n_s, n_s)),
        np.full(2 + n_w, -1.0),
    )
    return Work(result, newton, np.zeros((n_w, 6 + n_s, 12 + n_s)), np.zeros(len(system.motors.places)))
