"""From a wheel design to a planar mesh of its section: rim, grousers, every spring set and the outer hub.

All axial bands are drawn into one plane, each part with its own width. Spring sets of different bands may cross there;
they share no node, because only blocks built on the same corners do (`geometry.section`): sets meet at their welds on
rim and hub alone. Verified by tests/verification/test_planar_mesh.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError, MeshError
from contracts.mesh import TaggedMesh
from geometry.assembly import FREE
from geometry.build import mesh_size
from geometry.counting import count_planar, require_buildable
from geometry.gmsh_session import gmsh_session
from geometry.resolution import hub_ring, part_bands, part_names, rim_ring
from geometry.section import build_section
from geometry.solids import Drawn, divide_faces, draw_faces
from geometry.wheel import WheelDesign

__all__ = ["build_planar_mesh", "planar_areas", "planar_widths"]

_LINE = {1: 1, 2: 8}
_QUADRANGLE = {1: (3, 4), 2: (10, 9)}
_EDGES = np.array([(0, 1, 4), (1, 2, 5), (2, 3, 6), (3, 0, 7)])
"""Local nodes of a quadrilateral's edges in gmsh's order: ends, then middle."""
_MIRROR = {4: [0, 3, 2, 1], 9: [0, 3, 2, 1, 7, 6, 5, 4, 8]}

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Named = list[tuple[str, Index]]


def build_planar_mesh(
    design: WheelDesign,
    *,
    element_size: float,
    thickness_elements: int = 1,
    order: int = 2,
    refinement: Mapping[str, float] | None = None,
    factor: float = 1.0,
) -> TaggedMesh:
    """Mesh a wheel's section with structured quadrilaterals, conforming where parts are joined.

    Parameters
    ----------
    design : the wheel; its cone, impact springs and inner hub are no part of a planar model and left out
    element_size : largest element length along strips and around rings [m]; half rings have at least 8 elements
    thickness_elements : elements through every thickness
    order : 1 for 4-node, 2 for 9-node quadrilaterals on the curved geometry
    refinement : part name -> element size [m] where it differs from ``element_size``
    factor : at least 1; every count of elements along strips is multiplied by it and rounded up

    Returns
    -------
    mesh : points (n, 2) [m], the wheel frame's x and z; parts ``"tire"``, ``"grousers"``, one per spring set and
        ``"outer_hub"``, each with its ``width``; face groups as in `geometry.build.build_mesh`

    Raises
    ------
    InputError
        For sizes out of range, unknown part names, more cells than can be built, and a wheel with sidewall springs,
        which bend out of the plane.
    """
    if design.sidewall_springs is not None:
        rule = "bend out of the plane: the wheel has no planar model"
        raise InputError("sidewall springs", design.sidewall_springs.name, rule, "use the solid model")
    if not (math.isfinite(factor) and factor >= 1.0):
        raise InputError("refinement factor", factor, "must be at least 1", "choose a larger element size instead")
    size = replace(mesh_size(design, element_size, None, thickness_elements, refinement), factor=factor)
    if order not in _LINE:
        raise InputError("order", order, "must be 1 or 2", "use 2 for curved geometry")
    names = part_names(design, "flexible")
    require_buildable(count_planar(design, size, order), {"element_size": element_size})
    rings = rim_ring(design, size), hub_ring(design, size, "flexible")
    with gmsh_session(f"{design.name} section") as gmsh:
        drawn = draw_faces(gmsh.model.occ, build_section(design, size, rings, frozenset(names)), 0.0)
        divide_faces(gmsh, drawn, order)
        points, cells, edges = _extract(gmsh, drawn, order)
    return _assemble(points, cells, edges, planar_widths(design))


def planar_widths(design: WheelDesign) -> dict[str, float]:
    """Width of each part of the planar mesh [m]: the sum of its axial bands."""
    bands = part_bands(design)
    return {name: sum(b - a for a, b in bands[name]) for name in part_names(design, "flexible")}


def planar_areas(mesh: TaggedMesh) -> dict[str, float]:
    """Area of each part of a planar mesh [m^2], exact for straight edges and to 1e-6 for curved ones."""
    weights, jacobian = _jacobians(mesh.points, mesh.cells)
    areas = np.linalg.det(jacobian) @ weights
    return {name: float(areas[mesh.cell_tags == tag].sum()) for name, tag in mesh.parts.items()}


def _extract(gmsh: Any, drawn: list[Drawn], order: int) -> tuple[Array, Named, Named]:
    """Nodes (n, 2), quadrilaterals by part and edges by face group."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    index[tags] = np.arange(len(tags))

    def elements(dim: int, tag: int, kind: int, nodes_each: int) -> Index:
        kinds, _, nodes = gmsh.model.mesh.getElements(dim, tag)
        if list(kinds) != [kind]:
            raise MeshError(f"gmsh could not divide entity {tag} into structured cells; try a smaller element size")
        return index[np.asarray(nodes[0], dtype=np.int64)].reshape(-1, nodes_each)

    kind, nodes_each = _QUADRANGLE[order]
    cells = [(block.part, elements(2, face, kind, nodes_each)) for block, face, _ in drawn]
    edges = [
        (group, elements(1, abs(curve), _LINE[order], order + 1))
        for block, _, sides in drawn
        for side, group in block.groups.items()
        for curve in sides[side]
    ]
    return np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)[:, [0, 2]], cells, edges


