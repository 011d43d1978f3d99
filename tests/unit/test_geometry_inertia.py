"""Mass matrix of rigid parts: a box beside the origin, by its closed form; half as heavy is seen."""

from __future__ import annotations

import numpy as np
import pytest

from geometry.inertia import rigid_mass
from reference_fe.verification.structured_hexahedra import block_mesh


@pytest.mark.parametrize("order", [1, 2])
def test_a_box(order: int) -> None:
    size, corner = np.array([1.0, 2.0, 3.0]), np.array([0.5, -1.0, 4.0])
    mesh = block_mesh((2, 1, 1), lambda X: corner + size * X, order=order)
    found = rigid_mass(mesh, {"body": 10.0})
    mass, centre = 60.0, corner + 0.5 * size
    np.testing.assert_allclose(found[:3, :3], mass * np.eye(3), atol=1e-12)
    skew = np.array([[0, centre[2], -centre[1]], [-centre[2], 0, centre[0]], [centre[1], -centre[0], 0]])
    np.testing.assert_allclose(found[:3, 3:], mass * skew, atol=1e-10)  # force x, turn about y: m z
    own = mass / 12.0 * np.diag([size[1] ** 2 + size[2] ** 2, size[0] ** 2 + size[2] ** 2, size[0] ** 2 + size[1] ** 2])
    np.testing.assert_allclose(found[3:, 3:], own + mass * skew.T @ skew, rtol=1e-12, atol=1e-10)
    np.testing.assert_allclose(rigid_mass(mesh, {"body": 5.0}), 0.5 * found)
