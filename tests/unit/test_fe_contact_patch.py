"""First touch and patch size on shapes whose answers are known."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from numpy.typing import NDArray

from reference_fe.contact.patch import contact_faces, distance_at_touch, measure_patch
from reference_fe.verification.structured_hexahedra import block_mesh

RADIUS = 0.1425


def arc(X: NDArray[np.float64]) -> NDArray[np.float64]:
    angle, r = 0.4 * (X[:, 0] - 0.5), RADIUS * (1.0 + 0.01 * (X[:, 2] - 1.0))
    return np.column_stack([r * np.sin(angle), 0.06 * X[:, 1], -r * np.cos(angle)])


def height_over(depth: float, points: NDArray[np.float64]) -> NDArray[np.float64]:
    return points[:, 2] + depth


@pytest.mark.parametrize("order", [1, 2])
def test_touch_of_a_box_is_its_depth(order: int) -> None:
    mesh = block_mesh((2, 2, 1), lambda X: X * 0.1 - 0.05, order)
    assert distance_at_touch(mesh, contact_faces(mesh, ["z0"]), np.array([0.0, 0.0, -1.0])) == pytest.approx(0.05)


@pytest.mark.parametrize("angle", [0.0, 0.03, -0.11])
def test_touch_of_an_arc_is_its_radius_at_any_orientation(angle: float) -> None:
    mesh = block_mesh((8, 1, 1), arc)
    direction = np.array([np.sin(angle), 0.0, -np.cos(angle)])
    touch = distance_at_touch(mesh, contact_faces(mesh, ["z1"]), direction)
    assert touch == pytest.approx(RADIUS, rel=1e-5)


def test_patch_of_an_undeformed_arc_is_the_chord_below_the_plane() -> None:
    mesh, depth = block_mesh((60, 1, 1), arc), 1e-3
    half = np.sqrt(2 * RADIUS * depth - depth**2)
    plane = partial(height_over, RADIUS - depth)
    zero = np.zeros_like(mesh.points)
    patch = measure_patch(mesh, contact_faces(mesh, ["z1"]), zero, plane, np.array([1.0, 0.0, 0.0]))
    assert patch.length == pytest.approx(2 * half, rel=0.01)
    assert patch.area == pytest.approx(2 * RADIUS * np.arcsin(half / RADIUS) * 0.06, rel=0.01)
    assert patch.penetration == pytest.approx(depth, rel=1e-6)


def test_the_depth_is_that_of_the_deepest_edge() -> None:
    """A flat facet that tilts dips deepest at its edge, beyond the outermost Gauss point."""
    mesh, depth, slope = block_mesh((1, 1, 1), lambda X: X), 1e-3, 2e-3
    tilted = np.column_stack([np.zeros((len(mesh.points), 2)), slope * (mesh.points[:, 0] - 0.5)])
    patch = measure_patch(
        mesh, contact_faces(mesh, ["z0"]), tilted, partial(height_over, -depth), np.array([1.0, 0.0, 0.0])
    )
    assert patch.penetration == pytest.approx(depth + 0.5 * slope, rel=1e-12)


def test_no_contact_gives_an_empty_patch() -> None:
    mesh = block_mesh((4, 1, 1), arc)
    plane = partial(height_over, RADIUS + 1e-3)
    patch = measure_patch(
        mesh, contact_faces(mesh, ["z1"]), np.zeros_like(mesh.points), plane, np.array([1.0, 0.0, 0.0])
    )
    assert (patch.area, patch.length, patch.penetration) == (0.0, 0.0, 0.0)
