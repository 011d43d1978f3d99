"""Compiled geometry of one facet: shape functions, tangents, normals, closest point.

A facet is a lattice of (3, 3) or (2, 2) nodes with node (i, j) at place i * n_b + j; an edge of a planar body is a
(3, 1) or (2, 1) lattice, extruded along the third axis. Verified by tests/unit/test_fe_inner_contact.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled

__all__ = ["closest_point", "dot", "facet_place", "facet_shapes", "shape_values", "surface_frames", "unit_normal"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_STEPS = 12
_MOVED = 1e-12


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
def facet_shapes(lattice: tuple[int, int], s: float, t: float, out: Array) -> None:
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
        facet_shapes(lattice, at[q, 0], at[q, 1], shapes)
        out[q] = shapes[0]
    return out


@compiled()
def facet_place(x: Array, nodes: Index, lattice: tuple[int, int], shapes: Array, out: Array) -> None:
    """Position (row 0), tangents (1, 2) and second derivatives (3, 4, 5) into out (6, 3)."""
    out[:] = 0.0
    for d in range(6):
        for k in range(nodes.shape[0]):
            for i in range(3):
                out[d, i] += shapes[d, k] * x[nodes[k], i]
    if lattice[1] == 1:
        out[2, 2] = 1.0


@compiled()
def unit_normal(place: Array, side: float, n: Array) -> float:
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
        facet_shapes(lattice, at[q, 0], at[q, 1], shapes)
        for f in range(facets.shape[0]):
            facet_place(x, facets[f], lattice, shapes, place)
            areas[f, q] = unit_normal(place, sides[f], normals[f, q])
            positions[f, q] = place[0]
    return positions, normals, areas


@compiled()
def dot(a: Array, b: Array) -> float:
    """Product of two vectors (3,): a call of BLAS takes longer."""
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@compiled()
def closest_point(
    x: Array,
    point: Array,
    nodes: Index,
    lattice: tuple[int, int],
    furthest: float,
    xi: Array,
    shapes: Array,
    place: Array,
) -> None:
    """Closest point of one facet, continued beyond its edges to |xi| = ``furthest``, by Newton from its middle; into
    xi (2,). At ``furthest`` it is none.
    """
    xi[:] = 0.0
    r = np.empty(3)
    for _ in range(_STEPS):
        facet_shapes(lattice, xi[0], xi[1], shapes)
        facet_place(x, nodes, lattice, shapes, place)
        for i in range(3):
            r[i] = point[i] - place[0, i]
        f0, f1 = dot(r, place[1]), dot(r, place[2])
        m00, m01, m11 = dot(place[1], place[1]), dot(place[1], place[2]), dot(place[2], place[2])
        a00, a01, a11 = m00 - dot(r, place[3]), m01 - dot(r, place[4]), m11 - dot(r, place[5])
        if lattice[1] == 1:
            f1 = 0.0
        if a00 <= 0.0 or a00 * a11 - a01 * a01 <= 0.0:
            a00, a01, a11 = m00, m01, m11
        det = a00 * a11 - a01 * a01
        s = min(furthest, max(-furthest, xi[0] + (a11 * f0 - a01 * f1) / det))
        t = min(furthest, max(-furthest, xi[1] + (a00 * f1 - a01 * f0) / det))
        moved = abs(s - xi[0]) + abs(t - xi[1])
        xi[0], xi[1] = s, t
        if moved < _MOVED:
            break
    facet_shapes(lattice, xi[0], xi[1], shapes)
    facet_place(x, nodes, lattice, shapes, place)
