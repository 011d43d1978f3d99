"""Stress, tangent and plastic history at one point from the deformation gradient, for every law of `principal_laws`.

With C_p^-1 = L L^T, the inverse plastic right Cauchy-Green tensor (unit where nothing yields), the energy is an
isotropic function of C* = L^T C L = sum x_a N_a N_a, whose eigenvalues are those of b_e = F C_p^-1 F^T. With
M_a = L N_a

    S = sum_a S_a M_a M_a,                     S_a = (tau_a + J p) / x_a,
    CC = sum_ab (D_ab + J p - 2 (tau_a + J p) delta_ab) / (x_a x_b)  M_a M_a M_b M_b
       + sum_{a<b} (S_b - S_a) / (x_b - x_a)  (M_a M_b + M_b M_a) (M_a M_b + M_b M_a),
    (S_b - S_a) / (x_b - x_a) = d_ab / x_b - (tau_a + J p) / (x_a x_b),
    C_p^-1  <-  sum_a exp(-2 flow_a) M_a M_a,        J C^-1 = J sum_a M_a M_a / x_a,

p the pressure (tension positive) that the cell's dilatation gives. Everything is in the undeformed body: objective by
construction. Tensors are (11, 22, 33, 12, 23, 13). Verified by tests/unit/test_fe_point_laws.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from reference_fe.material.principal_axes import principal_axes
from reference_fe.material.principal_laws import PAIRS, principal_stress

__all__ = ["HISTORY", "VIRGIN", "respond", "volume_change"]

Array = NDArray[np.float64]
HISTORY = 7
"""Numbers of a point's history: C_p^-1 and the equivalent plastic strain [-]."""
VIRGIN = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
"""History of a point that never yielded."""


@compiled(error_model="numpy")
def volume_change(H: Array) -> float:
    """det(I + H) - 1 without the loss of digits where H is small [-]."""
    first = H[1, 1] * H[2, 2] - H[1, 2] * H[2, 1]
    second = H[1, 0] * H[2, 2] - H[1, 2] * H[2, 0]
    third = H[1, 0] * H[2, 1] - H[1, 1] * H[2, 0]
    trace = H[0, 0] + H[1, 1] + H[2, 2]
    minors = H[0, 0] * H[1, 1] - H[0, 1] * H[1, 0] + H[0, 0] * H[2, 2] - H[0, 2] * H[2, 0] + first
    value: float = trace + minors + H[0, 0] * first - H[0, 1] * second + H[0, 2] * third
    return value


