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
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh, spsolve

from ancf_reduced.thin_plates.plates import Layer, ThinPlates
from ancf_reduced.thin_plates.shape_functions import shape_tables
from contracts.errors import InputError
from contracts.materials import TI_6AL_4V
from tests.unit.test_ancf_thin_plates import arc, flat

RADIUS, WIDTH = 0.1, 0.005


def ring_errors(count: int, thickness: float, **points: tuple[int, int]) -> np.ndarray:
    """Relative errors of the frequencies n = 2, 3, 4 within the plane, of a closed ring of ``count`` plates."""
    metal = replace(TI_6AL_4V, young_modulus=1e11, poisson_ratio=0.0, density=4000.0)
    nodes, plates, sizes = arc(count, 1, RADIUS, 2.0 * np.pi, WIDTH)
    plates[plates >= 2 * count] -= 2 * count
    ring = ThinPlates(nodes[:-2], plates, sizes, [[Layer(material=metal, thickness=thickness)]], **points)
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
    body = ThinPlates(*flat((8, 1), (L, b)), [[Layer(material=metal, thickness=t)]])
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


METAL = replace(TI_6AL_4V, young_modulus=1.138e11, poisson_ratio=0.342, density=4430.0)


@pytest.mark.parametrize("thickness", [0.4e-3, 0.9e-3])
def test_a_strip_loaded_within_its_plane_is_a_beam(thickness: float) -> None:
    """96 by 26 mm, six plates of the wheel's size: Timoshenko's beam, F (L^3 / 3 E I + 1.2 L / G A), within 3 %.

    The load is even along the edge. Control: with 2 x 3 points it gives way
    """
    L, b, t = 0.096, 0.026, thickness
    E, G = METAL.young_modulus, METAL.young_modulus / 2.0 / (1.0 + METAL.poisson_ratio)
    exact = L**3 / (3.0 * E * t * b**3 / 12.0) + 1.2 * L / (G * t * b)

    def compliance(points: tuple[int, int]) -> float:
        body = ThinPlates(*flat((6, 1), (L, b)), [[Layer(material=METAL, thickness=t)]], points)
        load = np.zeros(body.reference.shape)
        v, w = np.polynomial.legendre.leggauss(6)
        v, w = 0.5 + 0.5 * v, 0.5 * w
        edge = shape_tables((L / 6.0, b), np.ones(6), v)[:, 0]
        force = np.einsum("p,pk->k", w, edge).reshape(4, 4)[2:]
        load[-2:, :, 1] = force
        free = np.ones(load.shape, dtype=bool)
        free[:2] = False
        kept = free.ravel()
        moved = np.zeros(body.size)
        moved[kept] = spsolve(body.tangent(body.reference)[kept][:, kept].tocsc(), load.ravel()[kept])
        return float(moved @ load.ravel())

    assert compliance((2, 4)) == pytest.approx(exact, rel=0.03)
    assert compliance((2, 3)) > 1.3 * exact


def test_the_lowest_motions_of_a_free_curved_strip_are_the_bodys_own() -> None:
    """R = 70 mm, 90 degrees, 26 mm wide, 0.4 mm thick: six frequencies of 8 x 2 plates beside 24 x 6 within 2 %."""

    def frequencies(counts: tuple[int, int]) -> np.ndarray:
        strip = ThinPlates(*arc(*counts, 0.070, 0.5 * np.pi, 0.026), [[Layer(material=METAL, thickness=0.4e-3)]])
        scale = diags_array(np.tile(np.repeat([1.0, 0.02, 0.02, 0.0004], 3), len(strip.reference)) ** -1.0)
        K, M = (scale @ m @ scale for m in (strip.tangent(strip.reference), strip.mass()))
        shift = -1e3 * abs(M).max() ** 0.0
        found = eigsh(K.tocsc(), 12, M.tocsc(), sigma=shift, return_eigenvectors=False)
        return np.sqrt(np.sort(np.abs(found)))[6:]

    np.testing.assert_allclose(frequencies((8, 2)), frequencies((24, 6)), rtol=0.02)


def test_a_strip_curved_along_the_wrong_axis_is_refused() -> None:
    nodes, plates, sizes = arc(4, 1, 0.07, 1.0, 0.026)
    turned = nodes[:, [0, 2, 1, 3]]
    with pytest.raises(InputError, match=r"curvatures of .* and membrane points of 2 and 4"):
        ThinPlates(turned, plates[:, [0, 2, 1, 3]], sizes[:, ::-1], [[Layer(material=METAL, thickness=0.4e-3)]])
    ThinPlates(turned, plates[:, [0, 2, 1, 3]], sizes[:, ::-1], [[Layer(material=METAL, thickness=0.4e-3)]], (4, 2))
