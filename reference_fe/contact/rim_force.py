"""Force between springs and rim at states that were solved before.

Verified by tests/unit/test_fe_rim_force.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from reference_fe import dolfinx_api as api
from reference_fe.contact.inner import InnerContact
from reference_fe.contact.inner_pairs import wheel_contact_pairs
from reference_fe.problem.domain import Domain

__all__ = ["RimForce"]

_RIM = "tire_inner"


class RimForce:
    """Springs on the rim of one mesh, whose displacements are given.

    Parameters
    ----------
    mesh : a wheel or half of it
    stiffness : penalty of the runs that found the displacements [N/m^3]
    """

    def __init__(self, mesh: TaggedMesh, stiffness: float) -> None:
        domain = Domain.from_tagged(mesh)
        V = api.fem.functionspace(domain.mesh, ("Lagrange", mesh.order, (mesh.dim,)))
        self._node = np.empty(V.dofmap.index_map.size_local, dtype=np.int64)
        self._node[V.dofmap.list] = domain.mesh.geometry.input_global_indices[api.cell_nodes(domain.mesh)]
        pairs = tuple(pair for pair in wheel_contact_pairs(mesh) if pair.master == _RIM)
        self._term = InnerContact(pairs=pairs, stiffness=stiffness).build(domain, V) if pairs else None
        self._slave, self._sides = mesh.facets.shape[1], 2.0 if "symmetry" in mesh.faces else 1.0

    def __call__(self, displacement: NDArray[np.float64]) -> float:
        """Sum of the sizes of the forces of all contact points, of the whole wheel [N].

        displacement : of the mesh's points (n_points, dim) [m]
        """
        if self._term is None:
            return 0.0
        found = self._term.evaluate(np.ascontiguousarray(displacement[self._node]).ravel(), 0.0)
        on_springs = found.force[:, : self._slave].sum(axis=1)
        return self._sides * float(np.linalg.norm(on_springs, axis=1).sum())