def _assemble(points: Array, cells: Named, edges: Named, widths: Mapping[str, float]) -> TaggedMesh:
    """Cells sorted by part and turned anticlockwise, each boundary edge in a group (``"free"`` if unnamed)."""
    named_cells = np.concatenate([c for name in widths for part, c in cells if part == name])
    counts = [sum(len(c) for part, c in cells if part == name) for name in widths]
    kept, inverse = np.unique(named_cells, return_inverse=True)
    points, flat = points[kept], np.asarray(inverse, dtype=np.int64).reshape(-1, named_cells.shape[1])
    number = np.full(int(kept.max()) + 1, -1, dtype=np.int64)
    number[kept] = np.arange(len(kept))
    clockwise = np.linalg.det(_jacobians(points, flat)[1]).sum(axis=1) < 0.0
    flat = np.where(clockwise[:, None], flat[:, _MIRROR[flat.shape[1]]], flat)
    facets = _boundary(flat)
    groups = {group: k + 1 for k, group in enumerate([*dict.fromkeys(group for group, _ in edges), FREE])}
    named = {tuple(sorted(number[edge[:2]])): groups[group] for group, block in edges for edge in block}
    tags = np.array([named.get(tuple(sorted(edge[:2])), groups[FREE]) for edge in facets], dtype=np.int32)
    return TaggedMesh(
        points=points,
        cells=flat,
        cell_tags=np.repeat(np.arange(1, len(widths) + 1), counts).astype(np.int32),
        facets=facets,
        facet_tags=tags,
        parts={name: k + 1 for k, name in enumerate(widths)},
        faces={group: tag for group, tag in groups.items() if np.any(tags == tag)},
        widths=widths,
    )


def _boundary(cells: Index) -> Index:
    """Edges that belong to one cell only, (n, 2 or 3), the body on their left, ordered by cell."""
    local = _EDGES if cells.shape[1] == 9 else _EDGES[:, :2]
    edges = cells[:, local].reshape(-1, local.shape[1])
    _, inverse, count = np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(edges[count[inverse.ravel()] == 1], dtype=np.int64)


def _jacobians(points: Array, cells: Index) -> tuple[Array, Array]:
    """Weights (9,) and d x_i / d xi_j (n_cells, 9, 2, 2) [m] at 3 x 3 Gauss points of each quadrilateral."""
    x, w = np.polynomial.legendre.leggauss(3)
    value, slope = _line(x, cells.shape[1])
    n = len(value[0])
    along = np.einsum("qa,rb->qrab", slope, value).reshape(9, n, n)
    across = np.einsum("qa,rb->qrab", value, slope).reshape(9, n, n)
    grid = points[cells[:, _LATTICE[cells.shape[1]]]]
    columns = [np.einsum("qab,cabi->cqi", d, grid) for d in (along, across)]
    return np.outer(w, w).ravel(), np.stack(columns, axis=-1)


_LATTICE = {4: np.array([[0, 3], [1, 2]]), 9: np.array([[0, 7, 3], [4, 8, 6], [1, 5, 2]])}
"""Local node at each place (first axis, second axis) of the reference square."""


def _line(x: Array, nodes: int) -> tuple[Array, Array]:
    """Lagrange polynomials on [-1, 1] and their slopes at x, (n_x, 2 or 3) each."""
    if nodes == 4:
        half = np.full_like(x, 0.5)
        return np.column_stack([(1 - x) / 2, (1 + x) / 2]), np.column_stack([-half, half])
    return np.column_stack([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2]), np.column_stack([x - 0.5, -2 * x, x + 0.5])
