"""A narrow cantilever with 1 N at its tip: beam theory, with Poisson locking and with its relief.

508 x 12.7 x 3.175 mm, E = 71.7 GPa: P L^3 / (3 E I) = 17.99 mm, for any nu. Source: contracts/published/README.md (the
element as it is locks in thickness for nu > 0, about 12 %); linear theory, so the linear stiffness of the straight
plate is used. Held flat across its width the plate bends with E / (1 - nu^2).
Verified by tests/verification/test_ancf_poisson.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import PoissonLocking, build_plate_model
from ancf_reduced.verification.plate_strips import compliance, strip

__all__ = ["BentCantilever", "bent_cantilever"]

LENGTH, WIDTH, THICKNESS, YOUNG, FORCE = 0.508, 12.7e-3, 3.175e-3, 71.7e9, 1.0
X, Y, Z = np.eye(3)
_SLIDING = np.array([[0, 1, 0], [1, 0, 0], [0, 1, 1], [0, 1, 1]], dtype=bool)
"""What is free at the clamp, of (r, r_X, r_Y, r_Z): motion and slopes in its own plane, so that the section may change
its shape there as beam theory has it. A rigid clamp makes the plate 0.4 % stiffer."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BentCantilever:
    """What the run measured, and what beam or plate theory has: deflection of the tip [m]."""

    deflection: float
    expected: float

    @property
    def ratio(self) -> float:
        """Deflection over what theory has [-]; below 1 the plates are too stiff."""
        return self.deflection / self.expected


def bent_cantilever(
    poisson_ratio: float, locking: PoissonLocking, plates: int = 32, *, held_flat: bool = False
) -> BentCantilever:
    """Linear deflection [m] under the force, which is spread over the two end nodes."""
    mesh = build_plate_mesh(strip(0.0 * X, LENGTH * X, WIDTH * Y, THICKNESS, plates))
    model = build_plate_model(
        mesh, young_modulus=YOUNG, poisson_ratio=poisson_ratio, density=1.0, poisson_locking=locking
    )
    free = np.ones((len(mesh.points), 4, 3), dtype=bool)
    free[mesh.points[:, 0] < 1e-9] = _SLIDING
    free[np.argmin(mesh.points[:, 0] + mesh.points[:, 1]), 0] = False  # one corner, against the slide as a whole
    if held_flat:
        free[:, :, 1] = False  # no motion along y
        free[:, 2] = False  # no slope across the width
    force = np.zeros(free.shape)
    force[mesh.points[:, 0] > LENGTH - 1e-9, 0, 2] = 0.5 * FORCE
    beam = FORCE * LENGTH**3 / (3.0 * YOUNG * WIDTH * THICKNESS**3 / 12.0)
    expected = beam * (1.0 - poisson_ratio**2) if held_flat else beam
    return BentCantilever(deflection=compliance(model, free, force) / FORCE, expected=expected)
