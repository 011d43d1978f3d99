"""A thin square plate, clamped along one edge, that hangs down under its own weight.

500 x 500 x 1 mm, E = 177 GPa, nu = 0, density 7800 kg/m^3, g = 9.81 m/s^2: the tip drops 40.3175 mm and comes to
x = 498.138 mm. Source: elastica, in contracts/published/README.md (Liu, Tian & Hu 2011 give 40.3 mm from a commercial
code). Verified by tests/verification/test_ancf_cantilever.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array

from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.plates.mass import gravity_force
from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.verification.plate_strips import strip, strip_path

__all__ = ["DROP", "TIP_X", "YOUNG", "HangingPlate", "hanging_plate"]

DROP, TIP_X = 40.3175e-3, 498.138e-3
"""Of the tip, by the elastica [m]."""
SIDE, THICKNESS, YOUNG, DENSITY, GRAVITY = 0.5, 1e-3, 177e9, 7800.0, 9.81
CONTROLS = NewtonControls(tolerance=2e-5, max_iterations=50, smallest_step=1e-3)  # round-off of E t against E t^3
X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class HangingPlate:
    """What the run measured: drop of the tip and where it comes to [m], linear solves."""

    drop: float
    tip_x: float
    iterations: int

    @property
    def error(self) -> float:
        """|drop / that of the elastica - 1| [-]."""
        return abs(self.drop / DROP - 1.0)


def hanging_plate(plates: int = 32, young_modulus: float = YOUNG) -> HangingPlate:
    """Let a row of plates of a modulus [Pa] sink in five steps of the weight."""
    mesh = build_plate_mesh(strip(0.0 * X, SIDE * X, SIDE * Y, THICKNESS, plates))
    model = build_plate_model(mesh, young_modulus=young_modulus, poisson_ratio=0.0, density=DENSITY)
    weight = gravity_force(model, -GRAVITY * Z)

    def load(p: NDArray[np.float64], factor: float) -> tuple[NDArray[np.float64], csc_array]:
        return factor * weight, csc_array((p.size, p.size))

    path = strip_path(model, load, (0.2, 0.4, 0.6, 0.8, 1.0), float(np.abs(weight).max()), CONTROLS)
    x, _, z = path.displacement[-1].tolist()
    return HangingPlate(drop=-z, tip_x=SIDE + x, iterations=path.iterations)
