"""Compiled loops of contact between two deforming surfaces: shape functions, closest point, force and stiffness.

A facet is a lattice of (3, 3) or (2, 2) nodes with node (i, j) at place i * n_b + j; an edge of a planar body is a
(3, 1) or (2, 1) lattice, extruded along the third axis. Letters: x current node positions, xi the pair of
coordinates in [-1, 1]^2, t tangents x_,a, n unit normal out of the master's body, m metric t_a . t_b, kappa curvature
n . x_,ab, gap g = n . (x_s - x_m). With tau_a = t_a . (dx_s - dx_m), nu_a = n . dx_m,a and x_m the closest point
throughout, from d^2(g^2/2) = D_qq - D_qxi D_xixi^-1 D_xiq with D = |x_s - x(xi)|^2/2:

    dg     = n . (dx_s - dx_m),
    d(dg)  = - tau m^-1 nu - nu m^-1 tau - g nu m^-1 nu - (tau + g nu) (m - g kappa)^-1 kappa m^-1 (tau + g nu),

symmetric, so that the contact has a potential. Verified by tests/unit/test_fe_inner_contact.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from reference_fe.contact.law import ramped_pressure

__all__ = ["contact_blocks", "nearest_contacts", "shape_values", "surface_frames"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_STEPS = 12
_MOVED = 1e-12
_BEND = 0.5
"""Curvature that is allowed for within a facet: cosine of its normals, and height over radius."""


@compiled()
def _line(n: int, s: float, out: Array) -> None:
    """Lagrange polynomials of n = 1, 2 or 3 nodes at s: values, first and second derivatives into out (3, 3)."""
    out[:] = 0.0
    if n == 1:
        out[0, 0] = 1.0
    elif n == 2:
        out[0, 0], out[0, 1] = 0.5 * (1.0 - s), 0.5 * (1.0 + s)
        out[1, 0], out[1, 1] = -0.5, 0.5
    else:
        out[0, 0], out[0, 1], out[0, 2] = 0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)
        out[1, 0], out[1, 1], out[1, 2] = s - 0.5, -2.0 * s, s + 0.5
        out[2, 0], out[2, 1], out[2, 2] = 1.0, -2.0, 1.0


@compiled()
def _shapes(lattice: tuple[int, int], s: float, t: float, out: Array) -> None:
    """Shape functions (row 0), their derivatives a, b (1, 2) and aa, ab, bb (3, 4, 5) into out (6, n_nodes)."""
    la, lb = np.empty((3, 3)), np.empty((3, 3))
    _line(lattice[0], s, la)
    _line(lattice[1], t, lb)
    for i in range(lattice[0]):
        for j in range(lattice[1]):
            k = i * lattice[1] + j
            out[0, k] = la[0, i] * lb[0, j]
            out[1, k], out[2, k] = la[1, i] * lb[0, j], la[0, i] * lb[1, j]
            out[3, k], out[4, k], out[5, k] = la[2, i] * lb[0, j], la[1, i] * lb[1, j], la[0, i] * lb[2, j]


@compiled()
def shape_values(lattice: tuple[int, int], at: Array) -> Array:
    """Shape functions of a facet at points ``at`` (q, 2), (q, n_nodes) [-]."""
    out, shapes = np.empty((at.shape[0], lattice[0] * lattice[1])), np.empty((6, lattice[0] * lattice[1]))
    for q in range(at.shape[0]):
        _shapes(lattice, at[q, 0], at[q, 1], shapes)
        out[q] = shapes[0]
    return out


@compiled()
def _place(x: Array, nodes: Index, lattice: tuple[int, int], shapes: Array, out: Array) -> None:
    """Position (row 0), tangents (1, 2) and second derivatives (3, 4, 5) into out (6, 3)."""
    out[:] = 0.0
    for d in range(6):
        for k in range(nodes.shape[0]):
            for i in range(3):
                out[d, i] += shapes[d, k] * x[nodes[k], i]
    if lattice[1] == 1:
        out[2, 2] = 1.0


@compiled()
def _normal(place: Array, side: float, n: Array) -> float:
    """Unit normal into n; returns the area ratio |t_1 x t_2| [m^2]."""
    a, b = place[1], place[2]
    n[0], n[1], n[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    area = np.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    for i in range(3):
        n[i] *= side / area
    return float(area)


@compiled()
def surface_frames(
    x: Array, facets: Index, sides: Array, lattice: tuple[int, int], at: Array
) -> tuple[Array, Array, Array]:
    """Positions (f, q, 3) [m], outward unit normals (f, q, 3) [-] and area ratios (f, q) [m^2] at points of each facet.

    Parameters
    ----------
    x : (n_nodes, 3) node positions [m]
    facets : (f, k) nodes of each facet in lattice order
    sides : (f,) +1 where t_1 x t_2 points out of the body, else -1
    lattice : nodes along the two axes
    at : (q, 2) points in [-1, 1]^2
    """
    count = (facets.shape[0], at.shape[0])
    positions, normals, areas = np.empty((*count, 3)), np.empty((*count, 3)), np.empty(count)
    shapes, place = np.empty((6, facets.shape[1])), np.empty((6, 3))
    for q in range(at.shape[0]):
        _shapes(lattice, at[q, 0], at[q, 1], shapes)
        for f in range(facets.shape[0]):
            _place(x, facets[f], lattice, shapes, place)
            areas[f, q] = _normal(place, sides[f], normals[f, q])
            positions[f, q] = place[0]
    return positions, normals, areas


@compiled()
def _closest(
    x: Array, point: Array, nodes: Index, lattice: tuple[int, int], xi: Array, shapes: Array, place: Array
) -> None:
    """Closest point of one facet, continued beyond its edges to |xi| = 1.5, by Newton from its middle; into xi (2,)."""
    xi[:] = 0.0
    for _ in range(_STEPS):
        _shapes(lattice, xi[0], xi[1], shapes)
        _place(x, nodes, lattice, shapes, place)
        r = point - place[0]
        f0, f1 = np.dot(r, place[1]), np.dot(r, place[2])
        m00, m01, m11 = np.dot(place[1], place[1]), np.dot(place[1], place[2]), np.dot(place[2], place[2])
        a00, a01, a11 = m00 - np.dot(r, place[3]), m01 - np.dot(r, place[4]), m11 - np.dot(r, place[5])
        if lattice[1] == 1:
            f1 = 0.0
        if a00 <= 0.0 or a00 * a11 - a01 * a01 <= 0.0:
            a00, a01, a11 = m00, m01, m11
        det = a00 * a11 - a01 * a01
        s = min(1.5, max(-1.5, xi[0] + (a11 * f0 - a01 * f1) / det))
        t = min(1.5, max(-1.5, xi[1] + (a00 * f1 - a01 * f0) / det))
        moved = abs(s - xi[0]) + abs(t - xi[1])
        xi[0], xi[1] = s, t
        if moved < _MOVED:
            break
    _shapes(lattice, xi[0], xi[1], shapes)
    _place(x, nodes, lattice, shapes, place)


@compiled()
def _may_touch(
    point: Array, normal: Array, middle: Array, radius: float, outward: Array, above: float, below: float
) -> bool:
    """Quick refusal of a master facet: it looks away, or the point is too far above, behind or beside it."""
    height, squared, facing = 0.0, 0.0, 0.0
    for i in range(3):
        offset = point[i] - middle[i]
        height += offset * outward[i]
        squared += offset * offset
        facing += normal[i] * outward[i]
    room = _BEND * radius
    near = squared <= (radius + max(above, below)) ** 2
    return near and facing <= _BEND and -below - room <= height <= above + room


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
    xi, n = np.empty(2), np.empty(3)
    shapes, place = np.empty((6, facets.shape[1])), np.empty((6, 3))
    for f in range(n_f):
        for q in range(n_q):
            for c in wanted[starts[f] : starts[f + 1]]:
                if not _may_touch(points[f, q], normals[f, q], middles[c], radii[c], outward[c], above, below):
                    continue
                _closest(x, points[f, q], facets[c], lattice, xi, shapes, place)
                if not (-1.0 - margins[c, 0] <= xi[0] <= 1.0 + margins[c, 1]):
                    continue
                if not (-1.0 - margins[c, 2] <= xi[1] <= 1.0 + margins[c, 3]):
                    continue
                _normal(place, sides[c], n)
                g = np.dot(points[f, q] - place[0], n)
                if np.dot(normals[f, q], n) < 0.0 and -below < g < above and abs(g) < abs(gap[f, q]):
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
        _shapes(lattice, xi[c, 0], xi[c, 1], shapes)
        _place(x, facets[c], lattice, shapes, place)
        _normal(place, sides[c], n)
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
