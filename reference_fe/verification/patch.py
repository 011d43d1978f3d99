"""Patch tests on a distorted block: constant strain, rigid rotation, and the zero-energy modes of one element.

Source: Bathe, Finite Element Procedures (1996), 4.4; a free solid has 6 rigid modes. The solutions lie in the finite
element space, so that only round-off is left. Verified by tests/verification/test_fe_patch.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.materials import Material
from contracts.mesh import TaggedMesh
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.material.stress import StressRecovery
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support, Traction
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = [
    "STEEL",
    "UniaxialTension",
    "distorted_cube",
    "linear_field_error",
    "rigid_rotation_force",
    "uniaxial_tension",
    "zero_energy_modes",
]

STEEL = Material(
    name="steel", young_modulus=200e9, poisson_ratio=0.3, density=7850.0, yield_strength=1e9, source="round numbers"
)
GRADIENT = (0.02, -0.01, 0.015)
"""Stretch along each axis minus 1 of the prescribed linear field [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class UniaxialTension:
    """What a dead traction of 0.1 % of E did.

    Attributes
    ----------
    traction : force over undeformed area [Pa]
    stretch, lateral : deformed over undeformed length, along and across [-]
    true_stress : (n,) float, von Mises stress at every stress point and node [Pa]
    principal_stress : (n_points, 3) float, at every node, descending [Pa]
    iterations : linear solves
    """

    traction: float
    stretch: float
    lateral: float
    true_stress: NDArray[np.float64]
    principal_stress: NDArray[np.float64]
    iterations: int

    @property
    def error(self) -> float:
        """Largest difference of the stress to force over deformed area, relative [-]."""
        return float(np.abs(self.true_stress * self.lateral**2 / self.traction - 1.0).max())


def distorted_cube(order: int = 2) -> TaggedMesh:
    """A 2 x 2 x 2 cube of side 1 m whose inner nodes are moved (curved cells at order 2)."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        bubble = 0.06 * np.prod(np.sin(np.pi * X), axis=1)
        return np.asarray(X + bubble[:, None] * np.array([1.0, -0.7, 0.5]))

    return block_mesh((2, 2, 2), mapping, order)


def uniaxial_tension(law: MaterialLaw = MaterialLaw.ST_VENANT_KIRCHHOFF, order: int = 2) -> UniaxialTension:
    """Pull the distorted cube along x: stress and strain are uniform."""
    traction = 1e-3 * STEEL.young_modulus
    problem = StaticProblem(
        Domain.from_tagged(distorted_cube(order)),
        {"body": STEEL},
        [Support(faces=(face,), components=(axis,)) for axis, face in enumerate(("x0", "y0", "z0"))],
        loads=[Traction(faces=("x1",), vector=(traction, 0.0, 0.0))],
        discretisation=Discretisation(law=law, degree=order),
    )
    iterations = _solved(problem, NewtonSettings(relative_tolerance=1e-12))
    u, recovery = problem.nodal_displacement(), StressRecovery(problem)
    return UniaxialTension(
        traction=traction,
        stretch=1.0 + float(u[:, 0].max()),
        lateral=1.0 + float(u[:, 1].min()),
        true_stress=np.append(recovery.cell_stations().ravel(), recovery.nodal_von_mises()),
        principal_stress=recovery.nodal_principal_stress(),
        iterations=iterations,
    )


def linear_field_error() -> float:
    """Outer faces moved by one linear field: largest distance of a node of the curved mesh from that field [m]."""
    mesh, gradient = distorted_cube(), np.array(GRADIENT)
    supports = [Support(faces=(f"{'xyz'[k]}1",), components=(k,), value=(gradient[k],)) for k in range(3)]
    supports += [Support(faces=(f"{'xyz'[k]}0",), components=(k,)) for k in range(3)]
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": STEEL}, supports)
    _solved(problem, NewtonSettings())
    return float(np.abs(problem.nodal_displacement() - mesh.points * gradient).max())


def rigid_rotation_force(angle: float = 1.2, stretch: float = 1.0) -> float:
    """Largest internal force at a node over E times the unit area, turned by an angle [rad] about a skew axis [-].

    A ``stretch`` other than 1 makes the motion no longer rigid.
    """
    problem = StaticProblem(Domain.from_tagged(distorted_cube()), {"body": STEEL}, [Support(faces=("x0",))])
    axis = np.array([1.0, 2.0, -1.0]) / np.sqrt(6.0)
    K = np.cross(np.eye(3), axis)
    R = stretch * (np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * K @ K)
    problem.u.interpolate(lambda x: (R - np.eye(3)) @ x)
    return float(np.abs(problem.residual()).max() / STEEL.young_modulus)


def zero_energy_modes(gauss_points: tuple[int, int, int] | None = None) -> int:
    """Modes of one free 27-node hexahedron without stiffness; 6 rigid ones belong there."""
    mesh = block_mesh((1, 1, 1), lambda X: X * np.array([1.0, 0.8, 0.1]))
    choice = Discretisation() if gauss_points is None else Discretisation(gauss_points=gauss_points)
    problem = StaticProblem(Domain.from_tagged(mesh), {"body": STEEL}, [], discretisation=choice)
    indptr, indices, values = problem.unsupported_tangent().getValuesCSR()
    dense = np.zeros((problem.dofs, problem.dofs))
    dense[np.repeat(np.arange(problem.dofs), np.diff(indptr)), indices] = values
    stiffness = np.linalg.eigvalsh(0.5 * (dense + dense.T))
    return int(np.sum(stiffness < 1e-10 * stiffness[-1]))


def _solved(problem: StaticProblem, settings: NewtonSettings) -> int:
    """Solve at the full load; linear solves."""
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, settings).solve()
    if not outcome.converged:
        raise ConvergenceError(f"the patch does not converge: residual {outcome.residuals[-1]:.1e}", [])
    return outcome.iterations
