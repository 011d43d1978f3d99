"""Networks of ANCF plates: patches in, shared nodes and the structure-frame transform T out.

Node coordinates live in one structure frame, p = (r, r_X, r_Y, r_Z); the coordinates of plate j are e = T p (thesis eq.
2.17) with r_xi = sum_k r_Xk J0[k, i] at each node. Plates that meet at a node at any angle (T- and V-sections) then
share its 12 coordinates, so thesis eqs. 2.18 and 2.19 hold by assembly and need no constraint equations.
Limitation: at a corner one plate's director is the other's tangent, so a moment passes only by shear strain of the
plates next to the node, and the corner's rotational stiffness falls in proportion to their length. Keep plates at
corners no shorter than they are thick (tests/verification/test_ancf_arch.py measures it).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from contracts.errors import InputError, MeshError

__all__ = ["PlateMesh", "PlatePatch", "build_plate_mesh", "flat_patch", "join_meshes"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class PlatePatch:
    """One plate in its stress-free reference configuration.

    Attributes
    ----------
    corners : (4, 3) float [m], mid-surface position of the nodes (0, 0), (a, 0), (a, b), (0, b)
    gradients : (4, 3, 3) float [-], J0 at the nodes; column i is dX/dx_{i+1}; positive determinant
    dimensions : (3,) float [m], length a, width b and thickness t of the straight configuration
    part : name, e.g. ``"spoke"``

    Raises
    ------
    InputError
        For wrong shapes, values that are not finite, dimensions not above zero, or a J0 with det J0 <= 0.
    """

    corners: FloatArray
    gradients: FloatArray
    dimensions: FloatArray
    part: str

    def __post_init__(self) -> None:
        shapes = (self.corners.shape, self.gradients.shape, self.dimensions.shape)
        if shapes != ((4, 3), (4, 3, 3), (3,)):
            raise InputError(f"patch {self.part}", shapes, "needs shapes (4, 3), (4, 3, 3), (3,)", "check the arrays")
        if not all(np.all(np.isfinite(x)) for x in (self.corners, self.gradients, self.dimensions)):
            raise InputError(f"patch {self.part}", "NaN or infinity", "must be finite", "check the geometry")
        if np.any(self.dimensions <= 0.0):
            raise InputError(
                f"patch {self.part}: length, width, thickness",
                f"{self.dimensions} m",
                "must be greater than zero",
                "give the straight configuration's dimensions",
            )
        if np.any(np.linalg.det(self.gradients) <= 0.0):
            raise InputError(
                f"patch {self.part}: det J0",
                f"{np.linalg.det(self.gradients)}",
                "must be greater than zero at every node",
                "make x1, x2 and the director x3 right-handed",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class PlateMesh:
    """Plates with shared nodes, in the stress-free reference configuration.

    Attributes
    ----------
    points : (n_nodes, 3) float [m]
    elements : (n_plates, 4) int, nodes of each plate
    gradients : (n_plates, 4, 3, 3) float [-], J0 of each plate at its nodes, columns dX/dx_i
    dimensions : (n_plates, 3) float [m], a, b, t
    parts : part name of each plate

    Verified by tests/unit/test_ancf_plate_mesh.py.
    """

    points: FloatArray
    elements: NDArray[np.int64]
    gradients: FloatArray
    dimensions: FloatArray
    parts: tuple[str, ...]

    @property
    def transform(self) -> FloatArray:
        """Structure-frame transform T of each plate (thesis eq. 2.17), (n_plates, 16, 16) float [-].

        It acts on coordinate vectors, so the thesis' 48 x 48 matrix is T kron I. Not orthogonal in general.
        """
        T = np.zeros((len(self.elements), 16, 16))
        for k in range(4):
            T[:, 4 * k, 4 * k] = 1.0
            T[:, 4 * k + 1 : 4 * k + 4, 4 * k + 1 : 4 * k + 4] = np.swapaxes(self.gradients[:, k], 1, 2)
        return T

    def reference_coordinates(self) -> FloatArray:
        """Coordinates p of the stress-free mesh, (n_nodes, 4, 3) float [m, -]: r = X, (r_X, r_Y, r_Z) = I."""
        p = np.empty((len(self.points), 4, 3))
        p[:, 0] = self.points
        p[:, 1:] = np.eye(3)
        return p

    def element_coordinates(self, coordinates: FloatArray) -> FloatArray:
        """Plate coordinates e = T p (thesis eq. 2.17).

        Parameters
        ----------
        coordinates : (n_nodes, 4, 3) float [m, -], structure coordinates p

        Returns
        -------
        e : (n_plates, 16, 3) float [m, -], per node r, r_x1, r_x2, r_x3 (thesis eqs. 2.14, 2.15)
        """
        return self.transform @ coordinates[self.elements].reshape(len(self.elements), 16, 3)

    def normalised(self, coordinates: FloatArray, frame: FloatArray) -> FloatArray:
        """Plate coordinates with the lengths a, b, t in the gradients: per node r, r_xi1, r_xi2, r_xi3.

        Parameters
        ----------
        coordinates : (n_nodes, 4, 3) float [m, -], structure coordinates p
        frame : (n_plates, 4, 3, 3) float [m], J0 diag(a, b, t) at the nodes

        Returns
        -------
        e : (n_plates, 16, 3) float [m]
        """
        p = coordinates[self.elements]
        e = np.concatenate([p[:, :, :1], np.swapaxes(frame, 2, 3) @ p[:, :, 1:]], axis=2)
        return e.reshape(len(self.elements), 16, 3)

    def in_structure_coordinates(self, shape: FloatArray, frame: FloatArray) -> FloatArray:
        """Normalised shape functions (n_plates, n_points, 16) as functions of structure coordinates, T folded in.

        ``shape`` may be the same for all plates, (1, n_points, 16).
        """
        s = np.broadcast_to(shape, (len(self.elements), *shape.shape[1:])).reshape(len(self.elements), -1, 4, 4)
        gradients = np.einsum("jnkm,jqnm->jqnk", frame, s[..., 1:], optimize=True)
        return np.concatenate([s[..., :1], gradients], axis=-1).reshape(len(self.elements), -1, 16)

    def plates_of(self, part: str) -> NDArray[np.int64]:
        """Numbers (n,) of the plates of one part; raises InputError if there is none."""
        found = np.array([j for j, name in enumerate(self.parts) if name == part], dtype=np.int64)
        if not len(found):
            raise InputError("part", part, f"is not in the mesh ({sorted(set(self.parts))})", "check the name")
        return found


def build_plate_mesh(patches: Sequence[PlatePatch], tolerance: float = 1e-9) -> PlateMesh:
    """Join patches at corners that coincide.

    Parameters
    ----------
    patches : plates in any order and orientation
    tolerance : corners closer than this share a node [m]

    Raises
    ------
    MeshError
        If there is no patch, or two corners of one patch fall together.

    Verified by tests/unit/test_ancf_plate_mesh.py.
    """
    if not patches:
        raise MeshError("a plate mesh needs one patch or more: give at least one PlatePatch")
    corners = np.concatenate([patch.corners for patch in patches])
    pairs = cKDTree(corners).query_pairs(tolerance, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(corners), len(corners)))
    _, group = connected_components(links, directed=False)
    _, first, node = np.unique(group, return_index=True, return_inverse=True)
    order = np.argsort(first)  # nodes are numbered as they first appear
    elements = np.argsort(order)[node].reshape(-1, 4)
    for j, patch in enumerate(patches):
        if len(set(elements[j].tolist())) < 4:
            raise MeshError(f"patch {j} ({patch.part}) has corners closer than {tolerance:g} m: lower the tolerance")
    return PlateMesh(
        points=corners[first[order]],
        elements=elements,
        gradients=np.array([patch.gradients for patch in patches]),
        dimensions=np.array([patch.dimensions for patch in patches]),
        parts=tuple(patch.part for patch in patches),
    )


def join_meshes(meshes: Sequence[PlateMesh]) -> PlateMesh:
    """Several meshes as one, e.g. a rover's six wheels; nothing is shared between them, wherever they lie.

    Nodes and plates keep their order, those of the first mesh first. `vector_coordinates.side_by_side` joins what holds
    them in the same order.

    Raises
    ------
    MeshError
        If there is no mesh.

    Verified by tests/verification/test_ancf_six_wheels.py.
    """
    if not meshes:
        raise MeshError("joining needs one mesh or more: give at least one PlateMesh")
    starts = np.cumsum([0, *(len(mesh.points) for mesh in meshes[:-1])])
    return PlateMesh(
        points=np.concatenate([mesh.points for mesh in meshes]),
        elements=np.concatenate([mesh.elements + start for mesh, start in zip(meshes, starts, strict=True)]),
        gradients=np.concatenate([mesh.gradients for mesh in meshes]),
        dimensions=np.concatenate([mesh.dimensions for mesh in meshes]),
        parts=tuple(part for mesh in meshes for part in mesh.parts),
    )


def flat_patch(origin: FloatArray, along: FloatArray, across: FloatArray, thickness: float, part: str) -> PlatePatch:
    """Flat rectangular plate with unit gradients.

    Parameters
    ----------
    origin : (3,) float [m], node (0, 0)
    along, across : (3,) float [m], edges from there to (a, 0) and to (0, b), at right angles; x3 = along x across
    thickness : t [m]
    part : part name
    """
    a, b = float(np.linalg.norm(along)), float(np.linalg.norm(across))
    if abs(float(along @ across)) > 1e-9 * a * b:
        raise InputError(f"patch {part}: edges", f"{along}, {across}", "must be at right angles", "give a rectangle")
    frame = np.column_stack([along / a, across / b, np.cross(along, across) / (a * b)])
    return PlatePatch(
        corners=np.array([origin, origin + along, origin + along + across, origin + across]),
        gradients=np.repeat(frame[None], 4, axis=0),
        dimensions=np.array([a, b, thickness]),
        part=part,
    )
