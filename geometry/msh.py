"""MSH export with parts and face groups as named physical groups.

Verified by tests/unit/test_geometry_files.py.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contracts.mesh import TaggedMesh
from geometry.gmsh_session import gmsh_session
from geometry.written import check_written

__all__ = ["write_msh"]

_KINDS = {4: 3, 9: 10, 8: 5, 27: 12}


def write_msh(mesh: TaggedMesh, path: Path) -> None:
    """Write a gmsh 4.1 file: each part a physical volume, each face group a physical surface, both by name.

    Parameters
    ----------
    mesh : the mesh
    path : file to write (``.msh``); its folder is made if needed

    Raises
    ------
    OSError
        If the disk is full; gmsh itself would leave a file cut off, and not say so.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    groups = [(2, tag, name, mesh.facets[mesh.facet_tags == tag]) for name, tag in mesh.faces.items()] + [
        (3, tag, name, mesh.cells[mesh.cell_tags == tag]) for name, tag in mesh.parts.items()
    ]
    first = 1
    with gmsh_session("export") as gmsh:
        for dim, tag, name, _ in groups:
            gmsh.model.addDiscreteEntity(dim, tag)
            gmsh.model.addPhysicalGroup(dim, [tag], tag, name=name)
        numbers = np.arange(1, len(mesh.points) + 1)
        gmsh.model.mesh.addNodes(3, groups[-1][1], numbers, mesh.points.ravel())
        for _, tag, _, nodes in groups:
            elements = np.arange(first, first + len(nodes))
            gmsh.model.mesh.addElementsByType(tag, _KINDS[nodes.shape[1]], elements, (nodes + 1).ravel())
            first += len(nodes)
        gmsh.model.mesh.reclassifyNodes()
        gmsh.write(str(path))
    check_written(path, b"$EndElements")