@compiled(error_model="numpy")
def respond(
    kind: int, c: Array, H: Array, p: float, past: Array, S: Array, CC: Array, V: Array, now: Array, tangent: bool
) -> float:
    """Fill S (6,), CC (6, 6) [Pa], V = J C^-1 (6,) [-] and the history now (7,); return the energy [J/m^3].

    Parameters
    ----------
    kind, c : law and its constants, see `principal_laws`
    H : (3, 3) F - I
    p : pressure of the dilatation, tension positive [Pa]; 0 for a law that is compressible by itself
    past : (7,) history before this step
    tangent : whether CC is wanted; else it keeps what it holds

    Returns
    -------
    energy : of `principal_laws`, the volumetric part of nearly incompressible laws left out
    """
    J = 1.0 + volume_change(H)
    if not J > 0.0:  # inside out: no state of any law
        S[:], CC[:], V[:], now[:] = np.nan, np.nan, np.nan, past
        return np.nan
    L, A, N, M = np.zeros((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    e, tau, d, flow, D = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty((3, 3))
    _cholesky(past, L)
    _elastic_strain(H, L, A)
    principal_axes(A, e, N)
    for i in range(3):
        for a in range(3):
            M[i, a] = L[i, 0] * N[0, a] + L[i, 1] * N[1, a] + L[i, 2] * N[2, a]
    growth, energy = principal_stress(kind, c, e, past[6], tau, D, d, flow)
    for a in range(3):
        tau[a] += J * p
        for b in range(3):
            D[a, b] += J * p
    _tensors(J, e, tau, M, S, V)
    if tangent:
        _tangent(e, tau, D, d, M, CC)
    now[:] = past
    if growth > 0.0:
        now[6] += growth
        for v in range(6):
            i, j = v % 3, (v % 3 if v < 3 else (v + 1) % 3)
            now[v] = 0.0
            for a in range(3):
                now[v] += np.exp(-2.0 * flow[a]) * M[i, a] * M[j, a]
    return energy


@compiled(error_model="numpy")
def _cholesky(A: Array, L: Array) -> None:
    """L lower triangular with L L^T = A, A of six numbers."""
    L[0, 0] = np.sqrt(A[0])
    L[1, 0], L[2, 0] = A[3] / L[0, 0], A[5] / L[0, 0]
    L[1, 1] = np.sqrt(A[1] - L[1, 0] ** 2)
    L[2, 1] = (A[4] - L[2, 0] * L[1, 0]) / L[1, 1]
    L[2, 2] = np.sqrt(A[2] - L[2, 0] ** 2 - L[2, 1] ** 2)


@compiled(error_model="numpy")
def _elastic_strain(H: Array, L: Array, A: Array) -> None:
    """A = L^T C L - I = L^T (C - I) L + (L^T L - I)."""
    E, EL = np.empty((3, 3)), np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            E[i, j] = H[i, j] + H[j, i] + H[0, i] * H[0, j] + H[1, i] * H[1, j] + H[2, i] * H[2, j]
    for i in range(3):
        for j in range(3):
            EL[i, j] = E[i, 0] * L[0, j] + E[i, 1] * L[1, j] + E[i, 2] * L[2, j]
    for i in range(3):
        for j in range(3):
            plastic = L[0, i] * L[0, j] + L[1, i] * L[1, j] + L[2, i] * L[2, j] - (1.0 if i == j else 0.0)
            A[i, j] = L[0, i] * EL[0, j] + L[1, i] * EL[1, j] + L[2, i] * EL[2, j] + plastic


@compiled(error_model="numpy")
def _tensors(J: float, e: Array, tau: Array, M: Array, S: Array, V: Array) -> None:
    """S and V from principal values and the vectors M_a, columns of M."""
    for v in range(6):
        i, j = v % 3, (v % 3 if v < 3 else (v + 1) % 3)
        S[v], V[v] = 0.0, 0.0
        for a in range(3):
            S[v] += M[i, a] * M[j, a] * tau[a] / (1.0 + e[a])
            V[v] += M[i, a] * M[j, a] * J / (1.0 + e[a])


@compiled(error_model="numpy")
def _tangent(e: Array, tau: Array, D: Array, d: Array, M: Array, CC: Array) -> None:
    """CC from the same."""
    P, PK, K, shear = np.empty((6, 6)), np.empty((6, 3)), np.empty((3, 3)), np.empty(3)
    for v in range(6):
        i, j = v % 3, (v % 3 if v < 3 else (v + 1) % 3)
        for a in range(3):
            P[v, a] = M[i, a] * M[j, a]
        for k in range(3):
            a, b = PAIRS[k]
            P[v, 3 + k] = M[i, a] * M[j, b] + M[i, b] * M[j, a]
    for a in range(3):
        for b in range(3):
            K[a, b] = D[a, b] / ((1.0 + e[a]) * (1.0 + e[b]))
        K[a, a] -= 2.0 * tau[a] / (1.0 + e[a]) ** 2
    for k in range(3):
        a, b = PAIRS[k]
        shear[k] = d[k] / (1.0 + e[b]) - tau[a] / ((1.0 + e[a]) * (1.0 + e[b]))
    for v in range(6):
        for a in range(3):
            PK[v, a] = P[v, 0] * K[0, a] + P[v, 1] * K[1, a] + P[v, 2] * K[2, a]
        for w in range(v + 1):
            value = PK[v, 0] * P[w, 0] + PK[v, 1] * P[w, 1] + PK[v, 2] * P[w, 2]
            for k in range(3):
                value += shear[k] * P[v, 3 + k] * P[w, 3 + k]
            CC[v, w] = CC[w, v] = value
