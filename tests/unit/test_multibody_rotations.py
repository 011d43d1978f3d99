"""Rotations by unit quaternions against SciPy's, and their rate."""

from __future__ import annotations

import sys

import numpy as np
from numba.core.registry import CPUDispatcher
from scipy.spatial.transform import Rotation

from rover_dynamics.multibody.compiled import (
    cross,
    multiply_quaternions,
    quaternion_of,
    rotation_matrix,
    rotation_quaternion,
)
from rover_dynamics.multibody.formulation import quaternion_rates
from rover_dynamics.multibody.rows import matrix, times, times_matrix, transposed_times, turn_matrix
from rover_dynamics.multibody.small_matrices import inverse, product


def test_matrix_product_and_rotation_vector_are_scipys() -> None:
    a, b = Rotation.random(2, random_state=4)
    p, q = a.as_quat(scalar_first=True), b.as_quat(scalar_first=True)
    R, product, turned, out = np.empty((3, 3)), np.empty(4), np.empty(4), np.empty(3)
    rotation_matrix(2.0 * p, R)
    np.testing.assert_allclose(R, a.as_matrix(), atol=1e-15)
    multiply_quaternions(p, q, product)
    np.testing.assert_allclose(abs(product @ (a * b).as_quat(scalar_first=True)), 1.0, atol=1e-15)
    vector = a.as_rotvec()
    rotation_quaternion(vector, turned)
    np.testing.assert_allclose(abs(turned @ p), 1.0, atol=1e-15)
    cross(vector, R[0], out)
    np.testing.assert_allclose(out, np.cross(vector, R[0]), atol=1e-15)
    np.testing.assert_allclose(abs(quaternion_of(R) @ p), 1.0, atol=1e-15)


def test_matrices_in_registers_are_numpys() -> None:
    A, B = np.random.default_rng(3).normal(size=(2, 3, 3))
    a, b, x = matrix(np.array([A, B]), 0), matrix(np.array([A, B]), 1), (0.3, -0.5, 2.0)
    np.testing.assert_allclose(times(a, x), A @ x, atol=1e-15)
    np.testing.assert_allclose(transposed_times(a, x), x @ A, atol=1e-15)
    np.testing.assert_allclose(times_matrix(a, b), A @ B, atol=1e-14)
    axis = A[0] / np.linalg.norm(A[0])
    np.testing.assert_allclose(turn_matrix(tuple(axis), 2.4), Rotation.from_rotvec(2.4 * axis).as_matrix(), atol=1e-15)


def test_inverse_exchanges_rows_and_is_not_finite_for_a_singular_matrix() -> None:
    A = np.random.default_rng(5).normal(size=(9, 9))
    A[0, 0] = 0.0
    np.testing.assert_allclose(inverse(A) @ A, np.eye(9), atol=1e-13)
    np.testing.assert_allclose(product(A, A[1]), A @ A[1], atol=1e-14)
    A[3] = 0.0
    assert not np.all(np.isfinite(inverse(A)))


def test_a_rotation_of_nothing_is_one() -> None:
    out = np.empty(4)
    rotation_quaternion(np.zeros(3), out)
    np.testing.assert_array_equal(out, [1.0, 0.0, 0.0, 0.0])


def test_rate_is_the_derivative_of_a_rotation_about_a_world_axis() -> None:
    start, w, h = Rotation.random(random_state=5), np.array([0.4, -1.0, 0.3]), 1e-5
    at = [(Rotation.from_rotvec(k * h * w) * start).as_quat(scalar_first=True) for k in (-1, 0, 1)]
    rate = quaternion_rates(at[1][None], w[None])[0]
    np.testing.assert_allclose(rate, (at[2] - at[0]) / (2 * h), atol=1e-9)


def test_no_rule_of_arithmetic_is_relaxed() -> None:
    """Else the last digits depend on what was compiled together: seen in runs killed while they compiled."""
    modules = [m for name, m in sys.modules.items() if name.startswith("rover_dynamics")]
    functions = {f for m in modules for f in vars(m).values() if isinstance(f, CPUDispatcher)}
    assert len(functions) > 10
    assert [f.__name__ for f in functions if f.targetoptions.get("fastmath")] == []
