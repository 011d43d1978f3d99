"""Contact pressure at the nodes of the faces that touch, recovered from the pressures at their quadrature points.

Each facet of second order is taken as four straight ones. With the hat function w_i of a node on these, its pressure is
p_i = int w_i p dA / int w_i dA, the projection with a lumped mass (e.g. Zienkiewicz, Taylor & Zhu, The Finite Element
Method, 2005, on averaging at nodes; from memory). It is nowhere negative, the sum of p_i int w_i dA is the load, and it
converges where the pressures at quadrature points of a facet that is touched in part alternate.
Verified by tests/verification/test_fe_nodal_pressure.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.contact.patch import lattice_order

__all__ = ["nodal_pressure"]

Array = NDArray[np.float64]


def nodal_pressure(nodes: int, facets: NDArray[np.int64], areas: Array, pressure: Array) -> tuple[Array, Array]:
    """Recovered pressure and area of every node.

    Parameters
    ----------
    nodes : number of the mesh's nodes
    facets : (n_facets, 4 or 9) int, their nodes
    areas : (n_facets, q) undeformed area of the Gauss points of each, q a square number [m^2]
    pressure : (n_facets, q) there [Pa]

    Returns
    -------
    pressure : (nodes,) >= 0 [Pa], 0 at nodes of no facet
    area : (nodes,) that each node stands for [m^2]
    """
    hats = _hats(facets.shape[1], round(areas.shape[1] ** 0.5))
    force, area = np.zeros(nodes), np.zeros(nodes)
    np.add.at(force, facets, (areas * pressure) @ hats)
    np.add.at(area, facets, areas @ hats)
    return np.divide(force, area, out=np.zeros(nodes), where=area > 0.0), area


def _hats(nodes: int, points: int) -> Array:
    """Hat functions (points^2, nodes) of a facet's nodes at its Gauss points, so many an axis."""
    s = np.polynomial.legendre.leggauss(points)[0]
    if nodes == 4:
        line = np.array([0.5 * (1.0 - s), 0.5 * (1.0 + s)])
    else:
        line = np.array([np.maximum(0.0, -s), 1.0 - np.abs(s), np.maximum(0.0, s)])
    a, b = (grid.ravel() for grid in np.meshgrid(np.arange(points), np.arange(points), indexing="ij"))
    return np.stack([line[i][a] * line[j][b] for i, j in lattice_order(nodes)], axis=-1)
