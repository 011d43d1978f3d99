"""Cells of any law by the compiled loops of `cells.general_kernels`, with the history of their points.

Nearly incompressible laws take the three-field form: dilatation and pressure are functions of the cell alone. Of 27
nodes they are, in the cell's own coordinates,

    rubber         1, xi, eta, zeta                         Q2/P1, which satisfies the inf-sup condition,
    J2 plasticity  with xi eta, eta zeta, zeta xi as well   whose bending stiffness is that of displacements alone,

and constant of fewer. What is lost and won by either: docs/theory/material_laws.md. Verified by
tests/verification/test_fe_laws_cells.py and tests/verification/test_fe_laws_locking.py.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contracts.material_laws import J2Plasticity, Law
from contracts.materials import Material
from reference_fe import dolfinx_api as api
from reference_fe.cells import general_kernels as loops
from reference_fe.cells import general_tangent
from reference_fe.cells.block_matrix import BlockRows, Places
from reference_fe.cells.cell_group import cell_dofs, gradients_at
from reference_fe.material.law_constants import law_constants
from reference_fe.material.point_response import VIRGIN
from reference_fe.material.principal_laws import J2, OGDEN, plastic_work
from reference_fe.problem.domain import Domain

__all__ = ["GeneralCells", "PointSet"]

Array = NDArray[np.float64]
Index = NDArray[np.int32]
_WHOLE_CELL = 27
"""Nodes of the cell whose pressure is more than a constant."""
_FUNCTIONS = {OGDEN: 4, J2: 7}
"""Functions of pressure in it, of each kind of law."""


class PointSet:
    """Material points in the cells of some parts, with their own history: what `GeneralCells` is made of.

    Parameters
    ----------
    domain, V : mesh with tags, displacement space
    materials, laws : of the parts, none of them St. Venant-Kirchhoff
    points : (m, 3) of the reference cell
    weights : (m,) of a quadrature rule at these points; zero where nothing is integrated

    Attributes
    ----------
    cells : (n_cells,) local numbers of the parts' cells, ascending
    past : (n_cells, m, 7) committed history, see `point_response.HISTORY`
    yields : whether a part's law has a history
    """

    def __init__(
        self,
        domain: Domain,
        V: api.Expr,
        materials: Mapping[str, Material],
        laws: Mapping[str, Law],
        points: Array,
        weights: Array,
    ) -> None:
        self.cells = domain.cells_of(laws)
        G, volume = gradients_at(domain, V, self.cells, points)
        kinds, constants = np.zeros(len(self.cells), dtype=np.int64), np.zeros((len(self.cells), 2))
        bulk, stretch = np.zeros(len(self.cells)), np.ones(len(self.cells))
        for part, law in laws.items():
            rows, law_of_part = (
                np.searchsorted(self.cells, domain.cells_of([part])),
                law_constants(materials[part], law),
            )
            more = max(0, len(law_of_part.values) - constants.shape[1])
            constants = np.pad(constants, ((0, 0), (0, more)))
            constants[rows, : len(law_of_part.values)] = law_of_part.values
            kinds[rows], bulk[rows] = law_of_part.kind, law_of_part.bulk
            stretch[rows] = materials[part].thermal_stretch
        self.tables = loops.CellTables(
            G=np.ascontiguousarray(G / stretch[:, None, None, None]),
            w=weights * volume * stretch[:, None] ** 3,
            N=_pressure_functions(points, G.shape[-1]),
            dofs=cell_dofs(V.dofmap.list[self.cells]),
            offset=1.0 / stretch - 1.0,
            kinds=kinds,
            constants=constants,
            bulk=bulk,
        )
        self.past = np.tile(VIRGIN, (*self.tables.w.shape, 1))
        self.yields = any(isinstance(law, J2Plasticity) for law in laws.values())

    def advance(self, u: Array, pressure: Array) -> None:
        """Commit the step to u (n_dofs,) [m]; pressure (n_cells, k) [Pa]."""
        if self.yields:
            loops.advance(u, self.tables, pressure, self.past)


class GeneralCells:
    """A `CellGroup` of neo-Hookean, Mooney-Rivlin, Ogden and elastoplastic parts.

    Parameters as in `PointSet`; ``gauss_points`` along the cell's local axes.
    """

    def __init__(
        self,
        domain: Domain,
        V: api.Expr,
        materials: Mapping[str, Material],
        laws: Mapping[str, Law],
        gauss_points: tuple[int, ...],
    ) -> None:
        self.laws = dict(laws)
        self.points = PointSet(domain, V, materials, laws, *api.gauss_rule(gauss_points))
        self.nodes = V.dofmap.list[self.points.cells]
        t = self.points.tables
        mass = np.einsum("cq,qi,qj->cij", t.w, t.N, t.N)
        self._inverse_mass = np.zeros_like(mass)  # zero where a law has fewer functions than N
        for kind, functions in _FUNCTIONS.items():
            rows, n = t.kinds == kind, min(functions, t.N.shape[1])
            self._inverse_mass[rows, :n, :n] = np.linalg.inv(mass[rows, :n, :n])
        self._stress, self._pressure = np.zeros((*t.w.shape, 6)), np.zeros(mass.shape[:2])

    def add_force(self, u: Array, out: Array) -> None:
        """See `CellGroup`."""
        loops.internal_force(u, self.points.tables, self.pressure(u)[0], self.points.past, out)

    def store_stress(self, u: Array, du: Array) -> None:
        """See `CellGroup`: stress without pressure at the points, and the pressure of each cell."""
        points = self.points
        self._pressure, stiffness, _ = self.pressure(u)
        loops.point_stress(u, du, points.tables, self._pressure, stiffness, points.past, self._stress)

    def add_tangent(self, u: Array, rows: BlockRows, places: Places, values: Array) -> None:
        """See `CellGroup`."""
        points = self.points
        fields = (self._stress, points.tables, self._pressure, self.pressure(u)[1], points.past)
        general_tangent.add_tangent(u, *fields, rows, places, values)

    def pressure(self, u: Array) -> tuple[Array, Array, Array]:
        """Pressure (n_cells, k) [Pa], its stiffness (n_cells, k, k) [Pa/m^3], volumetric energy (n_cells,) [J]."""
        shape = (len(self.points.cells), self.points.tables.N.shape[1])
        pressure, stiffness = np.empty(shape), np.empty((*shape, shape[1]))
        energy = loops.dilatation(u, self.points.tables, self._inverse_mass, pressure, stiffness)
        return pressure, stiffness, energy

    def stored_energy(self, u: Array) -> float:
        """Elastic energy of this process' cells after the step to u [J]."""
        pressure, _, volumetric = self.pressure(u)
        t = self.points.tables
        density = loops.internal_force(u, t, pressure, self.points.past, np.zeros_like(u))
        return float(np.sum(density * t.w) + np.sum(volumetric))

    def plastic_dissipation(self) -> float:
        """Work of plastic flow in this process' cells up to the last accepted state [J]."""
        t, total = self.points.tables, 0.0
        for c in np.flatnonzero(self.points.past[:, :, 6].any(axis=1)):
            for q in range(t.w.shape[1]):
                total += t.w[c, q] * plastic_work(t.constants[c], self.points.past[c, q, 6])
        return total


def _pressure_functions(points: Array, nodes: int) -> Array:
    """Functions of dilatation and pressure at reference points, (m, k): 1, and for 27 nodes six more, see above."""
    one = np.ones(len(points))
    if nodes < _WHOLE_CELL:
        return one[:, None]
    x, y, z = 2.0 * points.T - 1.0
    return np.column_stack([one, x, y, z, x * y, y * z, z * x])
