"""Forces of all wheels of a vehicle with brush tires in one compiled call.

In each contact, with the unit vectors n out of the ground, t = e x n / |e x n| forward and l = n x t to the left, the
velocity v_c of the wheel at the contact, and the deflection lambda of `brush_contact` with its rate -n . v_c / q:

    N = max(0, S + c lambda_dot w) / q,    w = ramp(lambda / d_0), or 1 for the damper as printed,
    S = k lambda, or dU/dlambda of a wheel's own potential (`wheel_potential`) with the moment
    -dU/dbeta (e - (n . e) n) / q^2 and, where n turns (on an edge or rock), a force and a moment: dU/dbeta times the
    gradients of `brush_edges`; of these no larger a share than of S is left where the damper lets go,
    v = -(v_r . t, v_c . l),    V = omega R = t . (r_r x omega) (brush) or t . v_hub (Fiala),
    force on the hub  N n + F_y l  at the contact r,  F_x t  at r_r, or at r with the loaded radius as its lever,
    moment            M_z n  and against the spin  -f N |r| tanh(omega R / v_0) e,

F_x, F_y, M_z and the rate of the bristles from `brush_standstill`; r goes from the hub centre to the contact. Rolling
is that of the rim, which `brush_contact` takes as rigid and held elastically by the hub: one turn lays down 2 pi R,
whatever the deflection. So v_r is the wheel's velocity at r_r, the contact moved out to the distance R, and F_x has the
lever R: |r| by itself, the rest because F_x shifts the rim by F_x / k against the hub and N with it, k delta F_x / k.
The power of the wrench on the hub's motion is that of spring, damper, slip and rolling resistance, and nothing else.
The lever |r| leaves that shift out: a drive then gives F_x omega delta less than the wheel's way takes.

State of a wheel: u_x, u_y [m] for each piece of terrain in turn; out of contact u fades with the retardation time, and
over the first 0.1 mm of deflection (``touch_depth``) its rate goes over into that of the contact.

Verified by tests/verification/test_brush_drive.py and tests/unit/test_brush_force.py.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.terrain import PieceKind, TerrainPieces
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot, over_length, ramp, vector
from rover_dynamics.tires.brush_contact import CONTACT_SIZE, fading, find_contacts
from rover_dynamics.tires.brush_graph import is_beside
from rover_dynamics.tires.brush_profile import SAMPLES
from rover_dynamics.tires.brush_settings import WheelNumbers
from rover_dynamics.tires.brush_standstill import FIALA, bristle_force
from rover_dynamics.tires.wheel_potential import facing, load_and_slope

__all__ = [
    "BESIDE",
    "DEEP",
    "OUTPUT_SIZE",
    "BrushResult",
    "BrushScratch",
    "HubMotions",
    "brush_forces",
    "brush_result",
    "brush_scratch",
    "contact_size",
    "empty_result",
    "hub_axes",
    "wheel_answer",
]

FloatArray = NDArray[np.float64]
OUTPUT_SIZE = 10
"""Outputs of a wheel: penetration, load, slip (2), patch point (3), tractive and lateral force, `BESIDE` or `DEEP`."""
BESIDE, DEEP = 1.0, 2.0
"""The hub lies beside the ground's height field; the rim is pressed deeper than its potential was sampled."""


class HubMotions(NamedTuple):
    """Motions of n hubs in the world frame, as `contracts.tire.HubMotion` has that of one.

    Attributes
    ----------
    position : (n, 3) float [m]
    rotation : (n, 3, 3) float [-], the second column the axle
    velocity : (n, 3) float [m/s]
    angular_velocity : (n, 3) float [rad/s]
    """

    position: FloatArray
    rotation: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray


class BrushResult(NamedTuple):
    """What `brush_forces` writes.

    Attributes
    ----------
    wrench : (n, 6) float [N, N m], force and moment about the hub centre, world
    rate : (n, 2 n_pieces) float [m/s], of the state
    output : (n, 10) float, see `OUTPUT_SIZE`
    """

    wrench: FloatArray
    rate: FloatArray
    output: FloatArray


