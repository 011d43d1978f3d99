"""How far one part of a body has passed through the inside of another: a measure of contact that is not modelled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from contracts.mesh import TaggedMesh
from reference_fe.contact.patch import contact_faces, facet_samples

__all__ = ["FaceOverlap"]


class FaceOverlap:
    """Depth of the nodes of some parts behind a named face, e.g. of a wheel's springs behind the rim's inner face.

    A node counts with its distance to the nearest sampled point of the face, along the face's normal there: negative
    (overlap) where the node lies behind. Nodes that belong to the face's own part, such as a weld's, are left out.

    Parameters
    ----------
    mesh : tagged mesh
    parts : parts whose nodes are followed
    face : face group; its facets' normal points to the side where the parts belong

    Verified by tests/unit/test_fe_overlap.py.
    """

    def __init__(self, mesh: TaggedMesh, parts: tuple[str, ...], face: str) -> None:
        self._mesh, self._facets = mesh, contact_faces(mesh, [face])
        tags = [mesh.parts[part] for part in parts]
        mine = np.isin(mesh.cell_tags, tags)
        others = np.unique(mesh.cells[~mine])
        self._nodes = np.setdiff1d(np.unique(mesh.cells[mine]), others)
        self._sign = 1.0
        if np.median(self._gaps_to_middles(mesh.points)) < 0.0:
            self._sign = -1.0

    def smallest_gap(self, displacement: NDArray[np.float64]) -> float:
        """Smallest signed distance between the nodes and the face [m]; negative is overlap.

        displacement : (n_points, dim) at the mesh's nodes [m]
        """
        current = self._mesh.points + displacement
        near = self._candidates(current)
        points, normals = facet_samples(current, self._facets)
        _, nearest = cKDTree(points).query(current[near])
        gap = np.einsum("ni,ni->n", normals[nearest], current[near] - points[nearest])
        return float(np.min(self._sign * gap))

    def _candidates(self, current: NDArray[np.float64]) -> NDArray[np.int64]:
        """Nodes whose gap to the nearest facet's middle exceeds the smallest such gap by one facet at most.

        The others cannot have the smallest gap; those near a rim's centre, which has no nearest sample, would make the
        search among all samples slow.
        """
        gap = self._gaps_to_middles(current)
        ends = current[self._facets[:, : 2 ** (self._mesh.dim - 1)]]
        opposite = len(ends[0]) // 2
        sizes = np.linalg.norm(ends[:, opposite:] - ends[:, :opposite], axis=-1)
        return self._nodes[gap <= gap.min() + sizes.max()]

    def _gaps_to_middles(self, current: NDArray[np.float64]) -> NDArray[np.float64]:
        """Signed distance of each node from the middle of its nearest facet, along that facet's normal [m]."""
        corners = current[self._facets[:, : 2 ** (self._mesh.dim - 1)]]
        middles = corners.mean(axis=1)
        if self._mesh.dim == 2:
            along = corners[:, 1] - corners[:, 0]
            normals = np.column_stack([along[:, 1], -along[:, 0]])
        else:
            normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        _, nearest = cKDTree(middles).query(current[self._nodes])
        offset = current[self._nodes] - middles[nearest]
        return np.asarray(self._sign * np.einsum("ni,ni->n", normals[nearest], offset))
