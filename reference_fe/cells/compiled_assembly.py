"""Deformable cells assembled by compiled loops, whatever their law.

Each process assembles its own cells into its own matrix, see `cells.block_matrix`. On one process PETSc shares the
values: assembling writes them in place and nothing is copied; of a symmetric tangent there is the upper triangle alone.
On several, rows of nodes that belong to a neighbour are sent there.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.cells import block_matrix
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
        self._matrix: api.PETSc.Mat | None = None
        self._values = np.zeros(0)

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

    def prepare_matrix(self, supported: NDArray[np.int32], surfaces: SurfaceAssembly, boundary: api.Expr) -> None:
        """Lay out the matrix: pattern, place of each cell's blocks, entries that the supports fix.

        supported : (n,) int, held unknowns this process knows, in its own numbers
        surfaces : couple further groups of nodes, with room for a full block each
        boundary : a bilinear form on facets, or None
        """
        self._release_matrix()
        nodes = self._V.dofmap.index_map
        n_nodes = nodes.size_local + nodes.num_ghosts
        cells = [group.nodes for group in self._groups]
        coupled = [*cells, *surfaces.couplings()]
        one = api.COMM.size == 1
        self._rows = block_matrix.block_rows(n_nodes, coupled, upper=one and surfaces.symmetric)
        self._places = [block_matrix.block_places(group, self._rows) for group in cells]
        self._held = np.zeros(3 * n_nodes, dtype=bool)
        self._held[supported] = True
        self._boundary = None if boundary is None else api.cell_matrix(self._V, [row for g in cells for row in g])
        self._whole = surfaces.whole
        pattern = block_matrix.scalar_csr(self._rows, np.zeros(0, dtype=api.PETSc.IntType))
        if self._rows.upper:
            self._matrix, self._values = api.triangular_matrix(*pattern)
            return
        self._values = np.zeros(self._rows.entries)
        if one:
            self._matrix = api.shared_matrix(*pattern, self._values)
        else:
            far = surfaces.whole.lay_out(surfaces.whole_couplings(), supported) if surfaces.whole else None
            self._matrix = api.distributed_matrix(*pattern, self._V, far)

    def assemble(self, u: NDArray[np.float64], boundary: api.Expr, surfaces: SurfaceAssembly) -> None:
        """Fill the matrix [N/m]: cells' tangent at u with the stored stress, plus a boundary form (or None), surfaces.

        u : (n_dofs,) [m], neighbours' nodes included
        """
        self._values[:] = 0.0
        if self._boundary is not None:
            csr = self._boundary
            csr.data[:] = 0.0
            api.fem.assemble_matrix(csr, boundary)
            block_matrix.add_csr(self._rows, csr.indptr, csr.indices, csr.data, self._values)
        for group, places in zip(self._groups, self._places, strict=True):
            group.add_tangent(u, self._rows, places, self._values)
        surfaces.add_to_rows(self._rows, self._values)

    def supported_matrix(self) -> api.PETSc.Mat:
        """The assembled matrix with unit rows and zero columns at supported unknowns; one object for each pattern."""
        block_matrix.hold(self._rows, self._held, 3 * self._V.dofmap.index_map.size_local, self._values)
        return self._handed_over(supported=True)

    def product(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """The assembled matrix as it stands times x, both (n_own_dofs,)."""
        if api.COMM.size == 1:
            return block_matrix.product(self._rows, self._values, x)
        return api.matrix_product(self._handed_over(supported=False), x)

    def copied_matrix(self) -> api.PETSc.Mat:
        """The assembled matrix as it stands, all of it, as a new PETSc matrix."""
        matrix = self._handed_over(supported=False)
        return matrix.convert("aij", out=api.PETSc.Mat()) if self._rows.upper else matrix.copy()

    def _release_matrix(self) -> None:
        """Forget the last matrix before there is another; who factorised it has let go of it."""
        if self._matrix is not None:
            self._matrix.destroy()
            self._matrix, self._values = None, np.zeros(0)

    def _handed_over(self, *, supported: bool) -> api.PETSc.Mat:
        """The matrix, once PETSc has seen the values."""
        assert self._matrix is not None
        if api.COMM.size == 1:
            self._matrix.stateIncrease()
        else:
            far = np.zeros(0) if self._whole is None else self._whole.own_stiffness(supported=supported)
            api.distributed_values(self._matrix, np.concatenate([self._values, far]))
        return self._matrix
