"""What a mesh file holds, whatever its format: nodes, solid cells in gmsh's node order, groups of cells and faces.

Verified by tests/unit/test_own_mesh_files.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

__all__ = ["KINDS", "CellBlock", "FileMesh"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

KINDS: Mapping[str, int] = MappingProxyType(
    {
        "8-node hexahedra": 8,
        "20-node hexahedra": 20,
        "27-node hexahedra": 27,
        "4-node tetrahedra": 4,
        "10-node tetrahedra": 10,
    }
)
"""Cells that can be solved -> their nodes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CellBlock:
    """Cells of one kind.

    Attributes
    ----------
    kind : name, one of `KINDS` or what else the file has
    nodes : (k, n) int, rows of the mesh's points, in gmsh's order; n may be 0 for a kind that is not known
    numbers : (k,) int, the file's own numbers of the cells
    """

    kind: str
    nodes: Index
    numbers: Index


@dataclass(frozen=True, slots=True, kw_only=True)
class FileMesh:
    """Content of a mesh file.

    Attributes
    ----------
    points : (n, 3) float, in the file's unit and axes
    node_numbers : (n,) int, the file's own numbers of the nodes
    blocks : its solid cells, block by block; cells count through all blocks from 0
    groups : name -> cells (k,) int
    facets : name of a group of faces -> corners (k, 3 or 4) int of each face
    cell_faces : name of a group of faces -> (k, 2) int, cell and the face's number in it, gmsh's from 0
    node_sets : name -> nodes (k,) int; a face belongs to one if all its nodes do
    flat : number of its plane cells
    """

    points: Array
    node_numbers: Index
    blocks: Sequence[CellBlock]
    groups: Mapping[str, Index]
    facets: Mapping[str, Sequence[Index]] = field(default_factory=dict)
    cell_faces: Mapping[str, Index] = field(default_factory=dict)
    node_sets: Mapping[str, Index] = field(default_factory=dict)
    flat: int = 0

    @property
    def face_names(self) -> tuple[str, ...]:
        """Names by which faces can be called."""
        return tuple(dict.fromkeys([*self.facets, *self.cell_faces, *self.node_sets]))
