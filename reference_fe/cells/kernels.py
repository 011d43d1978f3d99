"""Compiled loops over hexahedra of St. Venant-Kirchhoff material: residual, tangent, stored stress.

Letters as in docs/theory.md 2: G gradients of the shape functions, made from those in the reference cell as they are
needed because all of them would be the largest table of a problem, H = grad u, F = I + H, S second
Piola-Kirchhoff stress, w weight times Jacobian; lam, mu Lame parameters, s the stress offset of free thermal expansion
(`hyperelastic.thermal_moduli`). The tangent's 3 x 3 block of nodes a and b is

    K_ab = sum_q w [ lam f_a f_b^T + mu (f_b f_a^T + (G_a . G_b) F F^T) + (G_a . S_m G_b) I ],   f_a = F G_a,

the isotropic case of A : grad written out, with S_m the stress stored at the point (theory 2.3). This module is the one
that imports numba here. Verified by tests/verification/test_fe_cells.py against the UFL forms.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.cells.block_matrix import BlockRows, Places, add_block
from reference_fe.compiled import compiled

__all__ = ["add_tangent", "internal_force", "point_stress"]

Array = NDArray[np.float64]
Index = NDArray[np.int32]


@compiled()
def _gradients(shape: Array, inverse: Array, G: Array) -> None:
    """G (3, n) at one point from the reference cell's, shape (3, n), and the inverse (3, 3) of dX/dxi."""
    for a in range(shape.shape[1]):
        for J in range(3):
            G[J, a] = inverse[0, J] * shape[0, a] + inverse[1, J] * shape[1, a] + inverse[2, J] * shape[2, a]


@compiled()
def _displacement_gradient(G: Array, u: Array, dofs: Index, H: Array) -> None:
    """H (3, 3) at one point; G (3, n), dofs (n, 3) of the cell."""
    H[:] = 0.0
    for a in range(G.shape[1]):
        for i in range(3):
            value = u[dofs[a, i]]
            for J in range(3):
                H[i, J] += value * G[J, a]


@compiled()
def _second_piola(H: Array, moduli: Array, S: Array) -> None:
    """S (3, 3) = lam tr(E) I + 2 mu E + s I with E = (H + H^T + H^T H)/2 [Pa]; moduli (3,) lam, mu, s [Pa]."""
    lam, mu, offset = moduli[0], moduli[1], moduli[2]
    for i in range(3):
        for j in range(3):
            S[i, j] = mu * (H[i, j] + H[j, i] + H[0, i] * H[0, j] + H[1, i] * H[1, j] + H[2, i] * H[2, j])
    normal = lam / (2.0 * mu) * (S[0, 0] + S[1, 1] + S[2, 2]) + offset
    for i in range(3):
        S[i, i] += normal


@compiled()
def internal_force(u: Array, shape: Array, inverse: Array, w: Array, moduli: Array, dofs: Index, out: Array) -> None:
    """Add int S : DE[v] dV of every cell to ``out`` (n_dofs,) [N].

    Parameters
    ----------
    u : (n_dofs,) [m]
    shape : (n_points, 3, n_nodes) gradients in the reference cell [-]
    inverse : (n_cells, n_points, 3, 3) inverse of dX_i/dxi_j, xi first [1/m]
    w : (n_cells, n_points) [m^3]
    moduli : (n_cells, 3) lambda, mu, stress offset [Pa]
    dofs : (n_cells, n_nodes, 3)
    """
    H, S, P, G = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty(shape.shape[1:])
    for c in range(dofs.shape[0]):
        for q in range(shape.shape[0]):
            _gradients(shape[q], inverse[c, q], G)
            _displacement_gradient(G, u, dofs[c], H)
            _second_piola(H, moduli[c], S)
            for i in range(3):
                for J in range(3):
                    P[i, J] = w[c, q] * (S[i, J] + H[i, 0] * S[0, J] + H[i, 1] * S[1, J] + H[i, 2] * S[2, J])
            for a in range(G.shape[1]):
                for i in range(3):
                    out[dofs[c, a, i]] += P[i, 0] * G[0, a] + P[i, 1] * G[1, a] + P[i, 2] * G[2, a]


@compiled()
def point_stress(u: Array, du: Array, shape: Array, inverse: Array, moduli: Array, dofs: Index, out: Array) -> None:
    """Extrapolated stress S(E(u)) + CC : DE(u)[du] at every point into ``out`` (n_cells, n_points, 3, 3) [Pa]."""
    H, dH, S, G = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty(shape.shape[1:])
    for c in range(dofs.shape[0]):
        lam, mu = moduli[c, 0], moduli[c, 1]
        for q in range(shape.shape[0]):
            _gradients(shape[q], inverse[c, q], G)
            _displacement_gradient(G, u, dofs[c], H)
            _displacement_gradient(G, du, dofs[c], dH)
            _second_piola(H, moduli[c], S)
            trace = 0.0
            for i in range(3):
                for j in range(3):
                    twice = dH[i, j] + dH[j, i]
                    for k in range(3):
                        twice += H[k, i] * dH[k, j] + dH[k, i] * H[k, j]
                    out[c, q, i, j] = S[i, j] + mu * twice
                    if i == j:
                        trace += 0.5 * twice
            for i in range(3):
                out[c, q, i, i] += lam * trace


