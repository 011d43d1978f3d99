"""Fields at one load as VTU, for ParaView and PyVista. The one module of the workbench that imports meshio.

Verified by tests/unit/test_workbench_tasks.py.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.hexahedra import VTK_FROM_GMSH

__all__ = ["write_fields"]


def write_fields(
    mesh: TaggedMesh, displacement: NDArray[np.float64], von_mises: NDArray[np.float64], path: Path
) -> None:
    """Write mesh, parts, displacement and stress; warp by ``displacement_m`` to see the deformed shape.

    Parameters
    ----------
    mesh : the mesh that was solved (half a width stays half)
    displacement : (n_points, 3) float [m]
    von_mises : (n_points,) float [Pa]
    path : ``.vtu`` file to write
    """
    import meshio  # type: ignore[import-untyped]

    kind, order = ("hexahedron", range(8)) if mesh.order == 1 else ("hexahedron27", VTK_FROM_GMSH)
    meshio.write_points_cells(
        str(path),
        mesh.points,
        [(kind, mesh.cells[:, list(order)])],
        point_data={"displacement_m": displacement, "von_mises_Pa": von_mises},
        cell_data={"part": [mesh.cell_tags]},
    )
