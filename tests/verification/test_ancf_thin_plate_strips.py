"""Claim: thin ANCF plates do not lock on curved strips, and bend as beams and plates do.

Sources: frequencies of a free inextensible ring, omega_n^2 = n^2 (n^2 - 1)^2 / (n^2 + 1) * E t^2 / (12 rho R^4) (from
memory, Love 1927, art. 293); tip deflection of a cantilever under an end force F L^2 / EI = 5 (elastica, Mattiasson,
Int. J. Numer. Meth. Engng 17, 1981, from memory). Tolerances: 12 plates around the ring, 1.5 %; 24 plates,
0.15 %; the cantilever 0.5 %. The control: full integration of the membrane strain locks.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse.linalg import spsolve

from ancf_reduced.thin_plates.plates import ThinPlates
from contracts.materials import TI_6AL_4V
from tests.unit.test_ancf_thin_plates import arc, flat

RADIUS, WIDTH = 0.1, 0.005


def ring_errors(count: int, thickness: float, **points: tuple[int, int]) -> np.ndarray:
    """Relative errors of the frequencies n = 2, 3, 4 within the plane, of a closed ring of ``count`` plates."""
    metal = replace(TI_6AL_4V, young_modulus=1e11, poisson_ratio=0.0, density=4000.0)
    nodes, plates, sizes = arc(count, 1, RADIUS, 2.0 * np.pi, WIDTH)
    plates[plates >= 2 * count] -= 2 * count
    ring = ThinPlates(nodes[:-2], plates, sizes, metal, thickness, **points)
    kept = planar_motions(len(ring.reference))
    K, M = (kept.T @ (m @ kept) for m in (ring.tangent(ring.reference), ring.mass()))
    found = np.sqrt(np.abs(eigh(K, M, eigvals_only=True)))
    n = np.array([2, 3, 4])
    exact = n * (n**2 - 1) / np.sqrt(n**2 + 1) * np.sqrt(1e11 * thickness**2 / (12.0 * 4000.0 * RADIUS**4))
    return np.asarray(found[[3, 5, 7]] / exact - 1.0)  # behind three rigid motions, each twice


def planar_motions(n_nodes: int) -> np.ndarray:
    """Coordinates of motions that are the same along the axle: r and r_1 in the plane of the ring, both edges alike."""
    columns = []
    for pair in range(n_nodes // 2):
        for vector in (0, 1):
            for i in (0, 2):
                one = np.zeros((n_nodes, 4, 3))
                one[2 * pair : 2 * pair + 2, vector, i] = 1.0
                columns.append(one.ravel())
    return np.array(columns).T


@pytest.mark.parametrize("slenderness", [0.0043, 0.01])
def test_twelve_plates_carry_a_ring(slenderness: float) -> None:
    assert np.abs(ring_errors(12, slenderness * RADIUS)).max() < 0.015
    assert np.abs(ring_errors(24, slenderness * RADIUS)).max() < 0.0015


def test_full_integration_locks() -> None:
    errors = ring_errors(12, 0.0043 * RADIUS, membrane_points=(4, 4))
    assert (errors > [0.04, 0.1, 0.2]).all(), errors


def test_a_cantilever_follows_the_elastica() -> None:
    """Deflection 0.71 L: 8 plates."""
    L, b, t, E = 1.0, 0.05, 0.005, 1e10
    metal = replace(TI_6AL_4V, young_modulus=E, poisson_ratio=0.0)
    body = ThinPlates(*flat((8, 1), (L, b)), metal, t)
    EI, force = E * b * t**3 / 12.0, 5.0
    q = body.reference.copy()
    free = np.ones(q.shape, dtype=bool)
    free[:2] = False
    load = np.zeros(q.shape)
    load[-2:, 0, 2] = 0.5 * force * EI / L**2
    for share in (0.25, 0.5, 0.75, 1.0):
        for _ in range(30):
            residual = (body.force(q) - share * load)[free]
            tangent = body.tangent(q)[free.ravel()][:, free.ravel()]
            q[free] -= spsolve(tangent.tocsc(), residual)
            if np.linalg.norm(residual) < 1e-9 * np.linalg.norm(load):
                break
        else:
            pytest.fail("no equilibrium")
    assert q[-2:, 0, 2].mean() / L == pytest.approx(0.71379, rel=5e-3)
