"""A very soft plate hinged at one corner falls from rest: path of the free corner and energy.

0.6 x 0.3 x 0.01 m, E = 1e5 Pa, nu = 0.3, 7810 kg/m^3, 4 x 2 plates (data of Mikkola & Shabana, Multibody Syst. Dyn. 9,
2003, 283-309). Source: contracts/published/ancf_plate_pendulum_4x2_nu0.3.csv, exact quadrature and DOP853; here
5 x 5 x 3 points, exact to 3e-10, and RATTLE without damping.
Verified by tests/verification/test_ancf_pendulum.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.explicit import MotionState, integrate_explicit
from ancf_reduced.motion.plate_system import PlateSystem, build_plate_system
from ancf_reduced.motion.spectrum import stable_step
from ancf_reduced.motion.vector_coordinates import with_held_vectors
from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import build_plate_model
from ancf_reduced.verification.plate_strips import strip
from contracts.published import published_table

__all__ = ["PendulumFall", "pendulum_fall"]

FloatArray = NDArray[np.float64]
LENGTH, WIDTH, THICKNESS = 0.6, 0.3, 0.01
X, Y, Z = np.eye(3)


@dataclass(frozen=True, slots=True, kw_only=True)
class PendulumFall:
    """What the run measured.

    Attributes
    ----------
    time : (n,) float [s]
    corner, published : (n, 3) float, path of the free corner [m]
    energy_spread : of kinetic, strain and potential energy together, over the largest kinetic energy [-]
    step : longest time step [s]
    """

    time: FloatArray
    corner: FloatArray
    published: FloatArray
    energy_spread: float
    step: float

    @property
    def distance(self) -> FloatArray:
        """(n,) float: of the corner from the published path [m]."""
        return np.linalg.norm(self.corner - self.published, axis=1)

    @property
    def error(self) -> float:
        """Largest distance of the corner from the published path [m]."""
        return float(self.distance.max())


def pendulum_fall(quadrature: tuple[int, int, int] = (5, 5, 3), fraction: float = 0.125) -> PendulumFall:
    """Fall for 0.4 s with steps of a ``fraction`` [-] of the stable one, ``quadrature`` points along x1, x2, x3."""
    table, system = published_table("ancf_plate_pendulum_4x2_nu0.3"), _pendulum(quadrature)
    start = system.reference()
    step = fraction * stable_step(system, start)
    far = int(np.argmax(np.linalg.norm(system.model.mesh.points, axis=1)))
    corner, energy, kinetic = list[FloatArray](), list[float](), list[float]()
    for state in integrate_explicit(system, MotionState(time=0.0, z=start, v=0.0 * start), table["t"][1:], step):
        corner.append(system.coordinates.expand(state.z)[far, 0])
        kinetic.append(system.kinetic_energy(state.v))
        energy.append(kinetic[-1] + system.elastic_energy(state.z) + system.dead_energy(state.z))
    return PendulumFall(
        time=table["t"][1:],
        corner=np.array(corner),
        published=np.column_stack([table[name] for name in "xyz"])[1:],
        energy_spread=float(np.ptp(energy) / max(kinetic)),
        step=step,
    )


def _pendulum(quadrature: tuple[int, int, int]) -> PlateSystem:
    """Two rows of four plates; the corner at the origin keeps its place."""
    rows = [strip(y * Y, LENGTH * X, 0.5 * WIDTH * Y, THICKNESS, 4) for y in (0.0, 0.5 * WIDTH)]
    mesh = build_plate_mesh([patch for row in rows for patch in row])
    model = build_plate_model(mesh, young_modulus=1e5, poisson_ratio=0.3, density=7810.0, quadrature=quadrature)
    held = np.zeros((len(mesh.points), 4), dtype=bool)
    held[np.linalg.norm(mesh.points, axis=1).argmin(), 0] = True
    return build_plate_system(model, with_held_vectors(mesh, held), gravity=-9.81 * Z)
