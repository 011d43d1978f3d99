"""A bar of three laws, bent, in a process of its own: ``python -m tests.verification.laws_process OUT [FACTOR]``.

OUT takes displacement, stress, energies and plastic strain as a NumPy archive; FACTOR scales the rubber's modulus. May
be run by mpiexec.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np

from contracts.material_laws import J2Plasticity, Law, Ogden, StVenantKirchhoff
from reference_fe.dolfinx_api import COMM
from reference_fe.material.stored_energy import StoredEnergy
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.patch import STEEL
from reference_fe.verification.structured_hexahedra import block_mesh

PARTS = ("elastic", "metal", "rubber")


def bar(factor: float) -> StaticProblem:
    """Six cells in a row: two of each law; the far end is moved across."""
    mesh = block_mesh((6, 1, 1), lambda X: X * np.array([1.2, 0.2, 0.1]))
    third = np.minimum((mesh.points[mesh.cells].mean(axis=1)[:, 0] / 0.4).astype(np.int32), 2)
    laws: tuple[Law, ...] = (
        StVenantKirchhoff(),
        J2Plasticity(hardening_modulus=2e9),
        Ogden(moduli=(5e9 * factor,), exponents=(1.8,), bulk_modulus=5e12),
    )
    whole = replace(mesh, cell_tags=third + 1, parts={part: i + 1 for i, part in enumerate(PARTS)})
    materials = {part: replace(STEEL, yield_strength=2e8, law=law) for part, law in zip(PARTS, laws, strict=True)}
    supports = [Support(faces=("x0",)), Support(faces=("x1",), value=(-0.01, 0.0, 0.06))]
    return StaticProblem(Domain.from_tagged(whole), materials, supports)


def solve(factor: float) -> dict[str, np.ndarray]:
    """Everything the last state tells."""
    problem = bar(factor)
    stress, energy = StressRecovery(problem), StoredEnergy(problem)
    settings = NewtonSettings(relative_tolerance=1e-9)
    list(solve_increments(NewtonSolver(problem, settings), [k / 4.0 for k in range(1, 5)], []))
    return {
        "displacement": problem.nodal_displacement(),
        "nodal": stress.nodal_von_mises(),
        "largest": np.array(list(stress.largest_by_part().values())),
        "plastic": np.array(list(stress.largest_plastic_strain().values())),
        "energy": np.array([energy.value(), energy.plastic_dissipation()]),
        "stretch": np.array([problem.smallest_stretch([part]) for part in PARTS]),
    }


if __name__ == "__main__":
    found = solve(float(sys.argv[2]) if len(sys.argv) > 2 else 1.0)
    if COMM.rank == 0:
        np.savez(sys.argv[1], allow_pickle=False, **found)  # type: ignore[arg-type]
