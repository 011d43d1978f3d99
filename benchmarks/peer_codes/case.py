"""A load case that three codes can solve: nodes held, and a line of nodes driven or a plane raised in equal steps.

Made in one process (`built_cases`) and read by those that solve it, so that no mesher is in the memory measured.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contracts.materials import Material
from contracts.mesh import TaggedMesh
from geometry.inp import TWENTY_NODES
from workbench.questions.wheel.mesh_file import read_mesh, write_mesh

__all__ = ["FRONT", "REAR", "TOLERANCE", "Description", "LoadCase", "read_case", "write_case"]

type Description = tuple[str, float, float]
"""A builder's name and its two numbers: cells around and across, or element sizes along strips and the axle [m]."""

TOLERANCE = 1e-6
"""Largest out-of-balance force of a converged state over the forces at supports, in all codes."""
FRONT, REAR = "line_front", "line_rear"


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadCase:
    """One mesh with its load: a driven line, where the faces ``line_front`` and ``line_rear`` meet, or a raised plane.

    Attributes
    ----------
    mesh : 27-node hexahedra; peers use 20 of the nodes
    material : of every part
    held_faces, held_parts : held in all three directions
    symmetry : face held along y, or None
    component, travel : direction of the line's or the plane's motion and its full length [m]
    steps : increments wanted, of equal length
    force_factor : force of the whole body over that of the model, signed so that a pressing force is positive
    ground_faces : that may touch the plane; none where a line is driven
    ground_level : of the plane along the axis ``component`` at first touch [m]; the body lies above it
    ground_stiffness : penalty [N/m^3]
    """

    mesh: TaggedMesh
    material: Material
    held_faces: tuple[str, ...]
    held_parts: tuple[str, ...]
    symmetry: str | None
    component: int
    travel: float
    steps: int
    force_factor: float
    ground_faces: tuple[str, ...] = ()
    ground_level: float = 0.0
    ground_stiffness: float = 0.0

    def nodes_of_face(self, face: str) -> NDArray[np.int64]:
        """Nodes of a face group, ascending."""
        return np.unique(self.mesh.facets[self.mesh.facet_tags == self.mesh.faces[face]])

    def driven(self) -> NDArray[np.int64]:
        """Nodes of the driven line, ascending."""
        return np.intersect1d(self.nodes_of_face(FRONT), self.nodes_of_face(REAR))

    def held(self) -> NDArray[np.int64]:
        """Nodes held in all directions, ascending."""
        parts = [self.mesh.cells[self.mesh.cell_tags == self.mesh.parts[part]].ravel() for part in self.held_parts]
        return np.unique(np.concatenate([*parts, *(self.nodes_of_face(face) for face in self.held_faces)]))

    def twenty_node_unknowns(self) -> int:
        """Displacement unknowns of the mesh with 20-node hexahedra."""
        return 3 * len(np.unique(self.mesh.cells[:, TWENTY_NODES]))


def write_case(case: LoadCase, folder: Path) -> None:
    """Write the mesh and everything else."""
    folder.mkdir()
    write_mesh(case.mesh, folder / "mesh.npz")
    plain = {item.name: getattr(case, item.name) for item in fields(case) if item.name != "mesh"}
    (folder / "case.json").write_text(json.dumps(plain | {"material": asdict(case.material)}), encoding="utf-8")


def read_case(folder: Path) -> LoadCase:
    """Read what ``write_case`` wrote."""
    plain = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in plain.items()}
    return LoadCase(mesh=read_mesh(folder / "mesh.npz"), **values | {"material": Material(**plain["material"])})