class BrushScratch(NamedTuple):
    """Working memory, one for each thread.

    Attributes
    ----------
    contacts : (n_pieces, 18) float, of the wheel last computed
    samples : (34, 4) float
    """

    contacts: FloatArray
    samples: FloatArray


def brush_result(wheels: int, terrain: TerrainPieces) -> BrushResult:
    """Arrays for the results of n wheels."""
    return empty_result(wheels, 2 * len(terrain.rows))


def empty_result(wheels: int, states: int) -> BrushResult:
    """Arrays for the results of n wheels with so many states each."""
    return BrushResult(np.zeros((wheels, 6)), np.zeros((wheels, states)), np.zeros((wheels, OUTPUT_SIZE)))


def brush_scratch(terrain: TerrainPieces) -> BrushScratch:
    """Working memory for a terrain; raises InputError for a cleat, whose distance the brush does not know."""
    if (terrain.rows[:, 0] == PieceKind.CLEAT).any():
        raise InputError("terrain of a brush tire", "a cleat", "is not known to it", "take a step or a half-round")
    return BrushScratch(np.zeros((len(terrain.rows), CONTACT_SIZE)), np.zeros((SAMPLES + 1, 4)))


@compiled
def brush_forces(
    motions: HubMotions,
    state: FloatArray,
    numbers: WheelNumbers,
    terrain: TerrainPieces,
    result: BrushResult,
    scratch: BrushScratch,
) -> None:
    """Wrenches, state rates and outputs of all wheels; allocates nothing.

    Parameters
    ----------
    motions : of the hubs
    state : (n, 2 n_pieces) float [m]
    numbers : of the wheels, `rover_dynamics.tires.brush_settings.wheel_numbers`
    terrain : `contracts.terrain.Terrain.pieces`
    result : overwritten
    scratch : overwritten
    """
    for i in range(motions.position.shape[0]):
        p, v, omega = vector(motions.position[i]), vector(motions.velocity[i]), vector(motions.angular_velocity[i])
        e, ahead = hub_axes(motions.rotation[i])
        find_contacts(p, e, contact_size(numbers), terrain, scratch.contacts, scratch.samples)
        wheel_answer((e, v, omega, ahead), state[i], numbers, scratch.contacts, result, i)
        _finish_output(p, terrain, result.output[i])


@compiled
def hub_axes(rotation: FloatArray) -> tuple[Vector, Vector]:
    """Axle and what is ahead, of a hub frame (3, 3)."""
    return (rotation[0, 1], rotation[1, 1], rotation[2, 1]), (rotation[0, 0], rotation[1, 0], rotation[2, 0])


@compiled
def wheel_answer(
    motion: tuple[Vector, Vector, Vector, Vector],
    state: FloatArray,
    numbers: WheelNumbers,
    contacts: FloatArray,
    result: BrushResult,
    i: int,
) -> None:
    """Row i of the results, from the contacts found.

    Parameters
    ----------
    motion : axle e, velocity of the hub centre, angular velocity, and what is ahead in the hub frame
    state : (2 n_pieces,) float [m]
    numbers, contacts : of the wheel
    result : its row i is overwritten; the patch point is the sum of load times place from the hub centre
    i : number of the wheel
    """
    result.wrench[i, :] = 0.0
    result.output[i, :] = 0.0
    largest = 0.0
    for k in range(contacts.shape[0]):
        u, contact = (state[2 * k], state[2 * k + 1]), contacts[k]
        spring = _spring(motion[3], motion[0], numbers, contact, result.output[i])
        w = ramp(spring[0] / numbers.touch_depth)
        rate = 0.0, 0.0
        if spring[0] > 0.0:
            load, rate, slip = _add_contact(motion, u, numbers, contact, spring, result.wrench[i], result.output[i])
            if load > largest:
                largest = load
                result.output[i, 2], result.output[i, 3] = slip
        free = (w - 1.0) / numbers.retardation_time
        result.rate[i, 2 * k], result.rate[i, 2 * k + 1] = w * rate[0] + free * u[0], w * rate[1] + free * u[1]


