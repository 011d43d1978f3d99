"""Compiled loops over hexahedra of any law: mean dilatation, residual, stored stress, plastic history.

Letters as in docs/theory/material_laws.md: G reference gradients of the shape functions, H = F - I, S second
Piola-Kirchhoff stress, CC material tangent, V = J C^-1, w weight times Jacobian, N the functions of dilatation and
pressure within the cell. Three-field form (Simo, Taylor & Pister, Comput. Methods Appl. Mech. Engrg. 51, 1985, 177-208)

    theta = M^-1 int N J dV,    p = M^-1 int N U'(theta) dV,    M = int N N^T dV,
    T = M^-1 (int N N^T U''(theta) dV) M^-1,    h = int N V : DE dV,    dp = N T h du,

with S and CC taken at the pressure p. A part that expands by theta_0 has G divided by it, w times its cube and H of
F/theta_0. Verified by tests/verification/test_fe_laws_cells.py.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from reference_fe.material.point_response import HISTORY, respond, volume_change

__all__ = [
    "CellTables",
    "advance",
    "cauchy_stress",
    "dilatation",
    "gradient_row",
    "internal_force",
    "point_stress",
    "pressure_at",
    "shifted_gradient",
]

Array = NDArray[np.float64]
Index = NDArray[np.int32]


class CellTables(NamedTuple):
    """What the loops know of cells and points; m points, n nodes, k functions of pressure.

    Attributes
    ----------
    G : (n_cells, m, 3, n) [1/m]
    w : (n_cells, m) [m^3]
    N : (m, k) [-]
    dofs : (n_cells, n, 3)
    offset : (n_cells,) 1/theta_0 - 1 [-]
    kinds, constants : (n_cells,), (n_cells, c), see `material.principal_laws`
    bulk : (n_cells,) K of U = K/2 (ln theta)^2 [Pa]; 0 for a compressible law, which has no pressure of its own
    """

    G: Array
    w: Array
    N: Array
    dofs: Index
    offset: Array
    kinds: NDArray[np.int64]
    constants: Array
    bulk: Array


@compiled()
def shifted_gradient(offset: float, G: Array, u: Array, dofs: Index, H: Array) -> None:
    """H (3, 3) = offset I + grad u at one point; G (3, n), dofs (n, 3)."""
    for i in range(3):
        for J in range(3):
            H[i, J] = offset if i == J else 0.0
    for a in range(G.shape[1]):
        for i in range(3):
            value = u[dofs[a, i]]
            for J in range(3):
                H[i, J] += value * G[J, a]


@compiled()
def gradient_row(H: Array, i: int) -> tuple[float, float, float]:
    """Row i of F = I + H."""
    f0, f1, f2 = H[i, 0], H[i, 1], H[i, 2]
    if i == 0:
        f0 += 1.0
    elif i == 1:
        f1 += 1.0
    else:
        f2 += 1.0
    return f0, f1, f2


@compiled(error_model="numpy")
def dilatation(u: Array, t: CellTables, inverse_mass: Array, pressure: Array, stiffness: Array) -> Array:
    """Fill pressure (n_cells, k) [Pa] and stiffness T (n_cells, k, k) [Pa/m^3]; inverse_mass M^-1 likewise [1/m^3].

    Returns
    -------
    energy : (n_cells,) int U(theta) dV [J]
    """
    m, k = t.N.shape
    H, J, right = np.empty((3, 3)), np.empty(k), np.empty(k)  # J: its change
    A, energy = np.empty((k, k)), np.zeros(t.G.shape[0])
    for c in range(t.G.shape[0]):
        pressure[c], stiffness[c] = 0.0, 0.0
        if t.bulk[c] == 0.0:
            continue
        J[:], right[:], A[:] = 0.0, 0.0, 0.0
        for q in range(m):
            shifted_gradient(t.offset[c], t.G[c, q], u, t.dofs[c], H)
            change = volume_change(H)
            for i in range(k):
                J[i] += t.w[c, q] * t.N[q, i] * change
        for q in range(m):
            change = 0.0
            for i in range(k):
                for j in range(k):
                    change += t.N[q, i] * inverse_mass[c, i, j] * J[j]
            theta, log = 1.0 + change, np.log1p(change)
            energy[c] += 0.5 * t.bulk[c] * t.w[c, q] * log * log
            for i in range(k):
                right[i] += t.w[c, q] * t.N[q, i] * t.bulk[c] * log / theta
                for j in range(k):
                    A[i, j] += t.w[c, q] * t.N[q, i] * t.N[q, j] * t.bulk[c] * (1.0 - log) / theta**2
        pressure[c] = inverse_mass[c] @ right
        stiffness[c] = inverse_mass[c] @ A @ inverse_mass[c]
    return energy


@compiled(error_model="numpy")
def pressure_at(N: Array, pressure: Array) -> float:
    value = 0.0
    for i in range(N.shape[0]):
        value += N[i] * pressure[i]
    return value


@compiled(error_model="numpy")
def internal_force(u: Array, t: CellTables, pressure: Array, past: Array, out: Array) -> Array:
    """Add int S : DE[v] dV of every cell to ``out`` (n_dofs,) [N]; return the energy at the points, see `respond`.

    past : (n_cells, m, 7) history of the points before this step

    Returns
    -------
    energy : (n_cells, m) [J/m^3]
    """
    H, S, CC, V, now, P = (
        np.empty((3, 3)),
        np.empty(6),
        np.empty((6, 6)),
        np.empty(6),
        np.empty(HISTORY),
        np.empty((3, 3)),
    )
    energy = np.empty(t.w.shape)
    for c in range(t.G.shape[0]):
        for q in range(t.G.shape[1]):
            G, w = t.G[c, q], t.w[c, q]
            shifted_gradient(t.offset[c], G, u, t.dofs[c], H)
            p = pressure_at(t.N[q], pressure[c])
            energy[c, q] = respond(t.kinds[c], t.constants[c], H, p, past[c, q], S, CC, V, now, False)
            for i in range(3):
                f0, f1, f2 = gradient_row(H, i)
                P[i, 0] = w * (f0 * S[0] + f1 * S[3] + f2 * S[5])
                P[i, 1] = w * (f0 * S[3] + f1 * S[1] + f2 * S[4])
                P[i, 2] = w * (f0 * S[5] + f1 * S[4] + f2 * S[2])
            for a in range(G.shape[1]):
                for i in range(3):
                    out[t.dofs[c, a, i]] += P[i, 0] * G[0, a] + P[i, 1] * G[1, a] + P[i, 2] * G[2, a]
    return energy


@compiled(error_model="numpy")
def point_stress(
    u: Array, du: Array, t: CellTables, pressure: Array, stiffness: Array, past: Array, out: Array
) -> None:
    """Extrapolated stress without pressure, S_0 + CC_0 : DE[du], into ``out`` (n_cells, m, 6) [Pa]; pressure likewise.

    pressure : (n_cells, k), becomes p + T h du [Pa]
    """
    m, k = t.N.shape
    H, dH, S, CC, now = np.empty((3, 3)), np.empty((3, 3)), np.empty(6), np.empty((6, 6)), np.empty(HISTORY)
    V, dE, h = np.empty(6), np.empty(6), np.empty(k)
    for c in range(t.G.shape[0]):
        h[:] = 0.0
        for q in range(m):
            shifted_gradient(t.offset[c], t.G[c, q], u, t.dofs[c], H)
            shifted_gradient(0.0, t.G[c, q], du, t.dofs[c], dH)
            respond(t.kinds[c], t.constants[c], H, 0.0, past[c, q], S, CC, V, now, True)
            volume = 0.0
            for v in range(6):
                i, j = v % 3, (v % 3 if v < 3 else (v + 1) % 3)
                dE[v] = dH[i, j] + dH[j, i]
                for r in range(3):
                    dE[v] += H[r, i] * dH[r, j] + dH[r, i] * H[r, j]
                if v < 3:
                    dE[v] *= 0.5
                volume += V[v] * dE[v]
            for i in range(k):
                h[i] += t.w[c, q] * t.N[q, i] * volume
            for v in range(6):
                out[c, q, v] = S[v]
                for r in range(6):
                    out[c, q, v] += CC[v, r] * dE[r]
        pressure[c] += stiffness[c] @ h


@compiled(error_model="numpy")
def advance(u: Array, t: CellTables, pressure: Array, past: Array) -> None:
    """Replace the history of every point by that after the step to u."""
    H, S, CC, V, now = np.empty((3, 3)), np.empty(6), np.empty((6, 6)), np.empty(6), np.empty(HISTORY)
    for c in range(t.G.shape[0]):
        for q in range(t.G.shape[1]):
            shifted_gradient(t.offset[c], t.G[c, q], u, t.dofs[c], H)
            p = pressure_at(t.N[q], pressure[c])
            respond(t.kinds[c], t.constants[c], H, p, past[c, q], S, CC, V, now, False)
            past[c, q] = now


@compiled(error_model="numpy")
def cauchy_stress(u: Array, t: CellTables, pressure: Array, past: Array) -> Array:
    """Cauchy stress F S F^T / J of the step to u at every point, (n_cells, m, 3, 3) [Pa]."""
    H, S, CC, V, now = np.empty((3, 3)), np.empty(6), np.empty((6, 6)), np.empty(6), np.empty(HISTORY)
    out = np.empty((t.G.shape[0], t.G.shape[1], 3, 3))
    F, full = np.empty((3, 3)), np.empty((3, 3))
    for c in range(t.G.shape[0]):
        for q in range(t.G.shape[1]):
            shifted_gradient(t.offset[c], t.G[c, q], u, t.dofs[c], H)
            p = pressure_at(t.N[q], pressure[c])
            respond(t.kinds[c], t.constants[c], H, p, past[c, q], S, CC, V, now, False)
            for v in range(6):
                i, j = v % 3, (v % 3 if v < 3 else (v + 1) % 3)
                full[i, j], full[j, i] = S[v], S[v]
            F[:] = H
            for i in range(3):
                F[i, i] += 1.0
            out[c, q] = F @ full @ F.T / (1.0 + volume_change(H))
    return out
