"""Compiled strain energy, force and tangent of thin plates.

With a_1, a_2 the tangents, n their unit normal and capitals for the reference, membrane strain and change of curvature
are

    E_ab = (a_a . a_b - A_a . A_b) / 2,   K_ab = r_,ab . n - R_,ab . N - (B_a^c E_cb + B_b^c E_ca),   B = R_,ab . N,

and the energy is the integral of (t E : C : E + t^3 / 12 K : C : K) / 2 with the plane-stress tensor C in the
reference's contravariant components (Kirchhoff-Love; Dufva & Shabana, Proc. IMechE K 219, 2005, from memory). Of
f = c . m / |m|, m = a_1 x a_2, J = |m|, P = 1 - n n^T:

    f_c = n,  f_m = P c / J,  f_cm = P / J,  f_mm = -(P c n^T + n c^T P + (c . n) P) / J^2.

Verified by tests/unit/test_ancf_thin_plates.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.compiled import compiled

__all__ = ["add_terms", "find_stress", "normal_second", "unit_normal"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Points = tuple[Index, Array, Array, Array, Array, Array, Array]
"""Points of some plates where one measure of strain, M = A E + beta (r_,ab . n - R_,ab . N), is integrated:

which (n,) : plates
tables (n, p, 6, 16) : as `shape_functions.shape_tables`
metric (n, p, 3) : A_11, A_22, 2 A_12 of the reference
curvature (n, p, 3) : B_11, B_22, 2 B_12 [1/m]
stretch (n, p, 3, 3) : A, by E_11, E_22, 2 E_12
beta (n,) : 0 for the membrane strain, 1 for the change of curvature [-], minus a layer's height [m]
stiffness (n, p, 3, 3) : of M, times area
"""


@compiled
def add_terms(q: Array, plates: Index, points: Points, mixed: Array, force: Array, tangent: Array) -> float:
    """Energy of one measure of strain [J]; adds forces and tangents.

    Parameters
    ----------
    q : (n_nodes, 4, 3) r [m], r_1, r_2 [-], r_12 [1/m]
    plates : (n_plates, 4) nodes
    points : see `Points`
    mixed : (n, p, 3) stresses for the geometric part of the tangent; of no plates for those that belong to q
    force, tangent : (n_plates, 16, 3), (n_plates, 16, 3, 16, 3) added to; a tangent of no plates is left alone
    """
    which, tables, metric, curvature, stretch, beta, stiffness = points
    energy, local, all_v, strain = 0.0, np.empty((16, 3)), np.empty((5, 3)), np.empty(3)
    measure, stress, geometric = np.empty(3), np.empty(3), np.empty(3)
    first, H, rows = np.empty((3, 5, 3)), np.empty((5, 3, 5, 3)), np.empty((3, 15))
    most, product = 5 * tables.shape[1], np.empty((16, 144))
    all_half, all_shapes = np.empty((most, 144)), np.empty((most, 16))
    for s in range(which.shape[0]):
        e, b = which[s], beta[s]
        count = 2 if b == 0.0 else 5
        half, shapes = all_half[: count * tables.shape[1]], all_shapes[: count * tables.shape[1]]
        v = all_v[:count]
        _gather(q, plates[e], local)
        for p in range(tables.shape[1]):
            N, A = tables[s, p], stretch[s, p]
            _at_point(N, local, v)
            n, J = unit_normal(all_v) if count == 5 else (strain, 1.0)
            _stretch(v, metric[s, p], strain)
            _measure(v, n, b, A, curvature[s, p], strain, measure)
            first[:] = 0.0
            for row in range(3):
                if count == 5:
                    d, factor = (2, b) if row == 0 else (4, b) if row == 1 else (3, 2.0 * b)
                    _first(v, d, n, J, factor, first[row])
                for i in range(3):
                    first[row, 0, i] += A[row, 0] * v[0, i] + A[row, 2] * v[1, i]
                    first[row, 1, i] += A[row, 1] * v[1, i] + A[row, 2] * v[0, i]
            energy += _conjugate(stiffness[s, p], measure, stress)
            for d in range(count):
                for i in range(3):
                    value = stress[0] * first[0, d, i] + stress[1] * first[1, d, i] + stress[2] * first[2, d, i]
                    for k in range(16):
                        force[e, k, i] += N[1 + d, k] * value
            if tangent.shape[0]:
                for m in range(3):
                    geometric[m] = mixed[s, p, m] if mixed.shape[0] else stress[m]
                H[:] = 0.0
                if count == 5:
                    _second(v, n, J, b * geometric, H)
                for i in range(3):
                    for m in range(3):
                        H[0, i, 0, i] += geometric[m] * A[m, 0]
                        H[1, i, 1, i] += geometric[m] * A[m, 1]
                        H[0, i, 1, i] += geometric[m] * A[m, 2]
                        H[1, i, 0, i] += geometric[m] * A[m, 2]
                for d in range(count):
                    for i in range(3):
                        for r in range(3):
                            value = 0.0
                            for m in range(3):
                                value += stiffness[s, p, r, m] * first[m, d, i]
                            rows[r, 3 * d + i] = value
                for d in range(count):
                    for i in range(3):
                        for c in range(count):
                            for j in range(3):
                                for r in range(3):
                                    H[d, i, c, j] += first[r, d, i] * rows[r, 3 * c + j]
                _across(H, N, count, half[p * count : (p + 1) * count].reshape(count, 3, 3, 16))
                shapes[p * count : (p + 1) * count] = N[1 : 1 + count]
        if tangent.shape[0]:
            _add_product(shapes, half, product, tangent[e])
    return energy


@compiled
def find_stress(q: Array, step: Array, plates: Index, points: Points, out: Array) -> None:
    """Stresses of the measure, linearised in what squares of the stretch add, (n, p, 3) into ``out``.

    C (M(q + step) - A E2(step)), where E2 are the squares of the step in E: exact to first order, and free of the large
    stretch that a straight step gives to strips that turn. ``step`` of zeros: the stresses at q.
    """
    which, tables, metric, curvature, stretch, beta, stiffness = points
    local, moved, all_v, a = np.empty((16, 3)), np.empty((16, 3)), np.empty((5, 3)), np.empty((2, 3))
    strain, square, measure, none = np.empty(3), np.empty(3), np.empty(3), np.zeros(3)
    for s in range(which.shape[0]):
        _gather(q, plates[which[s]], local)
        _gather(step, plates[which[s]], moved)
        local += moved
        v = all_v[:2] if beta[s] == 0.0 else all_v
        for p in range(tables.shape[1]):
            _at_point(tables[s, p], local, v)
            _at_point(tables[s, p], moved, a)
            n = unit_normal(all_v)[0] if beta[s] != 0.0 else none
            _stretch(v, metric[s, p], strain)
            _stretch(a, none, square)
            strain -= square
            _measure(v, n, beta[s], stretch[s, p], curvature[s, p], strain, measure)
            _conjugate(stiffness[s, p], measure, out[s, p])


@compiled
def _across(H: Array, N: Array, count: int, half: Array) -> None:
    """H N of one point into ``half`` (count, 3, 3, 16): row vector and component, column component and function."""
    half[:count] = 0.0
    for d in range(count):
        for i in range(3):
            for j in range(3):
                out = half[d, i, j]
                for c in range(count):
                    value, shapes = H[d, i, c, j], N[1 + c]
                    for m in range(16):
                        out[m] += value * shapes[m]


@compiled
def _add_product(shapes: Array, half: Array, product: Array, tangent: Array) -> None:
    """Add N^T H N summed over the points of a plate to its tangent (16, 3, 16, 3), from all their rows of N and H N."""
    np.dot(shapes.T, half, product)
    for k in range(16):
        for i in range(3):
            for j in range(3):
                for m in range(16):
                    tangent[k, i, m, j] += product[k, 48 * i + 16 * j + m]


@compiled
def _measure(v: Array, n: Array, b: float, A: Array, curvature: Array, strain: Array, out: Array) -> None:
    for row in range(3):
        out[row] = A[row, 0] * strain[0] + A[row, 1] * strain[1] + A[row, 2] * strain[2]
        if b != 0.0:
            d, factor = (2, 1.0) if row == 0 else (4, 1.0) if row == 1 else (3, 2.0)
            along = v[d, 0] * n[0] + v[d, 1] * n[1] + v[d, 2] * n[2]
            out[row] += b * (factor * along - curvature[row])


@compiled
def _gather(q: Array, nodes: Index, local: Array) -> None:
    for k in range(4):
        for d in range(4):
            for i in range(3):
                local[4 * k + d, i] = q[nodes[k], d, i]


@compiled
def _at_point(N: Array, local: Array, out: Array) -> None:
    """Derivatives of r at a point, as many as ``out`` (d, 3) has rows: r_1, r_2, r_11, r_12, r_22."""
    for d in range(out.shape[0]):
        for i in range(3):
            out[d, i] = 0.0
            for k in range(16):
                out[d, i] += N[1 + d, k] * local[k, i]


@compiled
def _stretch(a: Array, metric: Array, strain: Array) -> None:
    """E_11, E_22, 2 E_12 of the tangents a[0] and a[1] into ``strain`` (3,)."""
    for k in range(3):
        strain[k] = -0.5 * metric[k]
    for i in range(3):
        strain[0] += 0.5 * a[0, i] * a[0, i]
        strain[1] += 0.5 * a[1, i] * a[1, i]
        strain[2] += a[0, i] * a[1, i]


@compiled
def _conjugate(stiffness: Array, strain: Array, stress: Array) -> float:
    """stiffness times strain into ``stress`` (3,); half their product [J]."""
    energy = 0.0
    for k in range(3):
        stress[k] = 0.0
        for m in range(3):
            stress[k] += stiffness[k, m] * strain[m]
        energy += 0.5 * stress[k] * strain[k]
    return float(energy)


@compiled
def unit_normal(v: Array) -> tuple[Array, float]:
    """Of v = (a_1, a_2, ...): unit normal and |a_1 x a_2|."""
    n = np.array(
        [
            v[0, 1] * v[1, 2] - v[0, 2] * v[1, 1],
            v[0, 2] * v[1, 0] - v[0, 0] * v[1, 2],
            v[0, 0] * v[1, 1] - v[0, 1] * v[1, 0],
        ]
    )
    J = np.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    n /= J
    return n, float(J)


@compiled
def _cross(a: Array, b: Array, out: Array) -> None:
    out[0], out[1], out[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def _first(v: Array, d: int, n: Array, J: float, factor: float, out: Array) -> None:
    """Derivatives of ``factor`` v_d . n by v into out (5, 3): f_m . (da_1 x a_2) = da_1 . (a_2 x f_m)."""
    out[:] = 0.0
    f, turned = np.empty(3), np.empty(3)
    along = v[d, 0] * n[0] + v[d, 1] * n[1] + v[d, 2] * n[2]
    for i in range(3):
        f[i] = factor * (v[d, i] - along * n[i]) / J
        out[d, i] = factor * n[i]
    _cross(v[1], f, turned)
    for i in range(3):
        out[0, i] += turned[i]
    _cross(f, v[0], turned)
    for i in range(3):
        out[1, i] += turned[i]


@compiled
def normal_second(v: Array, n: Array, J: float, c: Array, out: Array, turn: Array) -> None:
    """Of c . n with constant c: second derivatives by (a_1, a_2) into out (6, 6), d n by them into turn (3, 6)."""
    along = c[0] * n[0] + c[1] * n[1] + c[2] * n[2]
    D = np.zeros((3, 6))  # m by a_1 and a_2
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        D[i, j], D[i, k] = v[1, k], -v[1, j]
        D[i, 3 + j], D[i, 3 + k] = -v[0, k], v[0, j]
    P = np.eye(3)
    f, second = np.empty(3), np.empty((3, 3))
    for i in range(3):
        f[i] = (c[i] - along * n[i]) / J
        for j in range(3):
            P[i, j] -= n[i] * n[j]
    for i in range(3):
        for j in range(3):
            second[i, j] = -(f[i] * n[j] + n[i] * f[j]) / J - along * P[i, j] / J**2
    half = np.empty((3, 6))
    for i in range(3):
        for j in range(6):
            half[i, j] = second[i, 0] * D[0, j] + second[i, 1] * D[1, j] + second[i, 2] * D[2, j]
            turn[i, j] = (P[i, 0] * D[0, j] + P[i, 1] * D[1, j] + P[i, 2] * D[2, j]) / J
    for i in range(6):
        for j in range(6):
            out[i, j] = D[0, i] * half[0, j] + D[1, i] * half[1, j] + D[2, i] * half[2, j]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[j, 3 + k] += f[i]  # f . (da_1 x da_2)
        out[k, 3 + j] -= f[i]
        out[3 + k, j] += f[i]
        out[3 + j, k] -= f[i]


@compiled
def _second(v: Array, n: Array, J: float, moment: Array, H: Array) -> None:
    """Second derivatives of sum of moments times v_d . n by v, added to H (5, 3, 5, 3)."""
    c, by_a, turn = np.empty(3), np.empty((6, 6)), np.empty((3, 6))
    for i in range(3):  # as the moments are constant here, one vector stands for all three
        c[i] = moment[0] * v[2, i] + moment[1] * v[4, i] + 2.0 * moment[2] * v[3, i]
    normal_second(v, n, J, c, by_a, turn)
    for i in range(3):
        for j in range(3):
            for a in range(2):
                for b in range(2):
                    H[a, i, b, j] += by_a[3 * a + i, 3 * b + j]
                for row in range(3):
                    d, factor = (2, 1.0) if row == 0 else (4, 1.0) if row == 1 else (3, 2.0)
                    H[d, i, a, j] += factor * moment[row] * turn[i, 3 * a + j]
                    H[a, j, d, i] += factor * moment[row] * turn[i, 3 * a + j]
