"""A tagged hexahedral mesh as plain arrays: what geometry hands to the finite element solver and to exports."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from contracts.errors import MeshError

__all__ = ["FACET_NODES", "TaggedMesh"]

FACET_NODES: Mapping[int, int] = MappingProxyType({8: 4, 27: 9})
"""Nodes of a facet for each supported number of nodes of a hexahedron."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TaggedMesh:
    """Hexahedra with named parts and named boundary faces. Node order of cells and facets is gmsh's.

    Attributes
    ----------
    points : (n_points, 3) float [m], wheel frame for a wheel
    cells : (n_cells, 8 or 27) int, node numbers of each hexahedron
    cell_tags : (n_cells,) int, the part of each cell
    facets : (n_facets, 4 or 9) int, node numbers of each tagged boundary facet
    facet_tags : (n_facets,) int, the face group of each facet
    parts : part name -> cell tag
    faces : face group name -> facet tag

    Raises
    ------
    MeshError
        For arrays of the wrong shape, tags without a name, or node numbers out of range.

    Verified by tests/unit/test_tagged_mesh.py.
    """

    points: NDArray[np.float64]
    cells: NDArray[np.int64]
    cell_tags: NDArray[np.int32]
    facets: NDArray[np.int64]
    facet_tags: NDArray[np.int32]
    parts: Mapping[str, int]
    faces: Mapping[str, int]

    def __post_init__(self) -> None:
        if self.points.ndim != 2 or self.points.shape[1] != 3 or not np.all(np.isfinite(self.points)):
            raise MeshError(f"points have shape {self.points.shape}: need (n, 3) finite coordinates in metres")
        if self.cells.ndim != 2 or self.cells.shape[1] not in FACET_NODES:
            raise MeshError(f"cells have shape {self.cells.shape}: need (n, 8) or (n, 27) hexahedra; use order 1 or 2")
        if self.facets.ndim != 2 or self.facets.shape[1] != FACET_NODES[self.cells.shape[1]]:
            raise MeshError(
                f"facets have shape {self.facets.shape}: they must be faces of the hexahedra, of equal order"
            )
        if len(self.cell_tags) != len(self.cells) or len(self.facet_tags) != len(self.facets):
            raise MeshError("one tag per cell and one per facet is needed: check the tag arrays' lengths")
        for what, nodes in (("cells", self.cells), ("facets", self.facets)):
            if nodes.min(initial=0) < 0 or nodes.max(initial=-1) >= len(self.points):
                raise MeshError(f"{what} name nodes outside 0..{len(self.points) - 1}: renumber the {what}")
        if not set(np.unique(self.cell_tags)) <= set(self.parts.values()):
            raise MeshError("a cell tag has no part name: every cell belongs to a named part")
        if not set(np.unique(self.facet_tags)) <= set(self.faces.values()):
            raise MeshError("a facet tag has no face name: every tagged facet belongs to a named group")

    @property
    def order(self) -> int:
        """Polynomial order of the geometry: 1 for 8-node and 2 for 27-node hexahedra."""
        return 1 if self.cells.shape[1] == 8 else 2

    def hash(self) -> str:
        """SHA-256 of the mesh: coordinates rounded to 1e-12 m, connectivity, tags and names (hexadecimal)."""
        digest = hashlib.sha256()
        rounded = np.round(self.points / 1e-12).astype(np.int64)
        for array in (rounded, self.cells, self.cell_tags, self.facets, self.facet_tags):
            digest.update(repr(array.shape).encode())
            digest.update(np.ascontiguousarray(array, dtype=np.int64).tobytes())
        digest.update(repr((sorted(self.parts.items()), sorted(self.faces.items()))).encode())
        return digest.hexdigest()
