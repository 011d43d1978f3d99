"""Compiled loops over all plates of a mesh: strain energy, elastic force and exact tangent.

General continuum mechanics with the St. Venant-Kirchhoff law, thesis eqs. 2.9, 2.10 (mended) and 2.23. Letters, per
integration point: p (16, 3) the plate's structure coordinates; G (3, 16) = d s / d X, the shape functions' derivatives
with respect to the stress-free reference configuration (J0^-1 and T folded in); F = dr/dX = Je J0^-1; E = 1/2 (F^T F -
I); S = lambda tr(E) I + 2 mu E; w = weight * dV0. The callers are in plate_model.py; the only numba import is here.
Verified by tests/unit/test_ancf_plate_model.py (finite differences) and
tests/verification/test_ancf_plate_reference.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numba
import numpy as np
from numpy.typing import NDArray

__all__ = ["elastic_energy_kernel", "elastic_force_kernel", "elastic_tangent_kernel"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def _compiled[F: Callable[..., object]](function: F) -> F:
    """Compile with numba, cached on disk; sums may be re-associated and contracted, nothing else is relaxed."""
    jit = numba.njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
    return cast(F, jit(function))


@_compiled
def _gather(p: FloatArray, nodes: IntArray, e: FloatArray) -> None:
    """Copy the plate's 16 coordinate vectors from p (n_nodes, 4, 3) to e (3, 16)."""
    for k in range(4):
        for c in range(4):
            for i in range(3):
                e[i, 4 * k + c] = p[nodes[k], c, i]


@_compiled
def _strain(e: FloatArray, G: FloatArray, F: FloatArray, E: FloatArray) -> None:
    """F = e G^T (thesis eq. 2.9) and Green-Lagrange E = 1/2 (F^T F - I) (thesis eq. 2.10, mended)."""
    for i in range(3):
        for k in range(3):
            total = 0.0
            for a in range(16):
                total += e[i, a] * G[k, a]
            F[i, k] = total
    for k in range(3):
        for m in range(3):
            total = F[0, k] * F[0, m] + F[1, k] * F[1, m] + F[2, k] * F[2, m]
            E[k, m] = 0.5 * (total - 1.0) if k == m else 0.5 * total


@_compiled
def elastic_energy_kernel(
    p: FloatArray, elements: IntArray, G: FloatArray, w: FloatArray, lame: tuple[float, float]
) -> float:
    """Strain energy [J] of all plates, U = sum w (lambda/2 tr(E)^2 + mu E:E); arguments as the force kernel."""
    e, F, E = np.empty((3, 16)), np.empty((3, 3)), np.empty((3, 3))
    energy = 0.0
    for j in range(elements.shape[0]):
        _gather(p, elements[j], e)
        for g in range(w.shape[1]):
            _strain(e, G[j, g], F, E)
            square = 0.0
            for k in range(3):
                for m in range(3):
                    square += E[k, m] * E[k, m]
            trace = E[0, 0] + E[1, 1] + E[2, 2]
            energy += w[j, g] * (0.5 * lame[0] * trace * trace + lame[1] * square)
    return energy


