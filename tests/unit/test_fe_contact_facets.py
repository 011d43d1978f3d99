"""Quadrature of contact faces: areas, points and shape functions agree with the mesh; local stiffness by hand."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.contact.facets import ContactFacets, gauss_line, local_stiffness, simpson_line
from reference_fe.problem.domain import Domain
from reference_fe.verification.structured_hexahedra import block_mesh

FACES = ("x0", "x1", "y0", "y1", "z0", "z1")


def sheared(X: np.ndarray) -> np.ndarray:
    return np.column_stack([2.0 * X[:, 0] + 0.3 * X[:, 2], X[:, 1], 0.5 * X[:, 2]])


@pytest.mark.parametrize("family", ["Lagrange", "S"])
@pytest.mark.parametrize("face", FACES)
def test_points_lie_on_the_face_and_shapes_reproduce_them(family: str, face: str) -> None:
    domain = Domain.from_tagged(block_mesh((2, 1, 1), sheared))
    V = api.fem.functionspace(domain.mesh, (family, 2, (3,)))
    facets = ContactFacets.of(domain, V, (face,), gauss_line(5))
    A, b = np.array([[0.2, -1.0, 0.4], [2.0, 0.3, 0.0], [0.0, 0.1, 0.5]]), np.array([1.0, 2.0, 3.0])
    u = api.fem.Function(V)
    u.interpolate(lambda x: A @ x + b[:, None])
    values = u.x.array.reshape(-1, 3)[facets.nodes]
    at_points = np.einsum("mqk,mki->mqi", facets.shapes[facets.kind], values)
    np.testing.assert_allclose(at_points, facets.positions @ A.T + b, atol=1e-12)
    height = np.sqrt(0.3**2 + 0.5**2)
    area = {"x": height, "y": 1.0, "z": 2.0}[face[0]]
    assert facets.weights.sum() == pytest.approx(area)
    level = {"y0": (1, 0.0), "y1": (1, 1.0), "z0": (2, 0.0), "z1": (2, 0.5)}
    if face in level:
        axis, value = level[face]
        np.testing.assert_allclose(facets.positions[..., axis], value, atol=1e-14)


def test_a_closed_rule_has_points_on_the_edges_and_the_same_area() -> None:
    domain = Domain.from_tagged(block_mesh((1, 1, 1), sheared))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    inside, closed = (ContactFacets.of(domain, V, ("z1",), line(5)) for line in (gauss_line, simpson_line))
    assert closed.weights.sum() == pytest.approx(inside.weights.sum())
    low, high = closed.positions.min(axis=1)[0], closed.positions.max(axis=1)[0]
    np.testing.assert_allclose([low[:2], high[:2]], [[0.3, 0.0], [2.3, 1.0]], atol=1e-12)
    assert inside.positions[..., 1].min() > 0.04


def test_simpsons_rule_is_exact_for_cubics_and_refuses_an_even_count() -> None:
    at, weights = simpson_line(9)
    np.testing.assert_allclose([weights @ at**n for n in range(4)], [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0])
    np.testing.assert_allclose(np.diff(at), 1.0 / 8.0)
    with pytest.raises(InputError, match="odd"):
        simpson_line(8)


def test_local_stiffness_of_a_thin_and_a_thick_cell() -> None:
    """0.1 m wide cells 2 mm deep: bending, E t^3 / h^4; on their edge: E / h with h = 2 mm."""
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X * [0.1, 0.2, 0.002]))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    flat, edge = (ContactFacets.of(domain, V, (face,), gauss_line(3)) for face in ("z0", "x0"))
    E = np.array([1e11])
    np.testing.assert_allclose(local_stiffness(flat, E), 1e11 * 0.002**3 / 0.1**4)
    np.testing.assert_allclose(local_stiffness(edge, E), 1e11 / 0.002)


def test_an_unknown_face_is_refused() -> None:
    domain = Domain.from_tagged(block_mesh((1, 1, 1), lambda X: X))
    V = api.fem.functionspace(domain.mesh, ("Lagrange", 2, (3,)))
    with pytest.raises(InputError, match="mesh face"):
        ContactFacets.of(domain, V, ("nowhere",), gauss_line(3))
