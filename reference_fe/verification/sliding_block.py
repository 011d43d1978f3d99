"""A block pressed on a rough plane: it sticks elastically, then slides at the limit force mu N (Coulomb).

Source: statics. The block's foot is held flat by stiff material, so that every point has the same pressure and slip;
the pressing force is the integral of the pressure. Verified by tests/verification/test_fe_friction_block.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.materials import Material
from reference_fe.contact.obstacle import ObstacleContact, ObstacleTerm
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["FRICTION", "PENALTY", "SIDE", "SINK", "DraggedBlock", "dragged_block"]

STIFF = Material(name="stiff", young_modulus=1e14, poisson_ratio=0.0, density=1.0, yield_strength=1.0, source="stiff")
PENALTY, SIDE, SINK, DRAG = 1e9, 0.1, 1e-4, 1e-3
"""Contact stiffness [N/m^3], edge, depth of the foot and longest drag [m]: it slips after mu SINK."""
FRICTION = 0.3
_FACTORS = (0.0, 0.01, 0.02, 0.1, 0.5, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class DraggedBlock:
    """What the run measured, at each of its n stops.

    Attributes
    ----------
    drag : (n,) float, of the block's top [m]
    tangential, sideways, normal : (n,) float, force on the foot against the drag, across it, and off the plane [N]
    dissipated, slip_energy : (n,) float, energy that sliding took so far, and that elastic slip holds [J]
    iterations : (n,) int, linear solves
    """

    drag: NDArray[np.float64]
    tangential: NDArray[np.float64]
    sideways: NDArray[np.float64]
    normal: NDArray[np.float64]
    dissipated: NDArray[np.float64]
    slip_energy: NDArray[np.float64]
    iterations: NDArray[np.int64]


def dragged_block(friction: float = FRICTION, direction_deg: float = 0.0) -> DraggedBlock:
    """Foot at depth SINK from the start, top dragged to DRAG in steps that are accepted one by one.

    Parameters
    ----------
    friction : Coulomb coefficient [-]
    direction_deg : direction of the drag, from +x about +z [deg]
    """
    direction = np.array([np.cos(np.deg2rad(direction_deg)), np.sin(np.deg2rad(direction_deg))])
    contact = ObstacleContact(
        faces=("z0",), normal=(0.0, 0.0, 1.0), distance_at_touch=0.0, stiffness=PENALTY, friction=friction
    )
    value = (DRAG * direction[0], DRAG * direction[1], 0.0)
    problem = StaticProblem(
        Domain.from_tagged(block_mesh((2, 2, 1), lambda X: SIDE * X)),
        {"body": STIFF},
        [Support(faces=("z1",), value=value)],
        contact=contact,
    )
    solver, forces, energies, iterations = NewtonSolver(problem, NewtonSettings()), [], [], []
    (term,) = problem.surfaces.terms
    assert isinstance(term, ObstacleTerm)
    for factor in _FACTORS:
        problem.set_control(factor)
        term.set_control(SINK)  # the plane stands still while the block is dragged
        outcome = solver.solve()
        if not outcome.converged:
            raise ConvergenceError(f"the block dragged by {factor * DRAG:g} m does not converge", [])
        problem.accept()
        forces.append(problem.contact_force())
        energies.append(term.friction_energy())
        iterations.append(outcome.iterations)
    force, (dissipated, slip_energy) = np.array(forces), np.array(energies).T
    return DraggedBlock(
        drag=DRAG * np.array(_FACTORS),
        tangential=-force[:, :2] @ direction,
        sideways=force[:, 0] * direction[1] - force[:, 1] * direction[0],
        normal=force[:, 2],
        dissipated=dissipated,
        slip_energy=slip_energy,
        iterations=np.array(iterations),
    )
