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

__all__ = ["bending_terms", "membrane_terms"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@compiled
def membrane_terms(
    q: Array, plates: Index, tables: Array, metric: Array, stiffness: Array, force: Array, tangent: Array
) -> float:
    """Energy of the membrane strain [J]; adds forces and tangents.

    Parameters
    ----------
    q : (n_nodes, 4, 3) r [m], r_1, r_2 [-], r_12 [1/m]
    plates : (n, 4) nodes
    tables : (n, p, 6, 16) as `shape_functions.shape_tables`, at the points of the membrane strain
    metric : (n, p, 3) A_11, A_22, 2 A_12 of the reference
    stiffness : (n, p, 3, 3) t C times area [N/m * m^2], for E_11, E_22, 2 E_12
    force, tangent : (n, 16, 3), (n, 16, 3, 16, 3) added to; a tangent of no plates is left alone
    """
    energy, local = 0.0, np.empty((16, 3))
    a, strain, stress = np.empty((2, 3)), np.empty(3), np.empty(3)
    g = np.empty((3, 16, 3))
    for e in range(plates.shape[0]):
        _gather(q, plates[e], local)
        for p in range(tables.shape[1]):
            N = tables[e, p]
            _at_point(N, local, a)
            _stretch(a, metric[e, p], strain)
            energy += _conjugate(stiffness[e, p], strain, stress)
            for k in range(16):
                for i in range(3):
                    g[0, k, i] = N[1, k] * a[0, i]
                    g[1, k, i] = N[2, k] * a[1, i]
                    g[2, k, i] = N[1, k] * a[1, i] + N[2, k] * a[0, i]
                    force[e, k, i] += stress[0] * g[0, k, i] + stress[1] * g[1, k, i] + stress[2] * g[2, k, i]
            if tangent.shape[0]:
                for k in range(16):
                    for m in range(16):
                        shared = stress[0] * N[1, k] * N[1, m] + stress[1] * N[2, k] * N[2, m]
                        shared += stress[2] * (N[1, k] * N[2, m] + N[2, k] * N[1, m])
                        for i in range(3):
                            tangent[e, k, i, m, i] += shared
                        for i in range(3):
                            for j in range(3):
                                value = 0.0
                                for r in range(3):
                                    for c in range(3):
                                        value += g[r, k, i] * stiffness[e, p, r, c] * g[c, m, j]
                                tangent[e, k, i, m, j] += value
    return energy


@compiled
def bending_terms(
    q: Array,
    plates: Index,
    tables: Array,
    reference: tuple[Array, Array, Array],
    stiffness: Array,
    force: Array,
    tangent: Array,
) -> float:
    """Energy of the change of curvature [J]; adds forces and tangents. As `membrane_terms`, with

    reference : (n, p, 3) B_11, B_22, 2 B_12 [1/m], (n, p, 3) A_11, A_22, 2 A_12, (n, p, 3, 3) [1/m] what stretch alone
        adds to the curvatures, for E_11, E_22, 2 E_12
    stiffness : (n, p, 3, 3) t^3 / 12 C times area [N m * m^2]
    """
    curvature, metric, coupling = reference
    energy, local, v, strain = 0.0, np.empty((16, 3)), np.empty((5, 3)), np.empty(3)
    change, moment = np.empty(3), np.empty(3)
    first, H, half = np.empty((3, 5, 3)), np.empty((5, 3, 5, 3)), np.empty((5, 3, 16, 3))
    for e in range(plates.shape[0]):
        _gather(q, plates[e], local)
        for p in range(tables.shape[1]):
            N = tables[e, p]
            _at_point(N, local, v)
            n, J = _unit_normal(v)
            _stretch(v, metric[e, p], strain)
            T = coupling[e, p]
            for row, d in ((0, 2), (1, 4), (2, 3)):
                factor = 2.0 if row == 2 else 1.0
                change[row] = factor * (v[d, 0] * n[0] + v[d, 1] * n[1] + v[d, 2] * n[2]) - curvature[e, p, row]
                _first(v, d, n, J, factor, first[row])
                for m in range(3):
                    change[row] -= T[row, m] * strain[m]
                for i in range(3):
                    first[row, 0, i] -= T[row, 0] * v[0, i] + T[row, 2] * v[1, i]
                    first[row, 1, i] -= T[row, 1] * v[1, i] + T[row, 2] * v[0, i]
            energy += _conjugate(stiffness[e, p], change, moment)
            for k in range(16):
                for i in range(3):
                    value = 0.0
                    for d in range(5):
                        for r in range(3):
                            value += N[1 + d, k] * moment[r] * first[r, d, i]
                    force[e, k, i] += value
            if tangent.shape[0]:
                _second(v, n, J, moment, H)
                for k in range(3):
                    for i in range(3):
                        H[0, i, 0, i] -= moment[k] * T[k, 0]
                        H[1, i, 1, i] -= moment[k] * T[k, 1]
                        H[0, i, 1, i] -= moment[k] * T[k, 2]
                        H[1, i, 0, i] -= moment[k] * T[k, 2]
                for d in range(5):
                    for i in range(3):
                        for c in range(5):
                            for j in range(3):
                                for r in range(3):
                                    for s in range(3):
                                        H[d, i, c, j] += first[r, d, i] * stiffness[e, p, r, s] * first[s, c, j]
                for d in range(5):
                    for i in range(3):
                        for m in range(16):
                            for j in range(3):
                                value = 0.0
                                for c in range(5):
                                    value += H[d, i, c, j] * N[1 + c, m]
                                half[d, i, m, j] = value
                for k in range(16):
                    for i in range(3):
                        for m in range(16):
                            for j in range(3):
                                value = 0.0
                                for d in range(5):
                                    value += N[1 + d, k] * half[d, i, m, j]
                                tangent[e, k, i, m, j] += value
    return energy


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
def _unit_normal(v: Array) -> tuple[Array, float]:
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
def _second(v: Array, n: Array, J: float, moment: Array, H: Array) -> None:
    """Second derivatives of sum of moments times v_d . n by v into H (5, 3, 5, 3)."""
    H[:] = 0.0
    c = np.empty(3)  # as the moments are constant here, one vector stands for all three
    for i in range(3):
        c[i] = moment[0] * v[2, i] + moment[1] * v[4, i] + 2.0 * moment[2] * v[3, i]
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
    by_a, by_c = D.T @ second @ D, P @ D / J
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        by_a[j, 3 + k] += f[i]  # f . (da_1 x da_2)
        by_a[k, 3 + j] -= f[i]
        by_a[3 + k, j] += f[i]
        by_a[3 + j, k] -= f[i]
    for i in range(3):
        for j in range(3):
            for a in range(2):
                for b in range(2):
                    H[a, i, b, j] += by_a[3 * a + i, 3 * b + j]
                for row in range(3):
                    d, factor = (2, 1.0) if row == 0 else (4, 1.0) if row == 1 else (3, 2.0)
                    H[d, i, a, j] += factor * moment[row] * by_c[i, 3 * a + j]
                    H[a, j, d, i] += factor * moment[row] * by_c[i, 3 * a + j]
