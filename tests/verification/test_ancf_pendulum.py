"""Claim: a falling plate pendulum follows an independent computation to 1e-5 m; without damping it keeps its energy.

0.6 x 0.3 x 0.01 m, E = 1e5 Pa, nu = 0.3, 7810 kg/m^3, 4 x 2 plates, hinged at one corner, falling from rest (data of
Mikkola & Shabana 2003). Source: contracts/published/ancf_plate_pendulum_4x2_nu0.3.csv, exact quadrature and DOP853;
here 5 x 5 x 3 points, exact to 3e-10, and RATTLE. Tolerances: 1e-5 m on the free corner over 0.4 s; energy to 1e-6 of
the largest kinetic energy, at an eighth of the stable step, its error falling with the step squared. Negative
control: 4 x 4 x 2 points leave the path by 4e-4 m.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest
from numpy.typing import NDArray

from ancf_reduced.explicit_dynamics import MotionState, integrate_explicit
from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import build_plate_model
from ancf_reduced.plate_system import PlateSystem, build_plate_system
from ancf_reduced.spectrum import stable_step
from ancf_reduced.vector_coordinates import with_held_vectors
from contracts.published import published_table

X, Y, Z = np.eye(3)
CELL = 0.15


@functools.cache
def pendulum(quadrature: tuple[int, int, int]) -> PlateSystem:
    patches = [
        flat_patch(CELL * (i * X + j * Y), CELL * X, CELL * Y, 0.01, "plate") for i in range(4) for j in range(2)
    ]
    mesh = build_plate_mesh(patches)
    model = build_plate_model(mesh, young_modulus=1e5, poisson_ratio=0.3, density=7810.0, quadrature=quadrature)
    held = np.zeros((len(mesh.points), 4), dtype=bool)
    held[np.linalg.norm(mesh.points, axis=1).argmin(), 0] = True
    return build_plate_system(model, with_held_vectors(mesh, held), gravity=-9.81 * Z)


@functools.cache
def fall(quadrature: tuple[int, int, int], fraction: float) -> tuple[float, float]:
    """Largest distance of the corner from the published path [m], spread of energy over largest kinetic energy."""
    system, table = pendulum(quadrature), published()
    start = system.reference()
    corner = np.linalg.norm(system.model.mesh.points - [0.6, 0.3, 0.0], axis=1).argmin()
    step, path, energy, kinetic = fraction * stable_step(system, start), [], [], []
    for state in integrate_explicit(system, MotionState(time=0.0, z=start, v=0.0 * start), table[1:, 0], step):
        path.append(system.coordinates.expand(state.z)[corner, 0])
        kinetic.append(system.kinetic_energy(state.v))
        energy.append(kinetic[-1] + system.elastic_energy(state.z) + system.dead_energy(state.z))
    return float(np.abs(path - table[1:, 1:]).max()), float(np.ptp(energy) / max(kinetic))


def published() -> NDArray[np.float64]:
    table = published_table("ancf_plate_pendulum_4x2_nu0.3")
    return np.column_stack([table[name] for name in ("t", "x", "y", "z")])


def test_corner_follows_the_published_path() -> None:
    assert fall((5, 5, 3), 0.125)[0] < 1e-5


def test_energy_is_kept_and_its_error_falls_with_the_square_of_the_step() -> None:
    coarse, fine = fall((5, 5, 3), 0.5)[1], fall((5, 5, 3), 0.125)[1]
    assert fine < 1e-6
    assert coarse / fine == pytest.approx(16.0, rel=0.5)


def test_fewer_points_leave_the_path() -> None:
    """Negative control, and the published remark: 4 x 4 x 2 points differ at 4e-4 m."""
    assert 1e-4 < fall((4, 4, 2), 0.125)[0] < 1e-3
