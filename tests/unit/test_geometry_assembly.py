"""Merging solids: nodes, orientation, boundary tags."""

from __future__ import annotations

import numpy as np

from contracts.mesh import TaggedMesh
from geometry.assembly import RawMesh, assemble, boundary_facets, join, merge_nodes
from geometry.hexahedra import gauss_points, jacobians, mirror_order, reference_nodes


def brick(shift: float) -> np.ndarray:
    return 0.5 * reference_nodes(8) + [shift, 0.0, 0.0]


def two_bricks(turned: bool = False) -> TaggedMesh:
    """Two unit cubes side by side, meshed apart; the left one's face at -x is named."""
    cells = np.arange(8)[None, :]
    left = RawMesh(points=brick(0.0), cells=[("a", cells)], quadrangles=[("end", np.array([[0, 4, 7, 3]]))])
    order = mirror_order(8) if turned else np.arange(8)
    right = RawMesh(points=brick(1.0) + 1e-13, cells=[("b", cells[:, order])], quadrangles=[])
    return assemble(join(left, right), ["a", "b"])


def test_nodes_at_one_place_become_one() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1e-12, 0, 0], [1, 0, 1e-6]])
    assert list(merge_nodes(points)) == [0, 1, 0, 3]


def test_two_bricks_share_a_face() -> None:
    mesh = two_bricks()
    assert len(mesh.points) == 12
    assert len(boundary_facets(mesh.cells)) == 10
    assert len(np.intersect1d(mesh.cells[0], mesh.cells[1])) == 4


def test_named_facets_and_free_ones() -> None:
    mesh = two_bricks()
    named = mesh.facets[mesh.facet_tags == mesh.faces["end"]]
    assert len(named) == 1
    assert np.all(mesh.points[named[0], 0] == -0.5)
    assert np.count_nonzero(mesh.facet_tags == mesh.faces["free"]) == 9


def test_left_handed_cells_are_turned() -> None:
    mesh = two_bricks(turned=True)
    assert np.linalg.det(jacobians(mesh.points, mesh.cells, gauss_points(2)[0])).min() > 0.0
