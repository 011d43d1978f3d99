"""The ANCF reference node: mesh nodes tied linearly to one node's 12 coordinates (thesis eq. 2.20, signs mended)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.plates.mesh import PlateMesh
from contracts.errors import InputError

__all__ = ["ReferenceNodeTie", "rigid_reference_node", "tie_reference_node"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceNodeTie:
    """Constant map from free nodes and the reference node to all nodes: dependent coordinates are gone beforehand.

    Attributes
    ----------
    tied : (n_tied,) int, nodes that follow the reference node
    free : (n_free,) int, all others
    map : (n_tied, 4, 4) float [m, -]; coordinates of a tied node = map @ coordinates of the reference node
    origin : (3,) float [m], position of the reference node in the reference configuration

    Verified by tests/unit/test_ancf_reference_node.py.
    """

    tied: IntArray
    free: IntArray
    map: FloatArray
    origin: FloatArray

    def expand(self, free: FloatArray, reference: FloatArray) -> FloatArray:
        """All node coordinates from the independent ones.

        Parameters
        ----------
        free : (n_free, 4, 3) float [m, -]
        reference : (4, 3) float [m, -], (r, r_x, r_y, r_z) of the reference node

        Returns
        -------
        coordinates : (n_nodes, 4, 3) float [m, -]
        """
        p = np.empty((len(self.free) + len(self.tied), 4, 3))
        p[self.free] = free
        p[self.tied] = self.map @ reference
        return p

    def reference_force(self, force: FloatArray) -> FloatArray:
        """Generalised force on the reference node, (4, 3) float [N, N m], from forces (n_nodes, 4, 3) on the mesh.

        Row 0 is the resultant force; rows 1 to 3 are conjugate to the gradients r_x, r_y, r_z.
        """
        total: FloatArray = np.einsum("nab,nai->bi", self.map, force[self.tied])
        return total


def rigid_reference_node(position: FloatArray, rotation: FloatArray) -> FloatArray:
    """Coordinates (4, 3) of a reference node that moves with a rigid body: r = R, gradients = columns of ``rotation``.

    Parameters
    ----------
    position : (3,) float [m], origin of the reference node
    rotation : (3, 3) float [-], body to structure frame
    """
    return np.vstack([position, rotation.T])


def tie_reference_node(
    mesh: PlateMesh, nodes: Sequence[int] | IntArray, origin: FloatArray, gradients: FloatArray | None = None
) -> ReferenceNodeTie:
    """Tie nodes to a reference node: r^k - r^r = x r_x + y r_y + z r_z, [r_x r_y r_z]^k = [r_x r_y r_z]^r J^kr.

    Parameters
    ----------
    mesh : plates in their reference configuration
    nodes : nodes to tie
    origin : (3,) float [m], the reference node's position
    gradients : (n_tied, 3, 3) float [-], J^kr; identity by default, which is right for structure coordinates p (a
        plate's own gradients e = T p then follow with J^kr = its J0)

    Raises
    ------
    InputError
        For node numbers out of range or given twice.

    Verified by tests/unit/test_ancf_reference_node.py.
    """
    tied = np.asarray(nodes, dtype=np.int64)
    if not len(tied) or len(np.unique(tied)) != len(tied) or tied.min() < 0 or tied.max() >= len(mesh.points):
        rule = f"must be different numbers in 0..{len(mesh.points) - 1}"
        raise InputError("tied nodes", tied.tolist(), rule, "give the hub nodes of the mesh")
    J = np.repeat(np.eye(3)[None], len(tied), axis=0) if gradients is None else gradients
    tie = np.zeros((len(tied), 4, 4))
    tie[:, 0, 0] = 1.0
    tie[:, 0, 1:] = mesh.points[tied] - origin
    tie[:, 1:, 1:] = np.swapaxes(J, 1, 2)
    free = np.setdiff1d(np.arange(len(mesh.points), dtype=np.int64), tied)
    return ReferenceNodeTie(tied=tied, free=free, map=tie, origin=np.asarray(origin, dtype=np.float64))
