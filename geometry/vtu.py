"""VTU export for ParaView and PyVista. The only module that imports meshio, and only when a file is written or read.

Verified by tests/unit/test_geometry_files.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from contracts.mesh import TaggedMesh
from geometry.hexahedra import VTK_FROM_GMSH

__all__ = ["meshio_module", "write_vtu"]


def meshio_module() -> Any:
    """The library."""
    import meshio  # type: ignore[import-untyped]

    return meshio


def write_vtu(mesh: TaggedMesh, path: Path) -> None:
    """Write the cells with the cell data ``"part"`` (the tag in ``mesh.parts``); 27-node cells in VTK's node order.

    Parameters
    ----------
    mesh : the mesh
    path : file to write (``.vtu``); its folder is made if needed
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    kind, order = ("hexahedron", range(8)) if mesh.order == 1 else ("hexahedron27", VTK_FROM_GMSH)
    cells = [(kind, mesh.cells[:, list(order)])]
    meshio_module().write_points_cells(str(path), mesh.points, cells, cell_data={"part": [mesh.cell_tags]})
