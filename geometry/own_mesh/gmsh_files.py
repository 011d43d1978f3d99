"""Reads what gmsh reads safely: its own .msh files, of any version, and Salome's .med files.

Verified by tests/unit/test_own_mesh_files.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from geometry.gmsh_session import gmsh_session
from geometry.own_mesh.file_mesh import CellBlock, FileMesh

__all__ = ["cell_blocks", "face_corners", "node_table", "read_gmsh"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_SOLID = {
    **{5: "8-node hexahedra", 17: "20-node hexahedra", 12: "27-node hexahedra"},
    **{4: "4-node tetrahedra", 11: "10-node tetrahedra"},
}
_BEGINS = {".msh": (b"$MeshFormat", b"$Comments"), ".med": (b"\x89HDF",)}
"""A file that begins otherwise gmsh would take for a script, and run it."""


def read_gmsh(path: Path) -> FileMesh:
    """Physical volumes are groups of cells, physical surfaces groups of faces, by name or else by number.

    Raises
    ------
    InputError
        For a file that is none of gmsh's, or that gmsh cannot read.
    """
    with path.open("rb") as stream:
        begin = stream.read(64).lstrip()
    if not begin.startswith(_BEGINS[path.suffix.lower()]):
        raise InputError("mesh file", path, f"is no {path.suffix} file: it begins otherwise", "write it again")
    with gmsh_session("own mesh") as gmsh:
        try:
            gmsh.merge(str(path))
        except Exception as error:  # gmsh raises nothing more special
            raise InputError("mesh file", path, f"cannot be read ({_said(error)})", "write it again") from error
        return _content(gmsh)


def _said(error: Exception) -> str:
    return " ".join(str(error).split())[:200]


def node_table(gmsh: Any) -> tuple[Index, Array]:
    """Numbers of the model's nodes (n,), ascending, and their places (n, 3)."""
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    numbers, first = np.unique(np.asarray(numbers, dtype=np.int64), return_index=True)
    return numbers, np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)[first]


def cell_blocks(gmsh: Any, numbers: Index) -> tuple[list[CellBlock], dict[int, list[Index]]]:
    """The model's solid cells, and which of them each of its volumes has, counted through all blocks."""
    blocks, of_entity, count = list[CellBlock](), dict[int, list[Index]](), 0
    for _, tag in gmsh.model.getEntities(3):
        for kind, cells, nodes in zip(*gmsh.model.mesh.getElements(3, tag), strict=True):
            name, _, _, n, _, _ = gmsh.model.mesh.getElementProperties(kind)
            rows = np.searchsorted(numbers, np.asarray(nodes, dtype=np.int64)).reshape(-1, n)
            found = CellBlock(kind=_SOLID.get(int(kind), name), nodes=rows, numbers=np.asarray(cells, dtype=np.int64))
            blocks.append(found)
            of_entity.setdefault(tag, []).append(np.arange(count, count + len(rows)))
            count += len(rows)
    return blocks, of_entity


def face_corners(gmsh: Any, tag: int, numbers: Index) -> tuple[list[Index], Index]:
    """Corners of the plane cells of one of the model's surfaces, and all nodes on it."""
    corners_of, every = list[Index](), [_none()]
    for kind, nodes in zip(*gmsh.model.mesh.getElements(2, tag)[::2], strict=True):
        _, _, _, n, _, corners = gmsh.model.mesh.getElementProperties(kind)
        rows = np.searchsorted(numbers, np.asarray(nodes, dtype=np.int64)).reshape(-1, n)
        corners_of.append(rows[:, :corners])
        every.append(rows.ravel())
    return corners_of, np.unique(np.concatenate(every))


def _content(gmsh: Any) -> FileMesh:
    numbers, points = node_table(gmsh)
    blocks, of_entity = cell_blocks(gmsh, numbers)
    groups: dict[str, Index] = {}
    for _, number in gmsh.model.getPhysicalGroups(3):
        mine = [one for tag in gmsh.model.getEntitiesForPhysicalGroup(3, number) for one in of_entity.get(tag, [])]
        name = gmsh.model.getPhysicalName(3, number).strip() or str(number)
        groups[name] = np.concatenate([groups.get(name, _none()), *mine])
    facets: dict[str, list[Index]] = {}
    for _, number in gmsh.model.getPhysicalGroups(2):
        mine = facets.setdefault(gmsh.model.getPhysicalName(2, number).strip() or str(number), [])
        for tag in gmsh.model.getEntitiesForPhysicalGroup(2, number):
            mine += face_corners(gmsh, tag, numbers)[0]
    flat = sum(len(rows) for one in facets.values() for rows in one)
    return FileMesh(points=points, node_numbers=numbers, blocks=blocks, groups=groups, facets=facets, flat=flat)


def _none() -> Index:
    return np.zeros(0, dtype=np.int64)
