"""Claim: with Poisson locking relieved, a narrow cantilever of nu = 0.33 bends as beam theory says, to 0.3 %.

508 x 12.7 x 3.175 mm, E = 71.7 GPa, 1 N at the tip: P L^3 / (3 E I) = 17.99 mm. Source: contracts/published/README.md
(the element as it is locks in thickness, about 12 %); linear theory, so the linear stiffness of the straight plate is
used. The section is free to curve across the width, at the clamp too. Also: the plate held flat across its width bends
with E / (1 - nu^2). Convergence over 8, 16, 32 plates. Negative control: the element as it is.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ancf_reduced.plate_mesh import build_plate_mesh, flat_patch
from ancf_reduced.plate_model import PoissonLocking, build_plate_model

LENGTH, WIDTH, THICKNESS, YOUNG, FORCE = 0.508, 12.7e-3, 3.175e-3, 71.7e9, 1.0
BEAM = FORCE * LENGTH**3 / (3.0 * YOUNG * WIDTH * THICKNESS**3 / 12.0)
X, Y, Z = np.eye(3)
SLIDING = np.array([[0, 1, 0], [1, 0, 0], [0, 1, 1], [0, 1, 1]], dtype=bool)
"""What is free at the clamp, of (r, r_X, r_Y, r_Z): motion and slopes in its own plane, so that the section may change
its shape there as beam theory has it. A rigid clamp makes the plate 0.4 % stiffer."""


@functools.cache
def tip_deflection(
    poisson_ratio: float, locking: PoissonLocking, plates: int = 32, *, held_flat: bool = False
) -> float:
    """Linear deflection of the tip under the force, spread over the two end nodes [m]."""
    patches = [
        flat_patch(i * LENGTH / plates * X, LENGTH / plates * X, WIDTH * Y, THICKNESS, "plate") for i in range(plates)
    ]
    mesh = build_plate_mesh(patches)
    model = build_plate_model(
        mesh, young_modulus=YOUNG, poisson_ratio=poisson_ratio, density=1.0, poisson_locking=locking
    )
    free = np.ones((len(mesh.points), 4, 3), dtype=bool)
    free[mesh.points[:, 0] < 1e-9] = SLIDING
    if held_flat:
        free[:, :, 1] = False  # no motion along y
        free[:, 2] = False  # no slope across the width
    rows = np.flatnonzero(free.ravel())
    free[np.argmin(mesh.points[:, 0] + mesh.points[:, 1]), 0] = False
    force = np.zeros(free.shape)
    force[mesh.points[:, 0] > LENGTH - 1e-9, 0, 2] = 0.5 * FORCE
    K = model.elastic_tangent(mesh.reference_coordinates())
    moved = np.linalg.solve(K[np.ix_(rows, rows)], force.ravel()[rows])
    return float(moved @ force.ravel()[rows])


def test_narrow_plate_bends_as_a_beam() -> None:
    assert pytest.approx(17.99e-3, rel=3e-4) == BEAM
    assert tip_deflection(0.33, PoissonLocking.RELIEVED) == pytest.approx(BEAM, rel=3e-3)
    assert tip_deflection(0.0, PoissonLocking.AS_IS) == pytest.approx(BEAM, rel=3e-3)


def test_plate_held_flat_bends_with_the_plate_modulus() -> None:
    bent = tip_deflection(0.33, PoissonLocking.RELIEVED, held_flat=True)
    assert bent == pytest.approx(BEAM * (1.0 - 0.33**2), rel=3e-3)


def test_relieved_element_converges() -> None:
    errors = [abs(tip_deflection(0.33, PoissonLocking.RELIEVED, n) / BEAM - 1.0) for n in (8, 16, 32)]
    assert errors[0] > errors[1] > errors[2]


def test_the_element_as_it_is_locks() -> None:
    """Negative control: about 12 % too stiff however fine the mesh, held flat even more."""
    locked = tip_deflection(0.33, PoissonLocking.AS_IS) / BEAM
    assert 0.80 < locked < 0.95
    assert tip_deflection(0.33, PoissonLocking.AS_IS, held_flat=True) / (BEAM * (1.0 - 0.33**2)) < 0.8
