"""What cells of a mesh file must be before they are solved; each fault is told with the cell.

Verified by tests/unit/test_own_mesh_faults.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.counting import LARGEST_MESH
from geometry.hexahedra import VTK_FROM_GMSH, gauss_points, jacobians, reference_nodes
from geometry.inp import TWENTY_NODES
from geometry.own_mesh.completion import TETRAHEDRON_EDGES, completed
from geometry.own_mesh.file_mesh import KINDS, FileMesh

__all__ = ["require_finite", "require_sound", "solid_cells"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_FAR = 0.3
"""Distance of an edge's middle node from the middle of its ends, over its length, that no sound edge has [-]: a
quarter makes the map along a straight edge singular at its end, an arc of 120 degrees has 0.29."""
_EDGES = np.array(((0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)))
_ORDERS = {
    20: {"VTK, Abaqus and meshio": TWENTY_NODES},
    27: {"VTK and meshio": VTK_FROM_GMSH},
    10: {"VTK, Abaqus and meshio": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)},
}
"""Nodes of a cell -> whose other order, and the place in gmsh's of each of its nodes."""


def solid_cells(file: FileMesh) -> tuple[Index, Index]:
    """Nodes of the solid cells, all of one kind, and the file's numbers of them.

    Raises
    ------
    InputError
        If there are none, too many, of a kind that is not solved, or of several.
    """
    if not file.blocks:
        flat = f"plane cells ({file.flat}) alone" if file.flat else "no cells"
        rule = f"has {flat}, where a wheel needs solid ones"
        raise InputError(
            "mesh file", "", rule, "mesh the volume and save its cells, in a group of their own", key="file"
        )
    kinds = {block.kind: block for block in reversed(file.blocks)}
    for kind, block in kinds.items():
        if kind not in KINDS:
            rule = f"has cells that are not solved: {kind}, the first is cell {block.numbers[0]}"
            raise InputError("mesh file", "", rule, f"mesh with {', '.join(KINDS)}", key="file")
    if len(kinds) > 1:
        told = " and ".join(f"{kind} (cell {block.numbers[0]})" for kind, block in kinds.items())
        raise InputError("mesh file", "", f"mixes kinds of cells: {told}", "mesh all parts with one kind", key="file")
    cells = np.concatenate([block.nodes for block in file.blocks])
    if len(cells) > LARGEST_MESH:
        rule = f"has {len(cells)} cells, at most {LARGEST_MESH} can be solved"
        raise InputError("mesh file", "", rule, "mesh with larger elements", key="file")
    return cells, np.concatenate([block.numbers for block in file.blocks])


def require_finite(file: FileMesh, cells: Index) -> None:
    """Raise InputError for a node of a cell that is nowhere."""
    bad = np.flatnonzero(~np.isfinite(file.points).all(axis=1))
    bad = bad[np.isin(bad, cells)]
    if len(bad):
        rule = f"has {len(bad)} nodes without finite coordinates, the first is node {file.node_numbers[bad[0]]}"
        raise InputError("mesh file", "", rule, "write it again", key="file")


def require_sound(points: Array, cells: Index, name: Callable[[int], str]) -> None:
    """Raise InputError for cells that name a node twice, whose nodes stand in another order, or that are inverted.

    points : (n, 3) float, any unit; cells : (m, n) int; name : a cell in words
    """
    ordered = np.sort(cells, axis=1)
    twice = np.flatnonzero((np.diff(ordered, axis=1) == 0).any(axis=1))
    if len(twice):
        rule = f"has {len(twice)} cells that name a node twice, the first is {name(twice[0])}"
        raise InputError("mesh file", "", rule, "degenerate cells cannot be solved; mesh without them", key="file")
    _require_order(points, cells, name)
    made = completed(points, cells)
    at = np.vstack([reference_nodes(8), gauss_points(3)[0], reference_nodes(made.cells.shape[1])])
    J = jacobians(made.points, made.cells, at)
    scaled = np.linalg.det(J) / np.maximum(np.prod(np.linalg.norm(J, axis=2), axis=-1), np.finfo(float).tiny)
    worst = scaled.min(axis=1)
    bad = np.flatnonzero(~(worst > 0.0))
    if len(bad):
        inverted = np.unique(made.cell_of[bad])
        inside_out = len(inverted) == len(cells) and scaled.max() <= 0.0
        rule = f"has {len(inverted)} inverted cells of {len(cells)}, the first is {name(inverted[0])} with the scaled "
        hint = "its nodes run the wrong way round: mirror their order" if inside_out else "mesh it finer there"
        raise InputError("mesh file", "", f"{rule}Jacobian {worst[bad[0]]:.3g} (it must be > 0)", hint, key="file")


def _require_order(points: Array, cells: Index, name: Callable[[int], str]) -> None:
    """Middle nodes of edges lie near the middles: else they stand in another program's order."""
    count = cells.shape[1]
    if count not in _ORDERS:
        return
    off = _off_middle(points, cells)
    bad = np.flatnonzero(~(off < _FAR))
    if not len(bad):
        return
    for whose, places in _ORDERS[count].items():
        theirs = np.empty_like(cells)
        theirs[:, list(places)] = cells
        if np.count_nonzero(_off_middle(points, theirs) < _FAR) > 0.9 * len(cells):
            rule = f"has the nodes of its cells in the order of {whose}, not that of its format: {name(bad[0])} is one"
            raise InputError("mesh file", "", rule, "write it with its format's own order", key="file")
    rule = f"has {len(bad)} cells with a middle node far from the middle of its edge, the first is {name(bad[0])}"
    raise InputError("mesh file", "", rule, "check the order of the cells' nodes, or mesh it finer", key="file")


def _off_middle(points: Array, cells: Index) -> Array:
    """Largest distance of a middle node from the middle of its edge, over the edge's length, (n_cells,) [-]."""
    tetrahedra = cells.shape[1] == 10
    edges, first = (np.array(TETRAHEDRON_EDGES), 4) if tetrahedra else (_EDGES, 8)
    ends, middles = points[cells[:, edges]], points[cells[:, first : first + len(edges)]]
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    off = np.linalg.norm(middles - ends.mean(axis=2), axis=2)
    return np.asarray((off / np.maximum(length, np.finfo(float).tiny)).max(axis=1))
