"""A tagged mesh as plain arrays, solid or planar: what geometry hands to the finite element solver and to exports."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from contracts.errors import MeshError

__all__ = ["FACET_NODES", "TaggedMesh"]

FACET_NODES: Mapping[int, int] = MappingProxyType({4: 2, 9: 3, 8: 4, 27: 9})
"""Nodes of a facet for each supported number of nodes of a cell: quadrilaterals (4, 9) and hexahedra (8, 27)."""
_CELL_NODES = {2: (4, 9), 3: (8, 27)}
_CELLS = {2: "(n, 4) or (n, 9) quadrilaterals", 3: "(n, 8) or (n, 27) hexahedra"}


@dataclass(frozen=True, slots=True, kw_only=True)
class TaggedMesh:
    """Hexahedra, or quadrilaterals in a plane, with named parts and named boundary faces. Node order is gmsh's.

    Attributes
    ----------
    points : (n_points, 3) float [m], wheel frame for a wheel; (n_points, 2) for a planar mesh, a wheel's x and z
    cells : (n_cells, 8 or 27) int, node numbers of each hexahedron; (n_cells, 4 or 9) of each quadrilateral
    cell_tags : (n_cells,) int, the part of each cell
    facets : (n_facets, 4 or 9) int, node numbers of each tagged boundary facet; (n_facets, 2 or 3) of each edge
    facet_tags : (n_facets,) int, the face group of each facet
    parts : part name -> cell tag
    faces : face group name -> facet tag
    widths : part name -> width at right angles to the plane [m], for every part of a planar mesh; empty for a solid one

    Raises
    ------
    MeshError
        For arrays of the wrong shape, tags without a name, node numbers out of range, or parts without a width.

    Verified by tests/unit/test_tagged_mesh.py.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell_tags: NDArray[np.int32]
    facets: NDArray[np.int64]
    facet_tags: NDArray[np.int32]
    parts: Mapping[str, int]
    faces: Mapping[str, int]
    widths: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.points.ndim != 2 or self.dim not in _CELL_NODES or not np.all(np.isfinite(self.points)):
            raise MeshError(
                f"points have shape {self.points.shape}: need (n, 3) or (n, 2) finite coordinates in metres"
            )
        if self.cells.ndim != 2 or self.cells.shape[1] not in _CELL_NODES[self.dim]:
            raise MeshError(f"cells have shape {self.cells.shape}: need {_CELLS[self.dim]}; use order 1 or 2")
        if self.facets.ndim != 2 or self.facets.shape[1] != FACET_NODES[self.cells.shape[1]]:
            raise MeshError(f"facets have shape {self.facets.shape}: they must be faces of the cells, of equal order")
        if len(self.cell_tags) != len(self.cells) or len(self.facet_tags) != len(self.facets):
            raise MeshError("one tag per cell and one per facet is needed: check the tag arrays' lengths")
        for what, nodes in (("cells", self.cells), ("facets", self.facets)):
            if nodes.min(initial=0) < 0 or nodes.max(initial=-1) >= len(self.points):
                raise MeshError(f"{what} name nodes outside 0..{len(self.points) - 1}: renumber the {what}")
        if not set(np.unique(self.cell_tags)) <= set(self.parts.values()):
            raise MeshError("a cell tag has no part name: every cell belongs to a named part")
        if not set(np.unique(self.facet_tags)) <= set(self.faces.values()):
            raise MeshError("a facet tag has no face name: every tagged facet belongs to a named group")
        if set(self.widths) != (set(self.parts) if self.dim == 2 else set()):
            raise MeshError("each part of a planar mesh needs a width, and only there: check the widths' names")
        if not all(np.isfinite(width) and width > 0.0 for width in self.widths.values()):
            raise MeshError("a width must be finite and greater than zero: give metres")

    @property
    def dim(self) -> int:
        """Dimension of space: 2 for a planar mesh, 3 for a solid one."""
        return int(self.points.shape[1])

    @property
    def order(self) -> int:
        """Polynomial order of the geometry: 1 for 4- and 8-node, 2 for 9- and 27-node cells."""
        return 1 if self.cells.shape[1] == 2**self.dim else 2

    def hash(self) -> str:
        """SHA-256 of the mesh: coordinates rounded to 1e-12 m, connectivity, tags, names and widths (hexadecimal)."""
        digest = hashlib.sha256()
        rounded = np.round(self.points / 1e-12).astype(np.int64)
        for array in (rounded, self.cells, self.cell_tags, self.facets, self.facet_tags):
            digest.update(repr(array.shape).encode())
            digest.update(np.ascontiguousarray(array, dtype=np.int64).tobytes())
        names = (self.parts, self.faces, *([self.widths] if self.dim == 2 else []))
        digest.update(repr(tuple(sorted(group.items()) for group in names)).encode())
        return digest.hexdigest()
