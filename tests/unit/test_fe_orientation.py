"""Cells turned so that their first local axis is the most curved one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from reference_fe.cells.orientation import curved_axis_first
from reference_fe.verification.structured_hexahedra import block_mesh
from tests.structured_quadrilaterals import planar_block


def arc_along(axis: int) -> NDArray[np.float64]:
    """Corner-to-corner directions of the first local axis of an arc that was meshed along ``axis``."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        along, width, depth = (X[:, (axis + k) % 3] for k in range(3))
        angle, radius = 0.3 * along, 1.0 + 0.01 * depth
        return np.column_stack([radius * np.sin(angle), 0.5 * width, -radius * np.cos(angle)])

    counts = [1, 1, 1]
    counts[axis] = 3
    mesh = curved_axis_first(block_mesh((counts[0], counts[1], counts[2]), mapping))
    return mesh.points[mesh.cells[:, 1]] - mesh.points[mesh.cells[:, 0]]


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_first_axis_runs_along_the_arc(axis: int) -> None:
    direction = arc_along(axis)
    assert np.all(np.linalg.norm(direction[:, [0, 2]], axis=1) > 0.08)
    np.testing.assert_allclose(direction[:, 1], 0.0, atol=1e-12)


def test_turning_keeps_handedness_and_middle_nodes() -> None:
    mesh = block_mesh((1, 1, 2), lambda X: X * np.array([1.0, 2.0, 9.0]))
    turned = curved_axis_first(mesh)
    for cells in (mesh.cells, turned.cells):
        origin = mesh.points[cells[:, 0]]
        axes = [mesh.points[cells[:, k]] - origin for k in (1, 3, 4)]
        assert np.all(np.einsum("ci,ci->c", np.cross(axes[0], axes[1]), axes[2]) > 0.0)
        middle = 0.5 * (mesh.points[cells[:, 0]] + mesh.points[cells[:, 1]])
        np.testing.assert_allclose(mesh.points[cells[:, 8]], middle, atol=1e-14)  # gmsh node 8: edge 0-1
    assert np.array_equal(np.sort(mesh.cells, axis=1), np.sort(turned.cells, axis=1))
    np.testing.assert_allclose(axes[0][:, 2], 4.5)  # straight cells: the longest axis first


def test_linear_meshes_come_back_unchanged() -> None:
    mesh = block_mesh((2, 1, 1), lambda X: X, order=1)
    assert curved_axis_first(mesh) is mesh


def test_flat_strips_turn_away_from_the_straight_direction() -> None:
    """A flat cell that is wider than long: its longest axis is the width, unless that direction is ruled out."""
    mesh = block_mesh((2, 1, 1), lambda X: X * np.array([8.0, 20.0, 0.6]))
    free, ruled = curved_axis_first(mesh), curved_axis_first(mesh, straight=np.array([0.0, 1.0, 0.0]))
    for turned, axis in ((free, 1), (ruled, 0)):
        edge = turned.points[turned.cells[:, 1]] - turned.points[turned.cells[:, 0]]
        assert np.all(np.argmax(np.abs(edge), axis=1) == axis)


@pytest.mark.parametrize("counts", [(3, 1), (1, 3)])
def test_planar_cells_turn_their_first_axis_along_the_arc(counts: tuple[int, int]) -> None:
    along = int(counts == (1, 3))

    def arc(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, radius = 0.3 * X[:, along], 1.0 + 0.01 * X[:, 1 - along]
        return np.column_stack([radius * np.sin(angle), -radius * np.cos(angle)])

    mesh = planar_block(counts, arc)
    turned = curved_axis_first(mesh)
    first, second = (turned.points[turned.cells[:, k]] - turned.points[turned.cells[:, 0]] for k in (1, 3))
    assert np.all(np.linalg.norm(first, axis=1) > 0.08)
    before = mesh.points[mesh.cells[0, [1, 3]]] - mesh.points[mesh.cells[0, 0]]
    assert np.sign(np.linalg.det(np.stack([first[0], second[0]]))) == np.sign(np.linalg.det(before))  # handedness
    middle = 0.5 * (turned.points[turned.cells[:, 0]] + turned.points[turned.cells[:, 1]])
    np.testing.assert_allclose(turned.points[turned.cells[:, 4]], middle, atol=2e-3)  # node 4 lies on edge 0-1
    assert np.array_equal(np.sort(mesh.cells, axis=1), np.sort(turned.cells, axis=1))
