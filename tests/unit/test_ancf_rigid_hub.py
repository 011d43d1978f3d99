"""A reference node that moves with a rigid hub: constraints, mass, and the same motion as with rigid coordinates."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.mass_factor import MassFactor
from ancf_reduced.motion.plate_system import HubMass, PlateSystem, build_plate_system, hub_mass
from ancf_reduced.motion.reference_node import tie_reference_node
from ancf_reduced.motion.rigid_triads import RigidTriads, triad_defect
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.motion.triad_equations import TriadEquations
from ancf_reduced.motion.vector_coordinates import with_reference_node
from ancf_reduced.plates.mesh import build_plate_mesh, flat_patch
from ancf_reduced.plates.model import build_plate_model
from contracts.errors import ConvergenceError, InputError

HUB = HubMass(mass=2.0, inertia=np.diag([0.011, 0.017, 0.009]))
END = 0.02
OMEGA, SPEED = np.array([1.0, 8.0, -0.5]), np.array([0.3, 0.1, -0.2])


def paddle(hub: HubMass = HUB) -> PlateSystem:
    """One soft plate on a hub at the origin."""
    mesh = build_plate_mesh(
        [flat_patch(np.array([0.05, -0.03, 0]), np.array([0.1, 0, 0]), np.array([0, 0.06, 0]), 0.02, "plate")]
    )
    model = build_plate_model(mesh, young_modulus=2e5, poisson_ratio=0.0, density=1500.0, quadrature=(3, 3, 2))
    tie = tie_reference_node(mesh, np.flatnonzero(mesh.points[:, 0] < 0.06), np.zeros(3))
    return build_plate_system(model, with_reference_node(tie), gravity=np.array([0.0, 0.0, -3.711]), hubs=(hub,))


def rigid_start(system: PlateSystem) -> MotionState:
    z, v = system.reference(), np.empty_like(system.reference())
    v[:] = np.cross(OMEGA, z)
    positions = np.array([row % 4 == 0 for row in range(len(z))])
    v[positions] += SPEED
    return MotionState(time=0.0, z=z, v=v)


@functools.cache
def expected_end() -> np.ndarray:
    return by_rigid_coordinates(paddle(), rigid_start(paddle()), END)


def by_rigid_coordinates(system: PlateSystem, start: MotionState, time: float) -> np.ndarray:
    """The same motion with the hub's position, rotation and spin as unknowns: no multipliers; DOP853."""
    n = system.coordinates.n_vectors - 4
    M, reference = system.mass.toarray(), np.vstack([np.zeros(3), np.eye(3)])

    def tangent(A: np.ndarray) -> np.ndarray:
        """T with z' = T u, u = (rates of free vectors, hub velocity, spin), (3 n_vectors, 3 n + 6)."""
        T = np.zeros((3 * (n + 4), 3 * n + 6))
        T[: 3 * (n + 1), : 3 * (n + 1)] = np.eye(3 * (n + 1))
        for i in range(3):
            a = A[:, i]
            T[3 * (n + 1 + i) : 3 * (n + 2 + i), 3 * (n + 1) :] = np.cross(np.eye(3), a).T  # omega x a
        return T

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        free, R, q = y[: 3 * n].reshape(-1, 3), y[3 * n : 3 * n + 3], y[3 * n + 3 : 3 * n + 7]
        u = y[3 * n + 7 :]
        A, omega = Rotation.from_quat(q).as_matrix(), u[-3:]
        z = np.vstack([free, R, A.T])
        T = tangent(A)
        v = (T @ u).reshape(-1, 3)
        bias = np.zeros_like(v)
        bias[n + 1 :] = np.cross(omega, np.cross(omega, A.T))
        force = system.force(z, v) - M @ bias
        reduced = T.T @ np.kron(M, np.eye(3)) @ T
        acceleration = np.linalg.solve(reduced, T.T @ force.ravel())
        return np.concatenate([v[:n].ravel(), u[3 * n : 3 * n + 3], _spin(omega, q), acceleration])

    y0 = np.concatenate([start.z[:n].ravel(), reference[0], [0, 0, 0, 1.0], start.v[:n].ravel(), SPEED, OMEGA])
    solution = solve_ivp(rate, (0.0, time), y0, method="DOP853", rtol=1e-10, atol=1e-12)
    y = solution.y[:, -1]
    A = Rotation.from_quat(y[3 * n + 3 : 3 * n + 7]).as_matrix()
    return np.vstack([y[: 3 * n].reshape(-1, 3), y[3 * n : 3 * n + 3], A.T])


