"""Trees: velocities and accelerations of bodies are derivatives of their positions; mass and bias are Newton's."""

from __future__ import annotations

import numpy as np

from rover_dynamics.multibody.body import body
from rover_dynamics.multibody.compiled import quaternion_of
from rover_dynamics.multibody.joint import cylindrical, fixed, planar, prismatic, revolute, spherical, universal
from rover_dynamics.multibody.model import MultibodyModel
from rover_dynamics.multibody.spanning_tree import spanning_tree
from rover_dynamics.multibody.state import State
from rover_dynamics.multibody.tree_forces import needed_efforts
from rover_dynamics.multibody.tree_jacobians import body_jacobian
from rover_dynamics.multibody.tree_kernels import bias_and_mass, coordinate_rates, move_tree, tree_motion
from rover_dynamics.multibody.tree_start import joint_coordinates, zero_coordinates
from rover_dynamics.multibody.verification.mechanisms import n_four_bar

RNG = np.random.default_rng(7)


def all_joints() -> MultibodyModel:
    """A chain with every kind of joint, half of them hung from their second body, and a free body with one more."""
    moments = (0.1, 0.2, 0.15)
    a, b, c, d, e, f, g, h, i = (body(name, 1.0, moments, RNG.normal(size=3)) for name in "abcdefghi")
    joints = (
        revolute("1", "ground", a, at=(0, 0, 0), axis=(0, 1, 0.2)),
        universal("2", b, a, at=(0.5, 0, 0), axis=(0, 0, 1), second_axis=(1, 1, 0)),
        cylindrical("3", c, b, at=(1, 0, 0), axis=(1, 0, 1)),
        spherical("4", c, d, at=(1, 1, 0)),
        planar("5", d, e, at=(1, 1, 1), normal=(0, 1, 1)),
        prismatic("6", f, e, at=(1, 2, 0), axis=(1, 0, 0)),
        fixed("7", f, g),
        planar("8", i, h, at=(3, 2, 0), normal=(0, 1, 0)),
    )
    return MultibodyModel(bodies=(a, b, c, d, e, f, g, h, i), joints=joints)


MODEL = all_joints()
TREE = spanning_tree(MODEL).tree
N_Q, N_V = int(TREE.q_at[-1]), int(TREE.v_at[-1])
V, V_DOT = RNG.normal(size=(2, N_V))


def start() -> np.ndarray:
    q = zero_coordinates(TREE) + 0.3 * RNG.normal(size=N_Q)
    for k, kind in enumerate(TREE.kinds):
        if kind >= 2:
            end = TREE.q_at[k + 1]
            q[end - 4 : end] /= np.linalg.norm(q[end - 4 : end])
    return q


Q = start()


def course(h: float) -> tuple[np.ndarray, np.ndarray]:
    """q and v after a short time h with constant accelerations, by one Runge-Kutta step."""

    def f(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        return coordinate_rates(TREE, q, v, tree_motion(TREE, q, v).frames)

    middle, end = V + 0.5 * h * V_DOT, V + h * V_DOT
    k1 = f(Q, V)
    k2 = f(Q + 0.5 * h * k1, middle)
    k3 = f(Q + 0.5 * h * k2, middle)
    k4 = f(Q + h * k3, end)
    return Q + h / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4), end


def test_velocities_and_accelerations_are_derivatives_of_the_positions() -> None:
    h = 1e-4
    before, now, after = (tree_motion(TREE, *course(k * h)) for k in (-1, 0, 1))
    np.testing.assert_allclose(now.velocities[:-1, :3], (after.positions - before.positions)[:-1] / (2 * h), atol=1e-6)
    spin = (after.rotations - before.rotations) / (2 * h) @ now.rotations.swapaxes(1, 2)
    found = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    np.testing.assert_allclose(now.velocities[:-1, 3:], found[:-1], atol=1e-6)
    B = body_jacobian(TREE, now)
    np.testing.assert_allclose(now.velocities[:-1].ravel(), B @ V, atol=1e-12)
    u_dot = now.accelerations[:-1].ravel() + B @ V_DOT
    np.testing.assert_allclose(u_dot, ((after.velocities - before.velocities)[:-1] / (2 * h)).ravel(), atol=1e-5)


def test_mass_matrix_and_bias_are_those_of_newton_and_euler() -> None:
    """M = B^T diag(m, J) B and h = B^T (inertia of B' v, gyroscopic moments, less applied wrenches and weight)."""
    motion, gravity = tree_motion(TREE, Q, V), np.array([1.0, -2.0, -9.0])
    applied = RNG.normal(size=(len(MODEL.bodies), 6))
    h, M = bias_and_mass(TREE, motion, applied, gravity)
    B = body_jacobian(TREE, motion).reshape(-1, 6, N_V)
    R, w = motion.rotations[:-1], motion.velocities[:-1, 3:]
    J = R @ TREE.inertias @ R.swapaxes(1, 2)
    a = motion.accelerations[:-1]
    expected_M = np.einsum("n,niv,niu->vu", TREE.masses, B[:, :3], B[:, :3])
    expected_M += np.einsum("niv,nij,nju->vu", B[:, 3:], J, B[:, 3:])
    force = TREE.masses[:, None] * (a[:, :3] - gravity) - applied[:, :3]
    moment = np.einsum("nij,nj->ni", J, a[:, 3:]) + np.cross(w, np.einsum("nij,nj->ni", J, w)) - applied[:, 3:]
    expected_h = np.einsum("niv,ni->v", B[:, :3], force) + np.einsum("niv,ni->v", B[:, 3:], moment)
    np.testing.assert_allclose(M, expected_M, rtol=0.0, atol=1e-12 * np.max(np.abs(expected_M)))
    np.testing.assert_allclose(h, expected_h, rtol=0.0, atol=1e-12 * np.max(np.abs(expected_h)))
    needed = needed_efforts(TREE, motion, V_DOT, applied, gravity)
    expected = expected_M @ V_DOT + expected_h
    np.testing.assert_allclose(needed, expected, rtol=0.0, atol=1e-12 * np.max(np.abs(expected)))


def test_a_motion_written_over_another_keeps_nothing_of_it() -> None:
    over = tree_motion(TREE, Q[::-1].copy(), V_DOT)
    move_tree(TREE, Q, V, over)
    for found, fresh in zip(over, tree_motion(TREE, Q, V), strict=True):
        np.testing.assert_array_equal(found, fresh)


def test_joint_coordinates_of_a_known_state_give_it_back() -> None:
    motion = tree_motion(TREE, Q, V)
    orientations = np.array([quaternion_of(R) for R in motion.rotations[:-1]])
    state = State(positions=motion.positions[:-1], orientations=orientations, velocities=motion.velocities[:-1])
    again = tree_motion(TREE, *joint_coordinates(TREE, state))
    np.testing.assert_allclose(again.positions, motion.positions, atol=1e-9)
    np.testing.assert_allclose(again.rotations, motion.rotations, atol=1e-9)
    np.testing.assert_allclose(again.velocities, motion.velocities, atol=1e-8)


def test_loops_are_cut_where_the_paths_are_longest() -> None:
    spanning = spanning_tree(n_four_bar(2))
    assert len(spanning.cut) == 2
    assert all(name.startswith("right") for name in spanning.cut)
    assert [hung.joint.name for hung in spanning.hung[:3]] == ["base 0", "base 1", "base 2"]
