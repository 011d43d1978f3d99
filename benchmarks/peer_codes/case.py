"""A load case that three codes can solve: some nodes held, one line of nodes driven in equal steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contracts.materials import TI_6AL_4V, Material
from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.inp import TWENTY_NODES
from geometry.wheel import exomars_hoops
from reference_fe.cells.orientation import curved_axis_first
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["FRONT", "REAR", "TOLERANCE", "Description", "LoadCase", "from_description", "half_cylinder", "wheel"]

type Description = tuple[str, float, float]
"""A builder's name and its two numbers: cells around and across, or element sizes along strips and the axle [m]."""

TOLERANCE = 1e-6
"""Largest out-of-balance force of a converged state over the forces at supports, in all codes."""
FRONT, REAR = "line_front", "line_rear"


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadCase:
    """One mesh with its load; the driven line is where the faces ``line_front`` and ``line_rear`` meet.

    Attributes
    ----------
    mesh : 27-node hexahedra; peers use 20 of the nodes
    material : of every part
    held_faces, held_parts : held in all three directions
    symmetry : face held along y, or None
    component, travel : direction of the driven line's motion and its full length [m]
    steps : increments wanted, of equal length
    force_factor : force of the whole body over that of the model, signed so that a pressing force is positive
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


def half_cylinder(around: int, across: int) -> LoadCase:
    """Clamped half cylinder, R 140 mm, t 2 mm, W 100 mm, its outer crown line pressed down by 20 mm.

    Source: contracts/published/halfcyl_crown_reaction.csv.
    """

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = np.pi * X[:, 0], 0.140 + 0.002 * (X[:, 2] - 0.5)
        return np.column_stack([r * np.cos(angle), r * np.sin(angle), 0.1 * X[:, 1]])

    mesh = block_mesh((around, across, 1), mapping)
    steel = replace(TI_6AL_4V, name="steel", young_modulus=2.1e11, poisson_ratio=0.3)
    return LoadCase(
        mesh=_split(mesh, "z1", lambda x: x[:, 1] > 0.0),
        material=steel,
        held_faces=("x0", "x1"),
        held_parts=(),
        symmetry=None,
        component=1,
        travel=-0.020,
        steps=4,
        force_factor=-1.0,
    )


def wheel(element_size: float, axial_size: float, orientation_deg: float = 30.0) -> LoadCase:
    """Half the ExoMars wheel, hub held, on the front lower edge of the grouser at ``orientation_deg``, raised by 20 mm.

    The edge stands for the ground: every mesh has it at the same place, and no code needs contact to press on it.
    """
    mesh = build_mesh(exomars_hoops(), element_size=element_size, axial_size=axial_size, parts="flexible")
    mesh = curved_axis_first(mesh, straight=np.array([0.0, 1.0, 0.0]))
    mesh = _turn(mesh, np.deg2rad(orientation_deg))
    foot = 0.5 * exomars_hoops().grousers.thickness
    mesh = _split(mesh, "grouser_outer", lambda x: (x[:, 2] < 0.0) & (np.abs(x[:, 0]) < 1.001 * foot))
    return LoadCase(
        mesh=mesh,
        material=TI_6AL_4V,
        held_faces=(),
        held_parts=("outer_hub",),
        symmetry="symmetry",
        component=2,
        travel=0.020,
        steps=4,
        force_factor=2.0,
    )


def _turn(mesh: TaggedMesh, angle: float) -> TaggedMesh:
    """Turn about the y axis so that what stood at ``angle`` from -z towards x comes to stand at -z."""
    c, s = np.cos(angle), np.sin(angle)
    return replace(mesh, points=mesh.points @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T)


def _split(mesh: TaggedMesh, face: str, part: Callable[[NDArray[np.float64]], NDArray[np.bool_]]) -> TaggedMesh:
    """Rename the facets of ``face`` whose middle fulfils ``part``: ``line_front`` at x > 0, else ``line_rear``."""
    middle = mesh.points[mesh.facets].mean(axis=1)
    mine = (mesh.facet_tags == mesh.faces[face]) & part(middle)
    first = max(mesh.faces.values()) + 1
    tags = np.where(mine, np.where(middle[:, 0] > 0.0, first, first + 1), mesh.facet_tags).astype(np.int32)
    return replace(mesh, facet_tags=tags, faces=dict(mesh.faces) | {FRONT: first, REAR: first + 1})


def from_description(description: Description) -> LoadCase:
    """The case from its builder's name and arguments."""
    name, *arguments = description
    build: Callable[..., LoadCase] = {"half_cylinder": half_cylinder, "wheel": wheel}[name]
    return build(*arguments)
