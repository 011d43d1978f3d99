"""Natural frequencies of a cantilever and of a free ring of plates, against the closed forms.

Euler-Bernoulli cantilever, f_k = b_k^2 / (2 pi L^2) sqrt(E I / (rho A)), b = 1.875104, 4.694091; free thin ring bending
in its plane, omega_n^2 = E I / (rho A R^4) n^2 (n^2 - 1)^2 / (n^2 + 1), n = 2, 3, each twice. Source: Love, A Treatise
on the Mathematical Theory of Elasticity, 1944, art. 293 (ring). nu = 0. Cantilever: thickness 1 % of the length; shear
and rotary inertia stay below 0.1 %. Ring: curved and stress-free, thickness 8 % of the radius, so that both stay below
0.4 %. Verified by tests/verification/test_ancf_frequencies.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from ancf_reduced.motion.plate_system import build_plate_system
from ancf_reduced.motion.spectrum import natural_frequencies
from ancf_reduced.motion.vector_coordinates import with_held_vectors
from ancf_reduced.plates.mass import mass_matrix
from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.tire.mesh import rim_patch
from ancf_reduced.tire.preset import thesis_preset
from ancf_reduced.verification.plate_strips import strip

__all__ = ["RING_THICKNESS", "THICKNESS", "Frequencies", "cantilever_frequencies", "ring_frequencies"]

FloatArray = NDArray[np.float64]
YOUNG, DENSITY, SIZE, WIDTH = 1e9, 1000.0, 0.1425, 0.02
THICKNESS, RING_THICKNESS = 0.01 * SIZE, 0.08 * SIZE
X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class Frequencies:
    """What the run measured.

    Attributes
    ----------
    found, expected : (n,) float, ours and the closed form at the nominal thickness, ascending [Hz]
    rigid : largest frequency of a rigid motion of the free ring over the lowest of bending, zero but for round-off [-]
    """

    found: FloatArray
    expected: FloatArray
    rigid: float = 0.0

    @property
    def error(self) -> float:
        """Largest |found / expected - 1| [-]."""
        return float(np.abs(self.found / self.expected - 1.0).max())


def cantilever_frequencies(plates: int = 24, thickness: float = THICKNESS) -> Frequencies:
    """The two lowest frequencies [Hz] of bending in the plane of ``thickness`` [m] and length."""
    mesh = build_plate_mesh(strip(0.0 * X, SIZE * X, 1e-3 * Y, thickness, plates))
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=DENSITY)
    held = np.repeat((mesh.points[:, 0] < 1e-9)[:, None], 4, axis=1)
    system = build_plate_system(model, with_held_vectors(mesh, held))
    found = natural_frequencies(system, system.reference())  # of bending sideways and torsion as well
    nearest = [found[np.abs(found - f).argmin()] for f in _cantilever(thickness)]
    return Frequencies(found=np.array(nearest), expected=_cantilever(THICKNESS))


def ring_frequencies(plates: int = 48, thickness: float = RING_THICKNESS) -> Frequencies:
    """Frequencies [Hz] of the free ring of a ``thickness`` [m] that bend it in its plane, two for each n = 2, 3."""
    preset = replace(
        thesis_preset(),
        outer_radius=SIZE + 0.5 * thickness,
        width=WIDTH,
        rim_thickness=thickness,
        circumferential_plates=plates,
    )
    angle = 2.0 * np.pi / plates
    mesh = build_plate_mesh([rim_patch(preset, i * angle, angle) for i in range(plates)])
    model = build_plate_model(mesh, young_modulus=YOUNG, poisson_ratio=0.0, density=DENSITY)
    in_plane = np.zeros((len(mesh.points), 4, 3), dtype=bool)
    in_plane[:, :, [0, 2]] = True
    in_plane[:, 2] = False  # the width stays straight and its gradient r_Y as it is
    rows = np.flatnonzero(in_plane.ravel())
    K = model.elastic_tangent(mesh.reference_coordinates())[np.ix_(rows, rows)]
    M = np.kron(mass_matrix(model), np.eye(3))[np.ix_(rows, rows)]
    squares = np.abs(eigh(K, M, eigvals_only=True, subset_by_index=(0, 6)))  # three rigid motions come first
    rigid = float(np.sqrt(squares[:3].max() / squares[3]))
    return Frequencies(found=np.sqrt(squares[3:]) / (2.0 * np.pi), expected=_ring(), rigid=rigid)


def _wave_speed(thickness: float) -> float:
    """sqrt(E I / (rho A)) [m^2/s]."""
    return float(np.sqrt(YOUNG / DENSITY / 12.0) * thickness)


def _cantilever(thickness: float) -> FloatArray:
    return np.array([1.875104, 4.694091]) ** 2 * _wave_speed(thickness) / (2.0 * np.pi * SIZE**2)


def _ring() -> FloatArray:
    n = np.array([2.0, 2.0, 3.0, 3.0])
    return _wave_speed(RING_THICKNESS) / SIZE**2 * n * (n**2 - 1.0) / np.sqrt(n**2 + 1.0) / (2.0 * np.pi)