@_compiled
def elastic_force_kernel(
    p: FloatArray, elements: IntArray, G: FloatArray, w: FloatArray, lame: tuple[float, float], force: FloatArray
) -> None:
    """Generalised elastic force Q_s = dU/dp of all plates (thesis eq. 2.23).

    Parameters
    ----------
    p : (n_nodes, 4, 3) float [m, -], structure coordinates
    elements : (n_plates, 4) int, nodes of each plate
    G : (n_plates, n_points, 3, 16) float [1/m, -]
    w : (n_plates, n_points) float [m^3]
    lame : lambda, mu [Pa]
    force : (n_nodes, 4, 3) float [N, N m], overwritten
    """
    e, q, F, E, P = np.empty((3, 16)), np.empty((3, 16)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    force[:] = 0.0
    for j in range(elements.shape[0]):
        _gather(p, elements[j], e)
        q[:] = 0.0
        for g in range(w.shape[1]):
            _strain(e, G[j, g], F, E)
            trace = lame[0] * (E[0, 0] + E[1, 1] + E[2, 2])
            for i in range(3):
                for k in range(3):
                    total = F[i, 0] * E[0, k] + F[i, 1] * E[1, k] + F[i, 2] * E[2, k]
                    P[i, k] = w[j, g] * (trace * F[i, k] + 2.0 * lame[1] * total)
            for i in range(3):
                for a in range(16):
                    q[i, a] += P[i, 0] * G[j, g, 0, a] + P[i, 1] * G[j, g, 1, a] + P[i, 2] * G[j, g, 2, a]
        for k in range(4):
            for c in range(4):
                for i in range(3):
                    force[elements[j, k], c, i] += q[i, 4 * k + c]


@_compiled
def _add_point_tangent(
    w: float, G: FloatArray, F: FloatArray, E: FloatArray, lame: tuple[float, float], K: FloatArray
) -> None:
    """Add one point to K (3, 3, 16, 16), blocks i <= j only.

    K_ij,ab = w [lambda g_ia g_jb + mu ((F F^T)_ij G_a.G_b + g_ib g_ja) + delta_ij G_a.S G_b] with g = F G.
    """
    trace = lame[0] * (E[0, 0] + E[1, 1] + E[2, 2])
    f, h = np.empty((3, 16)), np.empty((3, 16))
    for i in range(3):
        for a in range(16):
            f[i, a] = F[i, 0] * G[0, a] + F[i, 1] * G[1, a] + F[i, 2] * G[2, a]
            stress = E[i, 0] * G[0, a] + E[i, 1] * G[1, a] + E[i, 2] * G[2, a]
            h[i, a] = w * (trace * G[i, a] + 2.0 * lame[1] * stress)
    lam, mu = w * lame[0], w * lame[1]
    for i in range(3):
        for j in range(i, 3):
            A = mu * (F[i, 0] * F[j, 0] + F[i, 1] * F[j, 1] + F[i, 2] * F[j, 2])
            initial = 1.0 if i == j else 0.0
            for a in range(16):
                G0, G1, G2, fi, fj = G[0, a], G[1, a], G[2, a], lam * f[i, a], mu * f[j, a]
                D0, D1, D2 = initial * G0, initial * G1, initial * G2
                for b in range(16):
                    K[i, j, a, b] += (
                        fi * f[j, b]
                        + fj * f[i, b]
                        + A * (G0 * G[0, b] + G1 * G[1, b] + G2 * G[2, b])
                        + (D0 * h[0, b] + D1 * h[1, b] + D2 * h[2, b])
                    )


@_compiled
def elastic_tangent_kernel(
    p: FloatArray, elements: IntArray, G: FloatArray, w: FloatArray, lame: tuple[float, float], tangent: FloatArray
) -> None:
    """Exact tangent dQ_s/dp of all plates, added into the mesh matrix; arguments as `elastic_force_kernel`.

    Parameters
    ----------
    tangent : (12 n_nodes, 12 n_nodes) float [N/m, N, N m], overwritten; row 12 n + 3 c + i is node n, vector c,
        component i
    """
    e, F, E, K = np.empty((3, 16)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3, 16, 16))
    tangent[:] = 0.0
    for n in range(elements.shape[0]):
        _gather(p, elements[n], e)
        K[:] = 0.0
        for g in range(w.shape[1]):
            _strain(e, G[n, g], F, E)
            _add_point_tangent(w[n, g], G[n, g], F, E, lame, K)
        for i in range(3):
            for j in range(3):
                for a in range(16):
                    row = 12 * elements[n, a // 4] + 3 * (a % 4) + i
                    for b in range(16):
                        column = 12 * elements[n, b // 4] + 3 * (b % 4) + j
                        tangent[row, column] += K[i, j, a, b] if i <= j else K[j, i, b, a]
