"""Compiled loops of contact between two deforming surfaces: search, force and stiffness.

Facets are those of `facet_kernels`. Letters: x current node positions, xi the pair of coordinates in [-1, 1]^2, t
tangents x_,a, n unit normal out of the master's body, m metric t_a . t_b, kappa curvature n . x_,ab, gap
g = n . (x_s - x_m). With tau_a = t_a . (dx_s - dx_m), nu_a = n . dx_m,a and x_m the closest point
throughout, from d^2(g^2/2) = D_qq - D_qxi D_xixi^-1 D_xiq with D = |x_s - x(xi)|^2/2:

    dg     = n . (dx_s - dx_m),
    d(dg)  = - tau m^-1 nu - nu m^-1 tau - g nu m^-1 nu - (tau + g nu) (m - g kappa)^-1 kappa m^-1 (tau + g nu),

symmetric, so that the contact has a potential. Verified by tests/unit/test_fe_inner_contact.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from reference_fe.contact.facet_kernels import closest_point, dot, facet_place, facet_shapes, unit_normal
from reference_fe.contact.law import ramped_pressure

__all__ = ["contact_blocks", "nearest_contacts"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_BEND = 0.5
"""Curvature that is allowed for within a facet: largest cosine between a slave's and the master's normal."""


@compiled()
def _bow(x: Array, nodes: Index, middle: Array, outward: Array, margins: Array) -> float:
    """Bound of a facet's height over the plane through its middle, up to its margins, to either side [m].

    A surface is nowhere farther from the plane than its nodes, times the sum of its shape functions' sizes: along one
    axis 1.25 at most within three nodes, and 1 + 4 e + 2 e^2 a margin e beyond them.
    """
    height, growth = 0.0, 1.0
    for k in range(nodes.shape[0]):
        offset = 0.0
        for i in range(3):
            offset += (x[nodes[k], i] - middle[i]) * outward[i]
        height = max(height, abs(offset))
    for axis in range(2):
        e = max(margins[2 * axis], margins[2 * axis + 1])
        growth *= max(1.25, 1.0 + 4.0 * e + 2.0 * e * e)
    return growth * height


@compiled()
def _ball(points: Array, middle: Array) -> float:
    """Mean of points (q, 3) into ``middle`` (3,), and the radius of the ball around it that holds them [m]."""
    middle[:] = 0.0
    for q in range(points.shape[0]):
        for i in range(3):
            middle[i] += points[q, i] / points.shape[0]
    largest = 0.0
    for q in range(points.shape[0]):
        squared = 0.0
        for i in range(3):
            squared += (points[q, i] - middle[i]) ** 2
        largest = max(largest, squared)
    return float(np.sqrt(largest))


@compiled()
def _may_touch(
    point: Array, normal: Array, middle: Array, outward: Array, reach: float, heights: tuple[float, float]
) -> bool:
    """Quick refusal of a master facet: it looks away, or the point lies out of ``reach`` of its middle or ``heights``
    over it [m].
    """
    height, squared, facing = 0.0, 0.0, 0.0
    for i in range(3):
        offset = point[i] - middle[i]
        height += offset * outward[i]
        squared += offset * offset
        facing += normal[i] * outward[i]
    return squared <= reach**2 and facing <= _BEND and heights[0] <= height <= heights[1]


@compiled()
def nearest_contacts(
    x: Array,
    points: Array,
    normals: Array,
    candidates: tuple[Index, Index],
    master: tuple[Index, Array, tuple[int, int]],
    balls: tuple[Array, Array, Array],
    limits: tuple[float, float],
    margins: Array,
) -> tuple[Index, Array, Array]:
    """For each slave point the master facet straight below it.

    Among the candidates that face the point (normals more than a right angle apart), whose closest point lies on the
    facet, or beyond an edge by its margin at most, and at most the reach away, the nearest counts.

    Parameters
    ----------
    x : (n_nodes, 3) current node positions [m]
    points, normals : (f, q, 3) slave points [m] and outward normals [-]
    candidates : row starts (f + 1,) and master facets of each slave facet
    master : facets (m, k), sides (m,), lattice
    balls : middle (m, 3), radius (m,) [m] and outward normal in the middle (m, 3) of each master facet
    limits : reach above (gap) and below (depth) the master's surface [m]
    margins : (m, 4) how far the closest point may pass the edges xi_1 = -1, +1 and xi_2 = -1, +1 of each master [-]

    Returns
    -------
    facet : (f, q) master facet, -1 where there is none
    xi : (f, q, 2) closest point
    gap : (f, q) normal gap, open > 0 [m]; inf where there is none
    """
    starts, wanted = candidates
    facets, sides, lattice = master
    middles, radii, outward = balls
    above, below = limits
    n_f, n_q = points.shape[0], points.shape[1]
    facet, gap = np.full((n_f, n_q), -1, dtype=np.int64), np.full((n_f, n_q), np.inf)
    where = np.zeros((n_f, n_q, 2))
    xi, n, centre = np.empty(2), np.empty(3), np.empty(3)
    shapes, place = np.empty((6, facets.shape[1])), np.empty((6, 3))
    bows = np.empty(facets.shape[0])
    for c in range(facets.shape[0]):
        bows[c] = _bow(x, facets[c], middles[c], outward[c], margins[c])
    for f in range(n_f):
        radius = _ball(points[f], centre)
        for k in range(starts[f], starts[f + 1]):
            c = wanted[k]
            height, squared = 0.0, 0.0
            for i in range(3):
                height += (centre[i] - middles[c, i]) * outward[c, i]
                squared += (centre[i] - middles[c, i]) ** 2
            beyond = max(margins[c, 0], margins[c, 1], margins[c, 2], margins[c, 3])
            furthest = max(1.5, 1.0 + 1.1 * beyond)
            heights, reach = (-below - bows[c], above + bows[c]), (1.0 + 2.0 * beyond) * radii[c] + max(above, below)
            if squared > (reach + radius) ** 2 or not heights[0] - radius <= height <= heights[1] + radius:
                continue
            for q in range(n_q):
                if not _may_touch(points[f, q], normals[f, q], middles[c], outward[c], reach, heights):
                    continue
                closest_point(x, points[f, q], facets[c], lattice, furthest, xi, shapes, place)
                if not (-1.0 - margins[c, 0] <= xi[0] <= 1.0 + margins[c, 1]):
                    continue
                if not (-1.0 - margins[c, 2] <= xi[1] <= 1.0 + margins[c, 3]):
                    continue
                unit_normal(place, sides[c], n)
                g = 0.0
                for i in range(3):
                    g += (points[f, q, i] - place[0, i]) * n[i]
                if dot(normals[f, q], n) < 0.0 and -below < g < above and abs(g) < abs(gap[f, q]):
                    facet[f, q], gap[f, q] = c, g
                    where[f, q] = xi
    return facet, where, gap


@compiled()
def contact_blocks(
    x: Array,
    slave: tuple[Index, Array],
    master: tuple[Index, Array, tuple[int, int]],
    xi: Array,
    touch: Array,
    law: tuple[float, float],
    blocks: tuple[Array, Array],
) -> None:
    """Force and stiffness of each touching point on the nodes of its slave facet, then of its master facet.

    Parameters
    ----------
    x : (n_nodes, 3) current node positions [m]
    slave : nodes (c, k) and shape functions (c, k) of each contact's slave point
    master : facets (c, l) and sides (c,) of each contact, lattice
    xi : (c, 2) closest points
    touch : (c, 2) gap [m] and undeformed area [m^2] of each contact
    law : penalty stiffness [N/m^3] and ramp [m]
    blocks : force (c, k + l, dim) and stiffness (c, k + l, dim, k + l, dim) that are filled
    """
    nodes_s, N = slave
    facets, sides, lattice = master
    force, stiffness = blocks
    n_s, n_m, dim = nodes_s.shape[1], facets.shape[1], force.shape[2]
    shapes, place, n = np.empty((6, n_m)), np.empty((6, 3)), np.empty(3)
    size = (n_s + n_m) * dim
    dg, tau, nu = np.empty(size), np.empty((2, size)), np.empty((2, size))
    for c in range(nodes_s.shape[0]):
        facet_shapes(lattice, xi[c, 0], xi[c, 1], shapes)
        facet_place(x, facets[c], lattice, shapes, place)
        unit_normal(place, sides[c], n)
        gap, area = touch[c, 0], touch[c, 1]
        pressure, slope = ramped_pressure(gap, law[0], law[1])
        for a in range(n_s + n_m):
            N_a = N[c, a] if a < n_s else -shapes[0, a - n_s]
            for i in range(dim):
                k = a * dim + i
                dg[k] = N_a * n[i]
                for d in range(2):
                    tau[d, k] = N_a * place[1 + d, i]
                    nu[d, k] = 0.0 if a < n_s else shapes[1 + d, a - n_s] * n[i]
                force[c, a, i] = area * pressure * dg[k]
        K = stiffness[c].reshape(size, size)
        _turning(place, n, gap, -area * pressure, (tau, nu), K)
        for k in range(size):
            for m in range(size):
                K[k, m] += area * slope * dg[k] * dg[m]


@compiled()
def _turning(place: Array, n: Array, g: float, factor: float, variations: tuple[Array, Array], K: Array) -> None:
    """Write factor d(dg) into K: the normal turns and the closest point slides."""
    tau, nu = variations
    m = np.empty((2, 2))
    kappa = np.empty((2, 2))
    for a in range(2):
        for b in range(2):
            m[a, b] = np.dot(place[1 + a], place[1 + b])
            kappa[a, b] = np.dot(n, place[3 + a + b])
    inverse = np.linalg.inv(m)
    slide = np.linalg.inv(m - g * kappa) @ kappa @ inverse
    sigma = tau + g * nu
    for k in range(K.shape[0]):
        for j in range(K.shape[0]):
            value = 0.0
            for a in range(2):
                for b in range(2):
                    mixed = tau[a, k] * nu[b, j] + nu[a, k] * tau[b, j] + g * nu[a, k] * nu[b, j]
                    value -= inverse[a, b] * mixed + slide[a, b] * sigma[a, k] * sigma[b, j]
            K[k, j] = factor * value