def _spin(omega: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Rate of the quaternion (x, y, z, w) at spin omega in the fixed frame."""
    vector = 0.5 * (q[3] * omega + np.cross(omega, q[:3]))
    return np.array([*vector, -0.5 * omega @ q[:3]])


def test_multipliers_and_rigid_coordinates_give_the_same_motion() -> None:
    system = paddle()
    start, step = rigid_start(system), stable_step(system, system.reference())
    expected = expected_end()
    errors = []
    for fraction in (0.1, 0.025):
        (end,) = integrate_explicit(system, start, np.array([END]), fraction * step)
        assert triad_defect(np.array(end.z[-3:])) < 1e-12
        turning = TriadEquations(system.coordinates).jacobian(end.z) @ end.v.ravel()
        assert np.abs(turning).max() < 1e-10 * np.abs(end.v[-3:]).max()  # the rates keep it rigid as well
        errors.append(np.abs(end.z - expected).max())
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.4)  # second order; the phase of fast modes adds a little


def test_without_the_gyroscopic_mass_the_motion_differs() -> None:
    """Negative control: another hub inertia is another motion."""
    start = rigid_start(paddle())
    expected = expected_end()
    other = paddle(HubMass(mass=2.0, inertia=np.diag([0.011, 0.014, 0.009])))
    (end,) = integrate_explicit(other, start, np.array([END]), 0.1 * stable_step(other, start.z))
    assert np.abs(end.z - expected).max() > 1e-4


def test_hub_mass_has_the_energy_of_a_rigid_body() -> None:
    rates = np.vstack([SPEED, np.cross(OMEGA, np.eye(3))])
    energy = 0.5 * np.sum(rates * (hub_mass(HUB) @ rates))
    assert energy == pytest.approx(0.5 * HUB.mass * SPEED @ SPEED + 0.5 * OMEGA @ HUB.inertia @ OMEGA, rel=1e-14)


def test_impossible_inertia_is_refused() -> None:
    with pytest.raises(InputError, match="hub inertia"):
        HubMass(mass=1.0, inertia=np.diag([0.01, 0.03, 0.01]))
    with pytest.raises(InputError, match="hub mass"):
        HubMass(mass=0.0, inertia=np.eye(3))


def test_a_step_that_is_too_large_says_so() -> None:
    system = paddle()
    start = rigid_start(system)
    with pytest.raises(ConvergenceError, match="step"):
        list(integrate_explicit(system, start, np.array([2.0]), 4.0 * stable_step(system, start.z)))


def test_a_held_axle_vector_stays() -> None:
    """A wheel that may only turn about y: its axle vector is eliminated, the others stay a triad with it."""
    mesh = paddle().model.mesh
    tie = tie_reference_node(mesh, np.flatnonzero(mesh.points[:, 0] < 0.06), np.zeros(3))
    coordinates = with_reference_node(tie, held=(False, False, True, False))
    system = build_plate_system(paddle().model, coordinates, hubs=(HUB,))
    v = np.cross(np.array([0.0, 5.0, 0.0]), system.reference())
    step = stable_step(system, system.reference())
    (end,) = integrate_explicit(system, MotionState(time=0.0, z=system.reference(), v=v), np.array([0.2]), step)
    triads = RigidTriads(coordinates.triads, MassFactor(system.mass), coordinates.n_vectors)
    (a,) = triads.gradients(end.z)
    np.testing.assert_array_equal(a[1], [0.0, 1.0, 0.0])
    assert triad_defect(a) < 1e-12
    assert np.abs(a[0] - [1.0, 0.0, 0.0]).max() > 0.1  # it has turned
