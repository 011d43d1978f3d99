"""Input deck of nodes, 20-node hexahedra and sets, as CalculiX and other codes of that format read it.

Verified by tests/unit/test_geometry_files.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.mesh import TaggedMesh

__all__ = ["TWENTY_NODES", "write_inp"]

TWENTY_NODES = (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)
"""Places, among gmsh's 27 nodes, of the 20-node hexahedron's: vertices, then bottom, top and upright edges."""


def write_inp(
    mesh: TaggedMesh, path: Path, *, element: str = "C3D20R", node_sets: Mapping[str, NDArray[np.int64]] | None = None
) -> None:
    """Write the mesh as 20-node hexahedra: an element set for each part, a node set for each face group.

    Nodes keep their number plus one; those in the middle of faces and cells, which 20-node hexahedra do not have, are
    left out. Names are written in capitals, coordinates [m] with 13 digits.

    Parameters
    ----------
    mesh : 27-node hexahedra
    path : file to write (``.inp``); its folder is made if needed
    element : type of the elements, C3D20 or C3D20R
    node_sets : further node sets by name, (n,) int each, node numbers of the mesh from 0

    Raises
    ------
    InputError
        For a mesh of 8-node hexahedra.
    """
    if mesh.order != 2:
        raise InputError("mesh order", mesh.order, "must be 2 for 20-node hexahedra", "mesh with order = 2")
    cells = mesh.cells[:, TWENTY_NODES]
    used = np.unique(cells)
    faces = {name: np.unique(mesh.facets[mesh.facet_tags == tag]) for name, tag in mesh.faces.items()}
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        file.write("*NODE, NSET=ALL_NODES\n")
        rows = zip((used + 1).tolist(), mesh.points[used].tolist(), strict=True)
        file.writelines(f"{n}, {x:.12e}, {y:.12e}, {z:.12e}\n" for n, (x, y, z) in rows)
        for part, tag in mesh.parts.items():
            file.write(f"*ELEMENT, TYPE={element}, ELSET={part.upper()}\n")
            for number in np.flatnonzero(mesh.cell_tags == tag).tolist():
                file.writelines(_lines([number + 1, *(cells[number] + 1).tolist()], more=","))
        for name, nodes in (faces | dict(node_sets or {})).items():
            file.write(f"*NSET, NSET={name.upper()}\n")
            file.writelines(_lines((np.intersect1d(nodes, used) + 1).tolist()))


def _lines(numbers: list[int], more: str = "") -> Iterator[str]:
    """Ten numbers a line; ``more`` ends each line but the last, which is how a long element goes on."""
    for first in range(0, len(numbers), 10):
        last = first + 10 >= len(numbers)
        yield ", ".join(str(n) for n in numbers[first : first + 10]) + ("" if last else more) + "\n"
