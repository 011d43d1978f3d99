"""Consistent mass of a static problem's cells, and each mesh node's share of it.

M_ab = int rho N_a N_b dV over the undeformed cells, the same for every component of space (docs/theory/vibration.md).
Verified by tests/verification/test_fe_vibration.py.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from contracts.errors import InputError
from reference_fe import dolfinx_api as api
from reference_fe.cells import reference_cell
from reference_fe.problem.domain import Domain

__all__ = ["consistent_mass", "nodal_mass"]

Array = NDArray[np.float64]
_POINTS = 4
"""Gauss points an axis: exact for products of quadratic functions on cells whose Jacobian is cubic."""
_CHUNK = 2000
"""Cells at a time."""


def consistent_mass(domain: Domain, V: api.Expr, densities: Mapping[str, float]) -> csr_array:
    """Scalar mass matrix of the displacement space's nodes, (n_nodes, n_nodes) [kg].

    Parameters
    ----------
    domain : solid mesh on one process
    V : displacement space
    densities : part name -> density [kg/m^3]; other parts have no mass

    Raises
    ------
    InputError
        For a planar mesh, several processes, and a density that is not positive.
    """
    _check(domain, densities)
    points, weights = api.gauss_rule((_POINTS,) * 3)
    shape = V.element.basix_element.tabulate(0, points)[0, :, :, 0]
    products = np.einsum("q,qa,qb->qab", weights, shape, shape)
    nodes = V.dofmap.list
    count = shape.shape[1]
    entries = []
    for part, density in densities.items():
        cells = domain.cells_of([part])
        for first in range(0, len(cells), _CHUNK):
            some = cells[first : first + _CHUNK]
            blocks = density * np.einsum("cq,qab->cab", _volumes(domain, some, points), products)
            rows = np.repeat(nodes[some], count, axis=1).ravel()
            columns = np.tile(nodes[some], (1, count)).ravel()
            entries.append((rows, columns, blocks.ravel()))
    rows, columns, values = (np.concatenate(each) for each in zip(*entries, strict=True))
    size = V.dofmap.index_map.size_local
    return csr_array(coo_array((values, (rows, columns)), shape=(size, size)))


def nodal_mass(domain: Domain, densities: Mapping[str, float]) -> Array:
    """Each cell's mass shared alike by its nodes, at the nodes of the tagged mesh, (n_points,) [kg]."""
    _check(domain, densities)
    points, weights = api.gauss_rule((_POINTS,) * 3)
    found = np.zeros(len(domain.tagged.points))
    numbers = domain.mesh.geometry.input_global_indices[api.cell_nodes(domain.mesh)]
    for part, density in densities.items():
        cells = domain.cells_of([part])
        mass = density * _volumes(domain, cells, points) @ weights
        np.add.at(found, numbers[cells], mass[:, None] / numbers.shape[1])
    return found


def _volumes(domain: Domain, cells: NDArray[np.int32], points: Array) -> Array:
    """|det of the map| of cells at reference points, (n_cells, n_points) [m^3]."""
    gradients = reference_cell.lagrange_gradients(domain.tagged.order, points)
    positions = domain.mesh.geometry.x[api.cell_nodes(domain.mesh)[cells]]
    return np.asarray(np.abs(np.linalg.det(np.einsum("cni,kqn->cqik", positions, gradients))))


def _check(domain: Domain, densities: Mapping[str, float]) -> None:
    if domain.dim != 3:
        raise InputError("vibration", "a planar mesh", "needs a solid mesh", "mesh the wheel in three dimensions")
    if domain.mesh.comm.size > 1:
        raise InputError("vibration", f"{domain.mesh.comm.size} processes", "needs one process", "run it without MPI")
    for part, density in densities.items():
        if not (np.isfinite(density) and density > 0.0):
            raise InputError(f"density of {part}", f"{density:g} kg/m^3", "must be > 0", "7800 is steel's")
