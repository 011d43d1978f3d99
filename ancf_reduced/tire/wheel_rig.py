"""One ANCF wheel with a rigid hub on terrain: dropped, or driven at a wanted speed of rotation.

The hub moves freely in space; the lateral directions need no guide as long as wheel and terrain are symmetric about the
wheel's mid-plane. World frame: x forward, y left (axle), z up; the wheel stands on its position phi = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

from ancf_reduced.contact.law import ContactLaw
from ancf_reduced.contact.plate_contact import PlateContact
from ancf_reduced.motion.explicit import MotionState
from ancf_reduced.motion.linearisation import Linearisation
from ancf_reduced.motion.plate_system import ExternalForce, HubMass, PlateSystem, build_plate_system
from ancf_reduced.motion.vector_coordinates import with_held_vectors, with_reference_node
from ancf_reduced.plates.model import PlateModel
from ancf_reduced.tire.mesh import Tire
from contracts.errors import ConvergenceError, InputError
from contracts.terrain import Terrain

__all__ = ["MARS_GRAVITY", "HubDrive", "WheelRig", "damped_model", "wheel_rig"]

FloatArray = NDArray[np.float64]

MARS_GRAVITY = 3.711
"""[m/s^2]; thesis section 3.1: 1187.52 N on six wheels."""
_ABOUT_AXLE = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
"""Rows a @ this are e_y x a."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HubDrive:
    """Torque about the axle that holds the speed of rotation: gain times (wanted - actual).

    An external force of `plate_system`. The torque tau acts on the hub's gradients as tau x a_i / 2, handed to the tied
    nodes by forces of least norm whose sum at the reference node is just that: by the transpose of the pseudo-inverse
    B^+ that finds the reference node's vectors from theirs.

    Attributes
    ----------
    tire : whose hub nodes are driven
    speed : wanted angular velocity about y, positive rolls towards +x [rad/s]
    gain : [N m s]
    """

    tire: Tire
    speed: float
    gain: float
    _to_gradients: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Rows of B^+ (3, 4 n_tied) for the gradients."""
        inverse = np.linalg.pinv(self.tire.tie.map.reshape(-1, 4))
        object.__setattr__(self, "_to_gradients", np.ascontiguousarray(inverse[1:]))

    @property
    def depends_on_rates(self) -> bool:
        """Always."""
        return True

    def _gradients(self, p: FloatArray) -> FloatArray:
        """Gradients of the reference node (3, 3), rows, from the tied nodes; from rates their rates."""
        return np.asarray(self._to_gradients @ p[self.tire.tie.tied].reshape(-1, 3))

    def torque(self, p: FloatArray, v: FloatArray) -> float:
        """About the axle, on the wheel [N m]."""
        return self._torque(self._gradients(p) @ _ABOUT_AXLE, v)

    def _torque(self, turned: FloatArray, v: FloatArray) -> float:
        """The same from e_y x a_i, rows; the spin is the sum of (e_y x a_i) . a_i' / 2."""
        return self.gain * (self.speed - 0.5 * float(np.vdot(turned, self._gradients(v))))

    def force(self, p: FloatArray, v: FloatArray, time: float) -> FloatArray:
        """Generalised force (n_nodes, 4, 3) on the mesh."""
        turned = self._gradients(p) @ _ABOUT_AXLE
        on_gradients = (0.5 * self._torque(turned, v)) * turned
        force = np.zeros_like(p)
        force[self.tire.tie.tied] = (self._to_gradients.T @ on_gradients).reshape(-1, 4, 3)
        return force

    def tangents(self, p: FloatArray, v: FloatArray, time: float) -> tuple[FloatArray, FloatArray]:
        """Zero, (n_plates, 48, 48) each: the drive is slow, and Newton's iteration does without its derivative."""
        none = np.zeros((len(self.tire.mesh.elements), 48, 48))
        return none, none


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelRig:
    """System and what is needed to start and read it.

    Attributes
    ----------
    tire : plates, contact points, tie
    system : equations of motion
    contact : its contact with the ground
    """

    tire: Tire
    system: PlateSystem
    contact: PlateContact

    def start(self, hub: FloatArray, velocity: FloatArray, spin: float = 0.0) -> MotionState:
        """Undeformed wheel at a hub position [m] with velocity [m/s] and spin about y [rad/s]."""
        z = self.system.reference()
        v = np.cross(np.array([0.0, spin, 0.0]), z)
        positions = self.system.coordinates.position_rows
        z[positions] += hub
        v[positions] += velocity
        return MotionState(time=0.0, z=z, v=v)

    def hub(self, vectors: FloatArray) -> FloatArray:
        """Position of the hub (3,) [m] from a state's z, or its velocity from v."""
        return np.asarray(vectors[self.system.coordinates.triads[0, 0]])

    def load(self, state: MotionState) -> FloatArray:
        """Force of the ground on the wheel (3,) [N]."""
        p, v = self.system.coordinates.expand(state.z), self.system.coordinates.expand_rates(state.v)
        return self.contact.patch(p, v).resultant


