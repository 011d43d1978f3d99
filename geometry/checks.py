"""Checks a mesh must pass before anything is computed on it; each raises MeshError.

Verified, with damaged meshes as negative controls, by tests/verification/test_mesh_conformity.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.errors import MeshError
from contracts.mesh import TaggedMesh
from geometry.closed_form import closed_form_joint_areas, closed_form_volume
from geometry.hexahedra import face_nodes, jacobians, reference_nodes
from geometry.measures import joint_areas, mesh_volume, scaled_jacobians
from geometry.wheel import WheelDesign

__all__ = [
    "check_boundary_tagged",
    "check_connected",
    "check_matches_design",
    "check_mesh",
    "check_no_coincident_nodes",
    "check_not_inverted",
]

COINCIDENT = 1e-7
"""Two nodes closer than this [m] should have been one."""


def check_mesh(mesh: TaggedMesh) -> None:
    """Check cells, joints and boundary tags of any mesh.

    Raises
    ------
    MeshError
        For an inverted cell, coincident nodes (an unmerged joint), separate pieces, facets that do not meet node to
        node, or boundary facets that are not in exactly one face group.
    """
    check_not_inverted(mesh)
    check_no_coincident_nodes(mesh)
    check_connected(mesh)
    check_boundary_tagged(mesh)


def check_not_inverted(mesh: TaggedMesh) -> None:
    """Raise MeshError if det J <= 0 at a corner, Gauss point or node of a cell."""
    worst = scaled_jacobians(mesh).min(axis=1)
    at_nodes = np.linalg.det(jacobians(mesh.points, mesh.cells, reference_nodes(mesh.cells.shape[1]))).min(axis=1)
    bad = np.flatnonzero((worst <= 0.0) | (at_nodes <= 0.0))
    if len(bad):
        raise MeshError(
            f"{len(bad)} inverted cells, the first is cell {bad[0]} of part {_part_of(mesh, int(bad[0]))} with scaled "
            f"Jacobian {worst[bad[0]]:.3g}: it must be > 0; use a smaller element size"
        )


def check_no_coincident_nodes(mesh: TaggedMesh) -> None:
    """Raise MeshError if two nodes lie within ``COINCIDENT`` of each other: a joint there is not joined."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(mesh.points).query_pairs(COINCIDENT, output_type="ndarray")
    if len(pairs):
        where = ", ".join(f"{c * 1e3:.4g}" for c in mesh.points[pairs[0, 0]])
        raise MeshError(
            f"{len(pairs)} pairs of coincident nodes, the first at ({where}) mm: parts that touch there are not "
            "connected; merge the nodes"
        )


def check_connected(mesh: TaggedMesh) -> None:
    """Raise MeshError unless all cells hang together by shared nodes and every node belongs to a cell."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n_cells, n_nodes = mesh.cells.shape
    rows = np.repeat(np.arange(n_cells), n_nodes)
    columns = n_cells + mesh.cells.ravel()
    size = n_cells + len(mesh.points)
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    pieces, label = connected_components(graph, directed=False)
    if pieces > 1:
        parts = sorted({_part_of(mesh, int(c)) for c in np.flatnonzero(label[:n_cells] != label[0])})
        loose = f"separate from the rest: {', '.join(parts)}" if parts else "nodes without a cell"
        raise MeshError(f"the mesh falls into {pieces} pieces, {loose}; every part must be joined")


def check_boundary_tagged(mesh: TaggedMesh) -> None:
    """Raise MeshError unless facets meet node to node and each boundary facet is in exactly one face group."""
    local = face_nodes(mesh.cells.shape[1])
    facets = mesh.cells[:, local].reshape(-1, local.shape[1])
    _, by_corner = np.unique(np.sort(facets[:, :4], axis=1), axis=0, return_inverse=True)
    count = np.bincount(by_corner.ravel())
    whole, number = np.unique(np.sort(facets, axis=1), axis=0, return_counts=True)
    if count.max() > 2:
        raise MeshError(f"{int((count > 2).sum())} facets belong to more than two cells; cells overlap")
    if len(whole) != len(count):
        raise MeshError(f"{len(whole) - len(count)} facets share corners but not their middle nodes; merge them")
    boundary = _keys(whole[number == 1])
    tagged = _keys(np.sort(mesh.facets, axis=1))
    missing, extra = len(boundary - tagged), len(tagged - boundary)
    if missing or extra or len(tagged) != len(mesh.facets):
        raise MeshError(
            f"{missing} boundary facets are untagged, {extra} tagged facets are not on the boundary, "
            f"{len(mesh.facets) - len(tagged)} are tagged twice; every boundary facet belongs to exactly one face group"
        )


def check_matches_design(mesh: TaggedMesh, design: WheelDesign, tolerance: float = 1e-3) -> None:
    """Raise MeshError if a part's volume, or a joint's area, differs from its closed form by more than ``tolerance``.

    Parameters
    ----------
    mesh : mesh of ``design``; of half the width if it has the face group ``"symmetry"``
    design : the wheel
    tolerance : relative difference allowed [-]; 1e-3 holds for order 2, order 1 needs small elements
    """
    half_width = "symmetry" in mesh.faces
    volumes, areas = mesh_volume(mesh), joint_areas(mesh)
    expected = {f"volume of {n}": v for n, v in closed_form_volume(design, half_width).items() if n in mesh.parts}
    found = {f"volume of {n}": v for n, v in volumes.items()}
    for (a, b), area in closed_form_joint_areas(design, half_width).items():
        if a in mesh.parts and b in mesh.parts:
            expected[f"joint of {a} and {b}"] = area
    found |= {f"joint of {a} and {b}": area for (a, b), area in areas.items()}
    for what in sorted(expected.keys() | found.keys()):
        value, reference = found.get(what, 0.0), expected.get(what, 0.0)
        if not abs(value - reference) <= tolerance * reference:
            raise MeshError(
                f"{what} is {value:.6g} on the mesh and {reference:.6g} by its dimensions (SI): they must agree to "
                f"{tolerance:g}; use order 2 or a smaller element size, and check that parts are joined"
            )


def _part_of(mesh: TaggedMesh, cell: int) -> str:
    return next(name for name, tag in mesh.parts.items() if tag == mesh.cell_tags[cell])


def _keys(facets: NDArray[np.int64]) -> set[bytes]:
    return {row.tobytes() for row in np.ascontiguousarray(facets, dtype=np.int64)}
