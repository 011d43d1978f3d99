"""Deformable cells assembled by compiled loops, whatever their law.

Each process assembles its own cells into its own CSR matrix. On one process PETSc shares the values: assembling writes
them in place and nothing is copied. On several, rows of nodes that belong to a neighbour are sent there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.cells import kernels as cell_kernels
from reference_fe.cells.cell_group import CellGroup
from reference_fe.contact.surface_assembly import SurfaceAssembly
from reference_fe.solver import process_sums

__all__ = ["CompiledCells"]


class CompiledCells:
    """Residual, tangent and stored stress of the deformable cells.

    Parameters
    ----------
    V : displacement space of scalar functions times three, Lagrange or serendipity
    groups : the cells, by the loops that assemble them

    Verified by tests/verification/test_fe_cells.py against the UFL forms.
    """

    def __init__(self, V: api.Expr, groups: Sequence[CellGroup]) -> None:
        self._V, self._groups = V, tuple(groups)
        self._force = api.fem.Function(V)

    def internal_force(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """int S(E(u)) : DE(u)[v] dV, (n_own_dofs,) [N]; u (n_dofs,) [m], neighbours' nodes included."""
        out = self._force.x.array
        out[:] = 0.0
        for group in self._groups:
            group.add_force(u, out)
        return process_sums.sum_shared(self._force)

    def store_stress(self, u: NDArray[np.float64], du: NDArray[np.float64]) -> None:
        """Store S(E(u)) + CC : DE(u)[du] at the Gauss points."""
        for group in self._groups:
            group.store_stress(u, du)

    def prepare_matrix(self, supported: NDArray[np.int32], surfaces: SurfaceAssembly) -> None:
        """Lay out the matrix: pattern, place of each cell's blocks, entries that the supports fix.

        supported : (n,) int, held unknowns this process knows, in its own numbers
        surfaces : couple further groups of nodes, with room for a full block each
        """
        coupled = [*(nodes for group in self._groups for nodes in group.nodes), *surfaces.couplings()]
        self._csr = api.cell_matrix(self._V, coupled, np.unique(supported // 3).astype(np.int32))
        indptr, indices = self._csr.indptr, self._csr.indices
        self._indptr = np.ascontiguousarray(indptr, dtype=np.int32)
        self._indices = np.ascontiguousarray(indices, dtype=np.int32)
        held = np.zeros(len(indptr) - 1, dtype=bool)
        held[supported] = True
        self._fixed = np.flatnonzero(np.repeat(held, np.diff(indptr)) | held[indices])
        own = supported[supported < 3 * self._V.dofmap.index_map.size_local]
        self._fixed_diagonal = cell_kernels.diagonal_places(own, self._indptr, self._indices)
        places = cell_kernels.block_places
        self._blocks = [places(group.nodes, self._indptr, self._indices) for group in self._groups]
        self._whole = surfaces.whole
        if api.COMM.size == 1:
            self._matrix = api.shared_matrix(self._csr)
        else:
            far = surfaces.whole.lay_out(surfaces.whole_couplings(), supported) if surfaces.whole else None
            self._matrix = api.distributed_matrix(self._csr, self._V, far)

    def assemble(self, u: NDArray[np.float64], boundary: api.Expr, surfaces: SurfaceAssembly) -> None:
        """Fill the matrix [N/m]: cells' tangent at u with the stored stress, plus a boundary form (or None), surfaces.

        u : (n_dofs,) [m], neighbours' nodes included
        """
        self._csr.data[:] = 0.0
        if boundary is not None:
            api.fem.assemble_matrix(self._csr, boundary)
        for group, blocks in zip(self._groups, self._blocks, strict=True):
            group.add_tangent(u, self._indptr, blocks, self._csr.data)
        surfaces.add_to_csr(self._indptr, self._indices, self._csr.data)

    def supported_matrix(self) -> api.PETSc.Mat:
        """The assembled matrix with unit rows and zero columns at supported unknowns; one object for each pattern."""
        self._csr.data[self._fixed] = 0.0
        self._csr.data[self._fixed_diagonal] = 1.0
        self._hand_over(supported=True)
        return self._matrix

    def copied_matrix(self) -> api.PETSc.Mat:
        """The assembled matrix as it stands, as a new PETSc matrix."""
        self._hand_over(supported=False)
        return self._matrix.copy()

    def _hand_over(self, *, supported: bool) -> None:
        """Make PETSc see the values of the CSR matrices."""
        if api.COMM.size == 1:
            self._matrix.stateIncrease()
        else:
            far = np.zeros(0) if self._whole is None else self._whole.own_stiffness(supported=supported)
            api.distributed_values(self._matrix, np.concatenate([self._csr.data, far]))