def wheel_rig(
    tire: Tire,
    terrain: Terrain,
    *,
    hub: HubMass,
    law: ContactLaw | None = None,
    damping_ratio: float = 0.0,
    gravity: float = MARS_GRAVITY,
    drive: tuple[float, float] | None = None,
) -> WheelRig:
    """A tire on the ground.

    Parameters
    ----------
    tire : from `build_tire` or `tire_on_mesh`
    terrain : ground at rest
    hub : mass on the axle
    law : contact; the preset's stiffness without damping and friction by default
    damping_ratio : of the first mode of the tire with its hub held [-], see `damped_model`
    gravity : downwards [m/s^2]
    drive : speed of rotation [rad/s] and gain [N m s] of `HubDrive`; None lets the hub turn freely

    Verified by tests/verification/test_ancf_wheel_rig.py.
    """
    model = damped_model(tire, damping_ratio)
    tire = replace(tire, model=model)
    law = law or ContactLaw(stiffness=tire.preset.contact_stiffness)
    contact = PlateContact(grid=tire.grid, terrain=terrain.pieces(), law=law)
    external: list[ExternalForce] = [contact]
    if drive is not None:
        external.append(HubDrive(tire=tire, speed=drive[0], gain=drive[1]))
    system = build_plate_system(
        model,
        with_reference_node(tire.tie),
        gravity=np.array([0.0, 0.0, -gravity]),
        hubs=(hub,),
        external=tuple(external),
    )
    return WheelRig(tire=tire, system=system, contact=contact)


def damped_model(tire: Tire, ratio: float) -> PlateModel:
    """The tire's plates with the viscosity mu_v that damps its first mode so much; lambda_v = 0.

    The first mode is that of the free plates with the hub held, about the stress-free state: 2 ratio omega = mu_v c / m
    with the mode's damping c for mu_v = 1. The thesis gives no coefficients: the ratio is a choice.

    Parameters
    ----------
    ratio : >= 0 and below 1 [-]
    """
    if not 0.0 <= ratio < 1.0:
        raise InputError("damping ratio", f"{ratio:g}", "must lie in 0..1, 1 excluded", "0.02 to 0.1 is usual")
    if ratio == 0.0:
        return tire.model
    held = np.zeros((len(tire.mesh.points), 4), dtype=bool)
    held[tire.tie.tied] = True
    unit = replace(tire.model, viscosity=(0.0, 1.0))
    system = build_plate_system(unit, with_held_vectors(tire.mesh, held))
    z = system.reference()
    matrices = Linearisation(system)
    K, M = matrices.elastic(z), matrices.mass
    try:
        if isinstance(K, np.ndarray):
            square, mode = eigh(np.asarray(K), np.asarray(M), subset_by_index=(0, 0))
        else:
            square, mode = eigsh(K, k=1, M=M, sigma=0.0, v0=np.ones(K.shape[0]))
    except (np.linalg.LinAlgError, RuntimeError) as error:  # the latter: SuperLU's, ARPACK's
        raise ConvergenceError(f"the tire's first mode is not found: {error}; look at its mass", []) from error
    if not square[0] > 0.0:
        message = f"the tire has no stiffness against its first mode (omega^2 = {float(square[0]):.3g} 1/s^2)"
        raise ConvergenceError(f"{message}; look at its thicknesses and what holds it", [])
    damping = float(mode[:, 0] @ (matrices.damping(z, 0.0 * z) @ mode[:, 0]))
    return replace(tire.model, viscosity=(0.0, 2.0 * ratio * math.sqrt(float(square[0])) / damping))
