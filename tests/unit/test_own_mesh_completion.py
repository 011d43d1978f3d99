"""Middle nodes of 20-node hexahedra and the four hexahedra of a tetrahedron: same body, same faces, exact maps."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from geometry.assembly import boundary_facets
from geometry.hexahedra import face_nodes, gauss_points, jacobians, reference_nodes
from geometry.own_mesh.completion import completed, refined
from geometry.own_mesh.file_counting import count_cells
from geometry.own_mesh.tetrahedron_quality import scaled_jacobians_of_tetrahedra
from tests.ring_wheel import ring_wheel

CUBE = reference_nodes(27)


def _quadratic(points: np.ndarray) -> np.ndarray:
    """A map whose terms all are serendipity's: no product of squares, none of more than two squares."""
    x, y, z = points.T
    return np.column_stack([x + 0.1 * x * x * y + 0.05 * y * z, y + 0.1 * z * z - 0.05 * x * y * z, z + 0.1 * x * x])


def test_the_middles_of_20_nodes_are_those_of_their_own_map() -> None:
    found = completed(_quadratic(CUBE[:20]), np.arange(20)[None])
    assert found.points[found.cells[0]] == pytest.approx(_quadratic(CUBE), abs=1e-14)


def test_middles_that_serendipity_does_not_have_are_not_made_up() -> None:
    """Negative control: a bubble on a face is lost with its node."""
    bubble = np.column_stack(
        [CUBE[:, 0], CUBE[:, 1], CUBE[:, 2] + 0.1 * (1.0 - CUBE[:, 0] ** 2) * (1.0 - CUBE[:, 1] ** 2)]
    )
    found = completed(bubble[:20], np.arange(20)[None])
    assert np.abs(found.points[found.cells[0]] - bubble).max() == pytest.approx(0.1)


def test_cells_share_the_middles_of_their_common_faces() -> None:
    two = np.vstack([CUBE[:20], CUBE[:20] + np.array([2.0, 0.0, 0.0])])
    points, number = np.unique(two, axis=0, return_inverse=True)
    found = completed(points, number.reshape(2, 20))
    assert len(found.points) == 45
    assert len(boundary_facets(found.cells)) == 10


@pytest.mark.parametrize("order", [1, 2])
def test_a_tetrahedron_is_four_hexahedra_of_its_volume_on_its_map(order: int) -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    edges = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
    nodes = corners if order == 1 else np.vstack([corners, [corners[list(e)].mean(axis=0) for e in edges]])
    if order == 2:
        nodes[4] += [0.0, -0.08, -0.05]  # the edge between the first two corners bulges out
    found = completed(nodes, np.arange(len(nodes))[None])
    at, weights = gauss_points(4)
    volume = np.linalg.det(jacobians(found.points, found.cells, at)) @ weights
    assert len(found.cells) == 4
    assert (volume > 0.0).all()
    if order == 1:
        assert volume == pytest.approx(np.full(4, 1.0 / 24.0))
    else:
        assert volume.sum() == pytest.approx(_volume(nodes), rel=1e-5)


def test_straight_tetrahedra_of_both_orders_are_the_same_hexahedra() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0.2, 1, 0], [0.1, 0.3, 1]])
    edges = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
    linear = completed(corners, np.arange(4)[None])
    nodes = np.vstack([corners, [corners[list(e)].mean(axis=0) for e in edges]])
    quadratic = completed(nodes, np.arange(10)[None])
    at = reference_nodes(27)
    ours, theirs = (jacobians(found.points, found.cells, at) for found in (linear, quadratic))
    assert theirs == pytest.approx(ours, abs=1e-14)


