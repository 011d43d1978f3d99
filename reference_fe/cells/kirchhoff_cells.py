"""Cells of St. Venant-Kirchhoff material by the compiled loops of `cells.kernels`.

Verified by tests/verification/test_fe_cells.py against the UFL forms.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe import dolfinx_api as api
from reference_fe.cells import kernels as cell_kernels
from reference_fe.cells.block_matrix import BlockRows, Places
from reference_fe.cells.cell_group import cell_dofs, inverse_jacobians, reference_gradients
from reference_fe.problem.domain import Domain

__all__ = ["KirchhoffCells"]

Array = NDArray[np.float64]


class KirchhoffCells:
    """A `CellGroup` of St. Venant-Kirchhoff material.

    Parameters
    ----------
    domain : mesh with tags
    V : displacement space of scalar functions times three, Lagrange or serendipity
    cells : (n_cells,) local numbers
    moduli : (n_cells, 3) lambda, mu and thermal stress offset of each, see `hyperelastic.thermal_moduli` [Pa]
    gauss_points : Gauss points along the cell's local axes
    """

    def __init__(
        self, domain: Domain, V: api.Expr, cells: NDArray[np.int32], moduli: Array, gauss_points: tuple[int, ...]
    ) -> None:
        self._moduli = moduli
        self.nodes = V.dofmap.list[cells]
        self._dofs = cell_dofs(self.nodes)
        points, weights = api.gauss_rule(gauss_points)
        self._shape = reference_gradients(V, points)
        self._inverse, volume = inverse_jacobians(domain, cells, points)
        self._weights = weights * volume
        self._stress = np.zeros((*self._weights.shape, 3, 3))

    def add_force(self, u: Array, out: Array) -> None:
        """See `CellGroup`."""
        cell_kernels.internal_force(u, self._shape, self._inverse, self._weights, self._moduli, self._dofs, out)

    def store_stress(self, u: Array, du: Array) -> None:
        """See `CellGroup`."""
        cell_kernels.point_stress(u, du, self._shape, self._inverse, self._moduli, self._dofs, self._stress)

    def add_tangent(self, u: Array, rows: BlockRows, places: Places, values: Array) -> None:
        """See `CellGroup`."""
        tables = (self._shape, self._inverse, self._weights, self._moduli, self._dofs, rows, places, values)
        cell_kernels.add_tangent(u, self._stress, *tables)
