"""Compiled loop over hexahedra of any law: tangent with the pressure condensed.

With the letters of `general_kernels`, S_m and p_m the stored stress without pressure and the stored pressure, B
(6, 3 n) such that B du = DE = sym(F^T grad du), its shears twice, the 3 x 3 block of nodes a and b is

    K_ab = int B_a^T CC(p_m) B_b + (G_a . (S_m + p_m V) G_b) I dV + (h^T T h)_ab,

each integral one product of matrices over all points of a cell. Verified by tests/verification/test_fe_laws_cells.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.cells.block_matrix import BlockRows, Places, add_block
from reference_fe.cells.general_kernels import CellTables, gradient_row, pressure_at, shifted_gradient
from reference_fe.compiled import compiled
from reference_fe.material.point_response import HISTORY, respond

__all__ = ["add_tangent"]

Array = NDArray[np.float64]
Index = NDArray[np.int32]


@compiled(error_model="numpy")
def add_tangent(
    u: Array,
    stress: Array,
    t: CellTables,
    pressure: Array,
    stiffness: Array,
    past: Array,
    rows: BlockRows,
    places: Places,
    values: Array,
) -> None:
    """Add the condensed tangent of every cell to the values of a matrix.

    Parameters
    ----------
    stress, pressure : (n_cells, m, 6) and (n_cells, k) what is stored of S_0 and p [Pa]
    stiffness : (n_cells, k, k) T at u [Pa/m^3]
    rows, places, values : as in `cells.kernels.add_tangent`
    u, t, past : as in the other loops
    """
    m, k = t.N.shape
    n = t.G.shape[3]
    H, S, CC, V, now = np.empty((3, 3)), np.empty(6), np.empty((6, 6)), np.empty(6), np.empty(HISTORY)
    B, CB = np.empty((6 * m, 3 * n)), np.empty((6 * m, 3 * n))
    G, SG, Z = np.empty((3 * m, n)), np.empty((3 * m, n)), np.empty((k, 6 * m))
    for c in range(t.G.shape[0]):
        for q in range(m):
            w = t.w[c, q]
            shifted_gradient(t.offset[c], t.G[c, q], u, t.dofs[c], H)
            p = pressure_at(t.N[q], pressure[c])
            respond(t.kinds[c], t.constants[c], H, p, past[c, q], S, CC, V, now, True)
            _strain_matrix(H, t.G[c, q], B[6 * q : 6 * q + 6])
            _times(w, CC, B[6 * q : 6 * q + 6], CB[6 * q : 6 * q + 6])
            for i in range(k):
                for v in range(6):
                    Z[i, 6 * q + v] = w * t.N[q, i] * V[v]
            for v in range(6):
                S[v] = stress[c, q, v] + p * V[v]
            _geometric_factors(w, S, t.G[c, q], G[3 * q : 3 * q + 3], SG[3 * q : 3 * q + 3])
        K = np.dot(B.T, CB)
        geometric = np.dot(G.T, SG)
        if t.bulk[c] != 0.0:
            h = np.dot(Z, B)
            K += np.dot(h.T, np.dot(stiffness[c], h))
        _scatter(K, geometric, t.dofs[c], rows, places[c], values)


@compiled(error_model="numpy")
def _strain_matrix(H: Array, G: Array, B: Array) -> None:
    """B (6, 3 n) with DE = B du, shears twice."""
    for a in range(G.shape[1]):
        for i in range(3):
            f0, f1, f2 = gradient_row(H, i)
            column = 3 * a + i
            B[0, column], B[1, column], B[2, column] = f0 * G[0, a], f1 * G[1, a], f2 * G[2, a]
            B[3, column] = f0 * G[1, a] + f1 * G[0, a]
            B[4, column] = f1 * G[2, a] + f2 * G[1, a]
            B[5, column] = f2 * G[0, a] + f0 * G[2, a]


@compiled(error_model="numpy", fastmath={"contract", "reassoc"})
def _times(w: float, CC: Array, B: Array, CB: Array) -> None:
    """CB (6, 3 n) = w CC B."""
    for v in range(6):
        for column in range(B.shape[1]):
            value = 0.0
            for r in range(6):
                value += CC[v, r] * B[r, column]
            CB[v, column] = w * value


@compiled(error_model="numpy")
def _geometric_factors(w: float, S: Array, G: Array, out: Array, SG: Array) -> None:
    """Copy of G (3, n), and w S G."""
    for a in range(G.shape[1]):
        for i in range(3):
            out[i, a] = G[i, a]
        SG[0, a] = w * (S[0] * G[0, a] + S[3] * G[1, a] + S[5] * G[2, a])
        SG[1, a] = w * (S[3] * G[0, a] + S[1] * G[1, a] + S[4] * G[2, a])
        SG[2, a] = w * (S[5] * G[0, a] + S[4] * G[1, a] + S[2] * G[2, a])


@compiled()
def _scatter(K: Array, geometric: Array, dofs: Index, rows: BlockRows, places: Places, values: Array) -> None:
    """Add K (3 n, 3 n), and geometric (n, n) on the diagonals of its blocks, to the values of a matrix."""
    block = np.empty((3, 3))
    for a in range(dofs.shape[0]):
        for b in range(dofs.shape[0]):
            if places[a, b] >= 0:
                block[:] = K[3 * a : 3 * a + 3, 3 * b : 3 * b + 3]
                for i in range(3):
                    block[i, i] += geometric[a, b]
                add_block(rows, dofs[a, 0] // 3, places[a, b], block, values)
