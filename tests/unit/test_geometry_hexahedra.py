"""Shape functions, faces and node orders of hexahedra."""

from __future__ import annotations

import numpy as np
import pytest

from geometry.hexahedra import (
    VTK_FROM_GMSH,
    face_nodes,
    gauss_points,
    jacobians,
    mirror_order,
    reference_nodes,
    shape_gradients,
)


@pytest.mark.parametrize("n_nodes", [8, 27])
def test_gradients_differentiate_polynomials_exactly(n_nodes: int) -> None:
    """d/dxi of the interpolant of a polynomial in the element's space is the polynomial's gradient."""
    nodes = reference_nodes(n_nodes)
    p = 1 if n_nodes == 8 else 2
    at = np.random.default_rng(1).uniform(-1.0, 1.0, (20, 3))

    def f(x: np.ndarray) -> np.ndarray:
        return (1 + x[:, 0]) ** p * (2 - x[:, 1]) ** p * (3 + 2 * x[:, 2]) ** p

    h = 1e-6
    expected = np.column_stack([(f(at + h * e) - f(at - h * e)) / (2 * h) for e in np.eye(3)])
    found = np.einsum("a,qaj->qj", f(nodes), shape_gradients(n_nodes, at))
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-6)


def test_gauss_points_integrate_degree_seven() -> None:
    points, weights = gauss_points(4)
    assert weights.sum() == pytest.approx(8.0)
    assert weights @ (points[:, 0] ** 6 * points[:, 1] ** 2) == pytest.approx(8.0 / 7.0 / 3.0)


@pytest.mark.parametrize("n_nodes", [8, 27])
def test_faces_look_outwards(n_nodes: int) -> None:
    nodes = reference_nodes(n_nodes)
    for face in face_nodes(n_nodes):
        x = nodes[face]
        normal = np.cross(x[1] - x[0], x[3] - x[0])
        assert normal @ x[:4].mean(axis=0) > 0.0
        if n_nodes == 27:
            assert x[4:8] == pytest.approx(0.5 * (x[:4] + np.roll(x[:4], -1, axis=0)))
            assert x[8] == pytest.approx(x[:4].mean(axis=0))


@pytest.mark.parametrize("n_nodes", [8, 27])
def test_mirror_order_turns_a_cell(n_nodes: int) -> None:
    points = reference_nodes(n_nodes) * [1.0, 1.0, -1.0]
    cells = np.arange(n_nodes)[None, :]
    at = gauss_points(2)[0]
    assert np.linalg.det(jacobians(points, cells, at)).max() < 0.0
    assert np.linalg.det(jacobians(points, cells[:, mirror_order(n_nodes)], at)).min() > 0.0


def test_vtk_order_is_that_of_vtk() -> None:
    """VTK's own triquadratic hexahedron tells where its nodes are."""
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    coordinates = np.array(vtk.vtkTriQuadraticHexahedron().GetParametricCoords()[: 3 * 27])
    assert reference_nodes(27)[list(VTK_FROM_GMSH)] == pytest.approx(2.0 * coordinates.reshape(27, 3) - 1.0)