@compiled(fastmath={"contract", "reassoc"})
def add_tangent(
    u: Array,
    stress: Array,
    shape: Array,
    inverse: Array,
    w: Array,
    moduli: Array,
    dofs: Index,
    rows: BlockRows,
    places: Places,
    values: Array,
) -> None:
    """Add the tangent of every cell to the values of a matrix.

    Parameters
    ----------
    stress : (n_cells, n_points, 3, 3) stored stress S_m [Pa]
    rows, values : the matrix and its values [N/m]
    places : (n_cells, n_nodes, n_nodes) see `block_matrix.block_places`
    u, shape, inverse, w, moduli, dofs : as in `internal_force`
    """
    n, m = shape.shape[2], shape.shape[0]
    H, block, G = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, n))
    g, f, s, B = np.empty((3, n, m)), np.empty((3, n, m)), np.empty((3, n, m)), np.empty((6, m))
    for c in range(dofs.shape[0]):
        for q in range(m):
            _gradients(shape[q], inverse[c, q], G)
            _displacement_gradient(G, u, dofs[c], H)
            _point_factors(w[c, q], moduli[c, 1], H, stress[c, q], G, q, g, f, s, B)
        for a in range(n):
            for b in range(a + 1):
                _node_pair(a, b, moduli[c, 0], moduli[c, 1], w[c], g, f, s, B, block)
                if places[c, a, b] >= 0:
                    add_block(rows, dofs[c, a, 0] // 3, places[c, a, b], block, values)
                if b < a and places[c, b, a] >= 0:
                    add_block(rows, dofs[c, b, 0] // 3, places[c, b, a], block.T, values)


@compiled(fastmath={"contract", "reassoc"}, error_model="numpy")
def _point_factors(
    w: float, mu: float, H: Array, S: Array, G: Array, q: int, g: Array, f: Array, s: Array, B: Array
) -> None:
    """Put G, f_a = F G_a, s_a = w S_m G_a and w mu F F^T (xx, yy, zz, xy, xz, yz) of point q in place, points last."""
    F = np.eye(3) + H
    for i in range(3):
        B[i, q] = w * mu * (F[i, 0] * F[i, 0] + F[i, 1] * F[i, 1] + F[i, 2] * F[i, 2])
        for j in range(i):
            B[2 + i + j, q] = w * mu * (F[i, 0] * F[j, 0] + F[i, 1] * F[j, 1] + F[i, 2] * F[j, 2])
        for a in range(G.shape[1]):
            g[i, a, q] = G[i, a]
            f[i, a, q] = F[i, 0] * G[0, a] + F[i, 1] * G[1, a] + F[i, 2] * G[2, a]
            s[i, a, q] = w * (S[i, 0] * G[0, a] + S[i, 1] * G[1, a] + S[i, 2] * G[2, a])


@compiled(fastmath={"contract", "reassoc"}, error_model="numpy")
def _node_pair(
    a: int, b: int, lam: float, mu: float, w: Array, g: Array, f: Array, s: Array, B: Array, K: Array
) -> None:
    """Block K_ab (3, 3) of one cell: sums over the points in registers, as vectors; nothing but K is written."""
    p00 = p01 = p02 = p10 = p11 = p12 = p20 = p21 = p22 = 0.0
    xx = yy = zz = xy = xz = yz = geometric = 0.0
    for q in range(w.shape[0]):
        gg = g[0, a, q] * g[0, b, q] + g[1, a, q] * g[1, b, q] + g[2, a, q] * g[2, b, q]
        geometric += s[0, a, q] * g[0, b, q] + s[1, a, q] * g[1, b, q] + s[2, a, q] * g[2, b, q]
        xx += B[0, q] * gg
        yy += B[1, q] * gg
        zz += B[2, q] * gg
        xy += B[3, q] * gg
        xz += B[4, q] * gg
        yz += B[5, q] * gg
    for q in range(w.shape[0]):
        f0, f1, f2 = w[q] * f[0, a, q], w[q] * f[1, a, q], w[q] * f[2, a, q]
        p00 += f0 * f[0, b, q]
        p01 += f0 * f[1, b, q]
        p02 += f0 * f[2, b, q]
        p10 += f1 * f[0, b, q]
        p11 += f1 * f[1, b, q]
        p12 += f1 * f[2, b, q]
        p20 += f2 * f[0, b, q]
        p21 += f2 * f[1, b, q]
        p22 += f2 * f[2, b, q]
    K[0, 0] = (lam + mu) * p00 + xx + geometric
    K[1, 1] = (lam + mu) * p11 + yy + geometric
    K[2, 2] = (lam + mu) * p22 + zz + geometric
    K[0, 1], K[1, 0] = lam * p01 + mu * p10 + xy, lam * p10 + mu * p01 + xy
    K[0, 2], K[2, 0] = lam * p02 + mu * p20 + xz, lam * p20 + mu * p02 + xz
    K[1, 2], K[2, 1] = lam * p12 + mu * p21 + yz, lam * p21 + mu * p12 + yz