REGULAR = np.array([[1.0, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])


def test_the_shape_of_a_tetrahedron_is_its_own() -> None:
    """1 if it is regular, 0.71 in the corner of a cube, as its heights if it is flat, < 0 inside out; turned or not."""
    cube = np.vstack([np.zeros(3), np.eye(3)])
    flat = REGULAR * (1.0, 1.0, 1e-3)
    for nodes, value in ((REGULAR, 1.0), (cube, 0.5**0.5), (REGULAR[[1, 0, 2, 3]], -1.0)):
        assert scaled_jacobians_of_tetrahedra(nodes, np.arange(4)[None]) == pytest.approx([value])
    assert 0.0 < scaled_jacobians_of_tetrahedra(flat, np.arange(4)[None])[0] < 3e-3
    edges = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
    straight = np.vstack([REGULAR, [REGULAR[list(e)].mean(axis=0) for e in edges]])
    assert scaled_jacobians_of_tetrahedra(straight, np.arange(10)[None]) == pytest.approx([1.0])
    bent = straight.copy()
    bent[4] += 0.3 * (REGULAR[2] - bent[4])
    assert scaled_jacobians_of_tetrahedra(bent, np.arange(10)[None])[0] < 0.7


def _volume(nodes: np.ndarray) -> float:
    """Of a 10-node tetrahedron, by a rule of its own: 24 points an axis of the cube collapsed onto it."""
    x, w = np.polynomial.legendre.leggauss(24)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    edges = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
    total = 0.0
    for (i, u), (j, v), (k, t) in itertools.product(enumerate(x), repeat=3):
        r, s, q = u, v * (1.0 - u), t * (1.0 - u) * (1.0 - v)
        share = np.array([1.0 - r - s - q, r, s, q])
        slopes = np.array([[-1.0, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        gradients = np.vstack(
            [(4.0 * share - 1.0)[:, None] * slopes]
            + [[4.0 * (share[a] * slopes[b] + share[b] * slopes[a])] for a, b in edges]
        )
        total += w[i] * w[j] * w[k] * (1.0 - u) ** 2 * (1.0 - v) * np.linalg.det(nodes.T @ gradients)
    return total


@pytest.mark.parametrize("nodes", [4, 10])
def test_tetrahedra_that_share_a_face_share_its_three_facets(nodes: int) -> None:
    """And each outer face has three facets, which lie in it, as the faces' list says."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    cells = np.array([[0, 1, 2, 3], [1, 4, 2, 3]])
    points = corners
    if nodes == 10:
        ends = [[cell[list(e)] for e in ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))] for cell in cells]
        keys = sorted({tuple(sorted(e)) for row in ends for e in row})
        points = np.vstack([corners, [corners[list(k)].mean(axis=0) for k in keys]])
        cells = np.hstack([cells, [[5 + keys.index(tuple(sorted(e))) for e in row] for row in ends]])
    found = completed(points, cells)
    assert len(found.cells) == 8
    assert len(boundary_facets(found.cells)) == 6 * 3
    local = face_nodes(found.cells.shape[1])
    for cell, faces in enumerate(found.faces):
        for face, corners_of in enumerate(((0, 2, 1), (0, 1, 3), (0, 3, 2), (3, 1, 2))):
            a, b, c = points[cells[cell, list(corners_of)]]
            normal = np.cross(b - a, c - a)
            for hexahedron, side in faces[face]:
                x = found.points[found.cells[hexahedron, local[side]]]
                assert np.abs((x - a) @ normal).max() < 1e-12
                assert np.cross(x[1] - x[0], x[3] - x[0]) @ normal > 0.0


@pytest.mark.parametrize("nodes", [8, 27])
@pytest.mark.parametrize("factor", [2, 3])
def test_a_divided_body_is_the_same_body(nodes: int, factor: int) -> None:
    """Two curved cells with a common face, of which one is turned: volumes, outer facets and shared nodes."""
    two = np.vstack([CUBE, CUBE + np.array([2.0, 0.0, 0.0])])[:, :]
    two = _quadratic(0.5 * two)
    points, number = np.unique(np.round(two, 12), axis=0, return_inverse=True)
    cells = number.reshape(2, 27)
    turn = [int(np.flatnonzero(np.all(np.roll(place, 1) == CUBE, axis=1))[0]) for place in CUBE]
    cells[1] = cells[1][turn]
    made = completed(points, cells[:, :nodes])
    found = refined(made, factor)
    at, weights = gauss_points(4)
    whole, parts = (np.linalg.det(jacobians(h.points, h.cells, at)) @ weights for h in (made, found))
    assert (parts > 0.0).all()
    assert np.bincount(found.cell_of, weights=parts) == pytest.approx(whole, rel=1e-12)
    assert len(boundary_facets(found.cells)) == 10 * factor**2
    order = 1 if nodes == 8 else 2
    side = order * factor + 1
    assert len(found.points) == (2 * side - 1) * side**2
    local = face_nodes(nodes)
    for cell, faces in enumerate(found.faces):
        for face, children in enumerate(faces):
            assert len(children) == factor**2
            inside = {row.tobytes() for row in np.round(_on_face(made, cell, face), 9)}
            for hexahedron, number_of in children:
                corners = found.points[found.cells[hexahedron, local[number_of][:4]]]
                assert {row.tobytes() for row in np.round(corners, 9) + 0.0} <= inside, (cell, face)


def _on_face(made: object, cell: int, face: int) -> np.ndarray:
    """All places of a fine lattice on a face of a cell."""
    corners = reference_nodes(8)[face_nodes(8)[face]]
    line = np.linspace(-1.0, 1.0, 7)
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    axis = int(np.flatnonzero(np.ptp(corners, axis=0) == 0.0)[0])
    grid = grid[grid[:, axis] == corners[0, axis]]
    nodes = made.points[made.cells[cell]]  # type: ignore[attr-defined]
    shapes = np.ones((len(grid), len(nodes)))
    for d in range(3):
        x, end = grid[:, d, None], reference_nodes(len(nodes))[None, :, d]
        if len(nodes) == 8:
            shapes *= 0.5 * (1.0 + end * x)
        else:
            shapes *= np.where(end == 0.0, 1.0 - x * x, 0.5 * x * (x + end))
    return shapes @ nodes + 0.0


@pytest.mark.parametrize("factor", [1, 2])
@pytest.mark.parametrize("nodes", [8, 20, 27])
def test_hexahedra_are_counted_before_they_are_made(nodes: int, factor: int) -> None:
    """Of second order by the nodes made; of first order they are the same, which the displacement needs."""
    cells = ring_wheel(nodes).blocks[0].nodes
    full = ring_wheel(27)
    made = refined(completed(full.points, full.blocks[0].nodes), factor)
    found = count_cells(cells, factor)
    assert (found.cells, found.nodes) == (len(made.cells), len(np.unique(made.cells)))


@pytest.mark.parametrize("factor", [1, 2])
def test_tetrahedra_are_counted_before_they_are_made(factor: int) -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    cells = np.array([[0, 1, 2, 3], [1, 4, 2, 3]])
    keys = sorted({tuple(sorted(pair)) for cell in cells.tolist() for pair in itertools.combinations(cell, 2)})
    edges = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
    middles = [[5 + keys.index(tuple(sorted((cell[a], cell[b])))) for a, b in edges] for cell in cells.tolist()]
    points = np.vstack([corners, [corners[list(key)].mean(axis=0) for key in keys]])
    made = refined(completed(points, np.hstack([cells, middles])), factor)
    found = count_cells(cells, factor)
    assert (found.cells, found.nodes) == (len(made.cells), len(np.unique(made.cells)))
