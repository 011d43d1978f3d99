"""Claim: natural frequencies of a cantilever and of a free ring of plates follow the closed forms to 0.5 %.

Sources: Euler-Bernoulli cantilever, f_k = b_k^2 / (2 pi L^2) sqrt(E I / (rho A)), b = 1.875104, 4.694091; free thin
ring bending in its plane, omega_n^2 = E I / (rho A R^4) n^2 (n^2 - 1)^2 / (n^2 + 1), n = 2, 3 (Love 1944, art. 293),
each twice. nu = 0. Cantilever: thickness 1 % of the length; shear and rotary inertia stay below 0.1 %. Ring: curved and
stress-free, thickness 8 % of the radius, so that both stay below 0.4 %; convergence of order 4 over 12, 24, 48 plates.
It is slow because curved plates lock: their mid-surface cannot bend without stretching (12 plates are 58 % too high,
and with a thickness of 1 % of the radius nine times too high). Negative control: 2 % more thickness.
"""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh

from ancf_reduced.plate_mass import mass_matrix
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model
from ancf_reduced.plate_system import build_plate_system
from ancf_reduced.spectrum import natural_frequencies
from ancf_reduced.tire_mesh import rim_patch
from ancf_reduced.tire_preset import TirePreset, thesis_preset
from ancf_reduced.vector_coordinates import with_held_vectors

YOUNG, DENSITY, SIZE, WIDTH = 1e9, 1000.0, 0.1425, 0.02
THICKNESS, RING_THICKNESS = 0.01 * SIZE, 0.08 * SIZE
X, Y, Z = np.eye(3)


def wave_speed(thickness: float = THICKNESS) -> float:
    """sqrt(E I / (rho A)) [m^2/s]."""
    return float(np.sqrt(YOUNG / DENSITY / 12.0) * thickness)


@functools.cache
def cantilever(plates: int, thickness: float = THICKNESS) -> NDArray[np.float64]:
    """The two lowest frequencies of bending in the plane of thickness and length [Hz]."""
    h = SIZE / plates
    mesh = build_plate_mesh([flat_patch(i * h * X, h * X, 1e-3 * Y, thickness, "plate") for i in range(plates)])
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=DENSITY)
    held = np.repeat((mesh.points[:, 0] < 1e-9)[:, None], 4, axis=1)
    system = build_plate_system(model, with_held_vectors(mesh, held))
    found = natural_frequencies(system, system.reference())
    expected = expected_cantilever(thickness)
    return np.array([found[np.abs(found - f).argmin()] for f in expected])


def expected_cantilever(thickness: float = THICKNESS) -> NDArray[np.float64]:
    return np.array([1.875104, 4.694091]) ** 2 * wave_speed(thickness) / (2.0 * np.pi * SIZE**2)


def ring_preset(plates: int, thickness: float) -> TirePreset:
    return replace(
        thesis_preset(),
        outer_radius=SIZE + 0.5 * thickness,
        width=WIDTH,
        rim_thickness=thickness,
        circumferential_plates=plates,
    )


@functools.cache
def ring(plates: int, thickness: float = RING_THICKNESS) -> NDArray[np.float64]:
    """Frequencies of the free ring that bend it in its plane, two for each n = 2, 3, ascending [Hz]."""
    preset, angle = ring_preset(plates, thickness), 2.0 * np.pi / plates
    mesh = build_plate_mesh([rim_patch(preset, i * angle, angle) for i in range(plates)])
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=DENSITY)
    in_plane = np.zeros((len(mesh.points), 4, 3), dtype=bool)
    in_plane[:, :, [0, 2]] = True
    in_plane[:, 2] = False  # the width stays straight and its gradient r_Y as it is
    rows = np.flatnonzero(in_plane.ravel())
    K = model.elastic_tangent(mesh.reference_coordinates())[np.ix_(rows, rows)]
    M = np.kron(mass_matrix(model), np.eye(3))[np.ix_(rows, rows)]
    found = np.sqrt(np.maximum(eigh(K, M, eigvals_only=True), 0.0)) / (2.0 * np.pi)
    assert found[2] < 1e-3 * found[3]  # three rigid motions
    return np.asarray(found[3:7])


def expected_ring() -> NDArray[np.float64]:
    n = np.array([2.0, 2.0, 3.0, 3.0])
    return wave_speed(RING_THICKNESS) / SIZE**2 * n * (n**2 - 1.0) / np.sqrt(n**2 + 1.0) / (2.0 * np.pi)


def test_cantilever() -> None:
    np.testing.assert_allclose(cantilever(16), expected_cantilever(), rtol=5e-3)
    errors = [np.abs(cantilever(n) / expected_cantilever() - 1.0).max() for n in (4, 8, 16)]
    assert errors[0] > 3.0 * errors[1]


def test_free_ring() -> None:
    errors = [np.abs(ring(n) / expected_ring() - 1.0).max() for n in (12, 24, 48)]
    assert errors[2] < 5e-3
    assert np.log2(errors[0] / errors[1]) > 3.5


def test_a_thicker_strip_is_caught() -> None:
    """Negative control: 2 % of thickness is 2 % of frequency."""
    assert cantilever(16, 1.02 * THICKNESS)[0] / expected_cantilever()[0] == pytest.approx(1.02, abs=2e-3)
    assert np.abs(ring(48, 1.02 * RING_THICKNESS) / expected_ring() - 1.0).min() > 0.01
