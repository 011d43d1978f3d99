"""Compiled loops over 27-node hexahedra of St. Venant-Kirchhoff material: residual, tangent, stored stress.

Letters as in docs/theory.md 2: G reference gradients of the shape functions, H = grad u, F = I + H, S second
Piola-Kirchhoff stress, w weight times Jacobian; lam, mu Lame parameters, s the stress offset of free thermal expansion
(`hyperelastic.thermal_moduli`). The tangent's 3 x 3 block of nodes a and b is

    K_ab = sum_q w [ lam f_a f_b^T + mu (f_b f_a^T + (G_a . G_b) F F^T) + (G_a . S_m G_b) I ],   f_a = F G_a,

the isotropic case of A : grad written out, with S_m the stress stored at the point (theory 2.3). This module is the one
that imports numba here. Verified by tests/verification/test_fe_cells.py against the UFL forms.
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["add_tangent", "internal_force", "point_stress"]

Array = NDArray[np.float64]
Index = NDArray[np.int32]


@numba.njit(cache=True)
def _displacement_gradient(G: Array, u: Array, dofs: Index, H: Array) -> None:
    """H (3, 3) at one point; G (3, n), dofs (n, 3) of the cell."""
    H[:] = 0.0
    for a in range(G.shape[1]):
        for i in range(3):
            value = u[dofs[a, i]]
            for J in range(3):
                H[i, J] += value * G[J, a]


@numba.njit(cache=True)
def _second_piola(H: Array, moduli: Array, S: Array) -> None:
    """S (3, 3) = lam tr(E) I + 2 mu E + s I with E = (H + H^T + H^T H)/2 [Pa]; moduli (3,) lam, mu, s [Pa]."""
    lam, mu, offset = moduli[0], moduli[1], moduli[2]
    for i in range(3):
        for j in range(3):
            S[i, j] = mu * (H[i, j] + H[j, i] + H[0, i] * H[0, j] + H[1, i] * H[1, j] + H[2, i] * H[2, j])
    normal = lam / (2.0 * mu) * (S[0, 0] + S[1, 1] + S[2, 2]) + offset
    for i in range(3):
        S[i, i] += normal


@numba.njit(cache=True)
def internal_force(u: Array, G: Array, w: Array, moduli: Array, dofs: Index, out: Array) -> None:
    """Add int S : DE[v] dV of every cell to ``out`` (n_dofs,) [N].

    Parameters
    ----------
    u : (n_dofs,) [m]
    G : (n_cells, n_points, 3, n_nodes) [1/m]
    w : (n_cells, n_points) [m^3]
    moduli : (n_cells, 3) lambda, mu, stress offset [Pa]
    dofs : (n_cells, n_nodes, 3)
    """
    H, S, P = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for c in range(G.shape[0]):
        for q in range(G.shape[1]):
            _displacement_gradient(G[c, q], u, dofs[c], H)
            _second_piola(H, moduli[c], S)
            for i in range(3):
                for J in range(3):
                    P[i, J] = w[c, q] * (S[i, J] + H[i, 0] * S[0, J] + H[i, 1] * S[1, J] + H[i, 2] * S[2, J])
            for a in range(G.shape[3]):
                for i in range(3):
                    out[dofs[c, a, i]] += P[i, 0] * G[c, q, 0, a] + P[i, 1] * G[c, q, 1, a] + P[i, 2] * G[c, q, 2, a]


@numba.njit(cache=True)
def point_stress(u: Array, du: Array, G: Array, moduli: Array, dofs: Index, out: Array) -> None:
    """Extrapolated stress S(E(u)) + CC : DE(u)[du] at every point into ``out`` (n_cells, n_points, 3, 3) [Pa]."""
    H, dH, S = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for c in range(G.shape[0]):
        lam, mu = moduli[c, 0], moduli[c, 1]
        for q in range(G.shape[1]):
            _displacement_gradient(G[c, q], u, dofs[c], H)
            _displacement_gradient(G[c, q], du, dofs[c], dH)
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


@numba.njit(cache=True, fastmath={"contract", "reassoc"})
def add_tangent(
    u: Array,
    stress: Array,
    G: Array,
    w: Array,
    moduli: Array,
    dofs: Index,
    indptr: Index,
    blocks: Index,
    values: Array,
) -> None:
    """Add the tangent of every cell to CSR values.

    Parameters
    ----------
    stress : (n_cells, n_points, 3, 3) stored stress S_m [Pa]
    indptr : (n_dofs + 1,) row starts of the matrix
    blocks : (n_cells, n_nodes, n_nodes) place of node b's three columns within the rows of node a
    values : (nnz,) [N/m]
    u, G, w, moduli, dofs : as in `internal_force`
    """
    n = G.shape[3]
    H, F, B = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    f, s = np.empty((3, n)), np.empty((3, n))
    P, D = np.empty((3, n, 3, n)), np.empty((6, n, n))
    for c in range(G.shape[0]):
        P[:] = 0.0
        D[:] = 0.0
        lam, mu = moduli[c, 0], moduli[c, 1]
        for q in range(G.shape[1]):
            g, S = G[c, q], stress[c, q]
            _displacement_gradient(g, u, dofs[c], H)
            for i in range(3):
                for j in range(3):
                    F[i, j] = H[i, j] + (1.0 if i == j else 0.0)
            for i in range(3):
                for j in range(3):
                    B[i, j] = mu * (F[i, 0] * F[j, 0] + F[i, 1] * F[j, 1] + F[i, 2] * F[j, 2])
                for a in range(n):
                    f[i, a] = F[i, 0] * g[0, a] + F[i, 1] * g[1, a] + F[i, 2] * g[2, a]
                    s[i, a] = S[i, 0] * g[0, a] + S[i, 1] * g[1, a] + S[i, 2] * g[2, a]
            _add_point(w[c, q], g, f, s, B, P, D)
        for a in range(n):
            for i in range(3):
                start = indptr[dofs[c, a, i]]
                for b in range(n):
                    place = start + blocks[c, a, b]
                    for k in range(3):
                        diagonal = D[i, a, b] if i == k else D[2 + i + k, a, b]
                        values[place + k] += lam * P[i, a, k, b] + mu * P[k, a, i, b] + diagonal


@numba.njit(cache=True, fastmath={"contract", "reassoc"})
def _add_point(w: float, g: Array, f: Array, s: Array, B: Array, P: Array, D: Array) -> None:
    """One point's share: P_iakb += w f_ia f_kb; D the six blocks (xx, yy, zz, xy, xz, yz) of the rest."""
    n = g.shape[1]
    for a in range(n):
        g0, g1, g2 = w * g[0, a], w * g[1, a], w * g[2, a]
        s0, s1, s2 = w * s[0, a], w * s[1, a], w * s[2, a]
        f0, f1, f2 = w * f[0, a], w * f[1, a], w * f[2, a]
        for b in range(n):
            gg = g0 * g[0, b] + g1 * g[1, b] + g2 * g[2, b]
            gs = s0 * g[0, b] + s1 * g[1, b] + s2 * g[2, b]
            D[0, a, b] += B[0, 0] * gg + gs
            D[1, a, b] += B[1, 1] * gg + gs
            D[2, a, b] += B[2, 2] * gg + gs
            D[3, a, b] += B[0, 1] * gg
            D[4, a, b] += B[0, 2] * gg
            D[5, a, b] += B[1, 2] * gg
            P[0, a, 0, b] += f0 * f[0, b]
            P[0, a, 1, b] += f0 * f[1, b]
            P[0, a, 2, b] += f0 * f[2, b]
            P[1, a, 0, b] += f1 * f[0, b]
            P[1, a, 1, b] += f1 * f[1, b]
            P[1, a, 2, b] += f1 * f[2, b]
            P[2, a, 0, b] += f2 * f[0, b]
            P[2, a, 1, b] += f2 * f[1, b]
            P[2, a, 2, b] += f2 * f[2, b]