@compiled
def _add_contact(
    motion: tuple[Vector, Vector, Vector, Vector],
    u: tuple[float, float],
    numbers: WheelNumbers,
    contact: FloatArray,
    spring: Vector,
    wrench: FloatArray,
    output: FloatArray,
) -> tuple[float, tuple[float, float], tuple[float, float]]:
    """Add one contact to the wheel's wrench and output; its load, rate of u and slip."""
    e, v_hub, omega = motion[:3]
    n, r, q = (contact[1], contact[2], contact[3]), (contact[4], contact[5], contact[6]), contact[10]
    t = over_length(cross(e, n))
    left = cross(n, t)
    turning = cross(omega, r)
    v = along(v_hub, 1.0, turning)
    u_hub = contact[7], contact[8], contact[9]
    load = _normal_load(spring, -dot(n, v) / q, q, numbers)
    to_rim = -(numbers.radius + dot(r, u_hub))
    rolling = -dot(turning, t) - to_rim * dot(cross(omega, u_hub), t)
    speed = dot(v_hub, t) if int(numbers.law) == FIALA else rolling
    (F_x, F_y, M_z), rate, slip = bristle_force(load, u, (rolling - dot(v_hub, t), -dot(v, left)), speed, numbers)
    F = (
        load * n[0] + F_x * t[0] + F_y * left[0],
        load * n[1] + F_x * t[1] + F_y * left[1],
        load * n[2] + F_x * t[2] + F_y * left[2],
    )
    arm = math.sqrt(dot(r, r))
    resistance = numbers.rolling_resistance * load * arm * math.tanh(rolling / numbers.standstill_speed)
    M = along(along(cross(r, F), M_z, n), -resistance, e)
    M = along(M, numbers.lever_to_rim * to_rim * F_x, cross(u_hub, t))
    slope, tilt = spring[2] * min(fading(q), load * q / max(spring[1], 1e-300)), dot(n, e)
    M = along(along(M, -slope / (q * q), along(e, -tilt, n)), slope, (contact[15], contact[16], contact[17]))
    F = along(F, slope, (contact[12], contact[13], contact[14]))
    for m in range(3):
        wrench[m] += F[m]
        wrench[3 + m] += M[m]
        output[4 + m] += load * r[m]
    output[0] = max(output[0], spring[0])
    output[1] += load
    output[7] += F_x
    output[8] += F_y
    return load, rate, slip


@compiled
def contact_size(numbers: WheelNumbers) -> tuple[float, float]:
    """Radius that reaches the tips of grousers, and width [m]."""
    return numbers.radius + numbers.potential.tips.height, numbers.width


@compiled
def _spring(ahead: Vector, e: Vector, numbers: WheelNumbers, contact: FloatArray, output: FloatArray) -> Vector:
    """Of one contact: deflection since touch [m], radial force [N], and its potential's slope over a turn [N m]."""
    if numbers.potential.energy.shape[0] == 0:
        return contact[0], numbers.radial_stiffness * contact[0], 0.0
    if contact[0] <= 0.0:
        return 0.0, 0.0, 0.0
    approach = contact[0] - numbers.potential.tips.height
    if approach > numbers.potential.last:
        output[9] = DEEP
    return load_and_slope(numbers.potential, approach, facing((contact[7], contact[8], contact[9]), ahead, e))


@compiled
def _normal_load(spring: Vector, rate: float, q: float, numbers: WheelNumbers) -> float:
    """Normal force N of one contact [N]: spring and damper, never tensile."""
    deflection, force, _ = spring
    share = ramp(deflection / numbers.damping_ramp) if numbers.damping_ramp > 0.0 else 1.0
    radial = force + numbers.radial_damping * rate * share
    return max(radial, 0.0) * fading(q) / q


@compiled
def _finish_output(p: Vector, terrain: TerrainPieces, output: FloatArray) -> None:
    """Patch point in the world frame, and whether the hub centre lies beside the height field."""
    load = max(output[1], 1e-300)
    for m in range(3):
        output[4 + m] = p[m] + output[4 + m] / load
    for k in range(terrain.rows.shape[0]):
        if is_beside(terrain.rows[k], terrain.knots, p[0], p[1]):
            output[9] = BESIDE
