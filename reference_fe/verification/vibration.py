"""Bodies whose natural frequencies have closed forms: bars free, stretched and on ground, a column, a ring, a plate.

Each returns frequencies [Hz] found by `natural_modes` and those of the closed form (docs/theory/vibration.md, 2.11).
Verified by tests/verification/test_fe_vibration.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from contracts.materials import Material
from contracts.mesh import TaggedMesh
from contracts.modes import Modes
from reference_fe.contact.obstacle import ObstacleContact
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh
from reference_fe.vibration.body import Support as Holds
from reference_fe.vibration.body import natural_modes

__all__ = ["Compared", "bar", "cantilever_plate", "column", "free_ring", "stretched_bar", "waves_on_ground"]

Array = NDArray[np.float64]
STEEL = Material(
    name="steel", young_modulus=200e9, poisson_ratio=0.0, density=8000.0, yield_strength=1e9, source="round numbers"
)
BARTON = (3.492, 8.525, 21.43, 27.33, 31.11)
"""Cantilever square plate, nu = 0.3 (M. V. Barton, J. Appl. Mech. 18, 1951, as code_aster's V2.03.001 has them)."""
"""omega a^2 sqrt(rho h / D)."""


LINEAR = Discretisation(gauss_points=(3, 3, 3))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Compared:
    """Frequencies found and expected [Hz], and all modes of the run."""

    found: Array
    expected: Array
    modes: Modes

    @property
    def error(self) -> Array:
        """found / expected - 1 [-]."""
        return np.asarray(self.found / self.expected - 1.0)


def bar(cells: int, *, density: float = STEEL.density, order: int = 2) -> Compared:
    """Longitudinal modes of a bar free at both ends, f_n = n c / (2 L), c = sqrt(E / rho), nu = 0: exact in 3D.

    cells : along the bar; order : of the cells' displacement
    """
    length, count = 1.0, 3
    mesh = block_mesh((cells, 1, 1), lambda X: X * [length, 0.1, 0.1], order=order)
    sides = [Support(faces=(a, b), components=(k,)) for k, (a, b) in ((1, ("y0", "y1")), (2, ("z0", "z1")))]
    choice = replace(LINEAR, degree=order)
    problem = _problem(mesh, sides, STEEL, choice)
    modes = _modes(problem, count, density)
    speed = np.sqrt(STEEL.young_modulus / STEEL.density)
    n = np.arange(1, count + 1)
    return Compared(found=modes.frequency[~modes.rigid], expected=0.5 * n * speed / length, modes=modes)


def stretched_bar(stretch: float, cells: int = 16) -> Compared:
    """Longitudinal modes of a bar held at both ends, stretched before to ``stretch`` times its length, nu = 0.

    P = E (l^2 - 1) l / 2 of St. Venant and Kirchhoff's law at the stretch l has the slope E (3 l^2 - 1) / 2: undeformed
    length and density with that modulus, f_n = n c / (2 L), exact in 3D.
    """
    mesh = block_mesh((cells, 1, 1), lambda X: X * [1.0, 0.1, 0.1])
    ends = Support(faces=("x0",), components=(0,)), Support(faces=("x1",), components=(0,), value=(stretch - 1.0,))
    sides = [Support(faces=(a, b), components=(k,)) for k, (a, b) in ((1, ("y0", "y1")), (2, ("z0", "z1")))]
    problem = _problem(mesh, [*ends, *sides], STEEL, LINEAR)
    for _ in solve_increments(NewtonSolver(problem, NewtonSettings()), [1.0], []):
        pass
    modes = _modes(problem, 3, STEEL.density)
    speed = np.sqrt(0.5 * STEEL.young_modulus * (3.0 * stretch**2 - 1.0) / STEEL.density)
    return Compared(found=modes.frequency, expected=0.5 * np.arange(1, 4) * speed, modes=modes)


def waves_on_ground(component: int, *, grips: bool, cells: int = 8) -> Compared:
    """Waves along an upright bar of 1 m, nu = 0, held at its top, pressed on ground of the penalty k = 1.5 E / L.

    component : 2 for waves of length, 0 for shear, all else held: modulus C = E or E / 2, C b cos b + k L sin b = 0,
    f = b c / (2 pi L), exact in 3D; in shear the ground holds what grips alone, else k = 0
    """
    penalty = 1.5 * STEEL.young_modulus
    top = Support(faces=("z1",))
    sides = [Support(faces=(a, b), components=(k,)) for k, (a, b) in ((0, ("x0", "x1")), (1, ("y0", "y1")))]
    ground = ObstacleContact(faces=("z0",), normal=(0.0, 0.0, 1.0), distance_at_touch=0.0, stiffness=penalty, ramp=1e-9)
    domain = Domain.from_tagged(block_mesh((1, 1, cells), lambda X: X * [0.1, 0.1, 1.0]))
    problem = StaticProblem(domain, {"body": STEEL}, [top, *sides], contact=ground, discretisation=LINEAR)
    for _ in solve_increments(NewtonSolver(problem, NewtonSettings()), [1e-6], []):
        pass
    unknowns = np.arange(problem.own_dofs)
    held = np.union1d(unknowns[unknowns % 3 != component], problem.bcs[component].dof_indices()[0])
    (term,) = problem.surfaces.terms
    grip = term if grips else None
    modes = natural_modes(problem, {"body": STEEL.density}, Holds(held=held.astype(np.int64)), 3, grips=grip)
    modulus = STEEL.young_modulus * (1.0 if component == 2 else 0.5)
    k = penalty if grips or component == 2 else 0.0
    n = np.arange(3)
    roots = [brentq(lambda b: modulus * b * np.cos(b) + k * np.sin(b), *ends) for ends in np.pi * np.c_[n + 0.4, n + 1]]
    expected = np.array(roots) * np.sqrt(modulus / STEEL.density) / (2.0 * np.pi)
    return Compared(found=modes.frequency, expected=expected, modes=modes)


def column(share: float, cells: int = 8) -> Compared:
    """Lowest bending mode of a column between guided ends under a share of its Euler load, negative for tension.

    Both ends keep their slope, one moves along the column, both sideways as one: w = cos(pi x / L), the Euler load is
    P_E = pi^2 E I / L^2, and omega^2 = (pi / L)^4 E I / (rho A) (1 - P / P_E) exactly in Euler and Bernoulli's theory.
    At shares above 1 the closed form is the imaginary frequency; found and expected are then negative.
    """
    length, thickness, width = 1.0, 0.01, 0.02
    mesh = block_mesh((cells, 1, 1), lambda X: X * [length, width, thickness])
    strain = share * np.pi**2 / 12.0 * (thickness / length) ** 2
    supports = [
        Support(faces=("x0",), components=(0,)),
        Support(faces=("x1",), components=(0,), value=(-strain * length,)),
        Support(faces=("y0", "y1"), components=(1,)),
        Support(meetings=(("x0", "z0"),), components=(2,)),
    ]
    problem = _problem(mesh, supports, STEEL, replace(LINEAR, gauss_points=(2, 3, 3)))
    solver = NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-10))
    for _ in solve_increments(solver, [1.0], []):
        pass
    # It vibrates free to move sideways as a whole, so that nothing but its ends' slopes is held.
    held = problem.supported[problem.supported % 3 != 2]
    modes = natural_modes(problem, {"body": STEEL.density}, Holds(held=held), 2)
    stiffness = STEEL.young_modulus / STEEL.density * thickness**2 / 12.0
    square = (np.pi / length) ** 4 * stiffness * (1.0 - share)
    lowest = float(modes.eigenvalue[~modes.rigid][0])
    found, expected = (np.sign(x) * np.sqrt(abs(x)) / (2.0 * np.pi) for x in (lowest, square))
    return Compared(found=np.array([found]), expected=np.array([expected]), modes=modes)


def free_ring(cells: int, *, thickness: float = 0.01, density: float = STEEL.density) -> Compared:
    """In-plane bending of a free ring, omega_n^2 = E I n^2 (n^2 - 1)^2 / (rho A R^4 (n^2 + 1)), n = 2, 3, each twice.

    cells : around; thickness : over the radius, as the width. R. Hoppe, J. reine angew. Math. 73, 1871; Love,
    Mathematical Theory of Elasticity, art. 293, as code_aster's V2.03.109 has it.
    """
    radius = 0.5
    t = thickness * radius

    def bent(X: Array) -> Array:
        r, angle = radius + t * (X[:, 2] - 0.5), 2.0 * np.pi * X[:, 0]
        return np.column_stack([r * np.sin(angle), t * (X[:, 1] - 0.5), -r * np.cos(angle)])

    mesh = _closed(block_mesh((cells, 1, 1), bent))
    problem = _problem(mesh, [], STEEL, Discretisation(gauss_points=(2, 3, 3)))
    modes = _modes(problem, 12, density)
    even = [i for i in range(len(modes.eigenvalue)) if not modes.rigid[i] and _in_plane(modes, i) > 0.5]
    n = np.array([2.0, 2.0, 3.0, 3.0])
    square = STEEL.young_modulus * t**2 / (12.0 * STEEL.density * radius**4) * n**2 * (n**2 - 1.0) ** 2 / (n**2 + 1.0)
    return Compared(found=modes.frequency[even[:4]], expected=np.sqrt(square) / (2.0 * np.pi), modes=modes)


def cantilever_plate(cells: int, *, density: float = STEEL.density) -> Compared:
    """Square plate clamped along one edge, nu = 0.3, thickness 1 % of the side, against `BARTON`'s five modes."""
    side, material = 1.0, replace(STEEL, poisson_ratio=0.3)
    h = 0.01 * side
    mesh = block_mesh((cells, cells, 1), lambda X: X * [side, side, h])
    problem = _problem(mesh, [Support(faces=("x0",))], material, LINEAR)
    modes = _modes(problem, len(BARTON), density)
    rigidity = material.young_modulus * h**3 / (12.0 * (1.0 - material.poisson_ratio**2))
    expected = np.array(BARTON) * np.sqrt(rigidity / (material.density * h)) / (2.0 * np.pi * side**2)
    return Compared(found=modes.frequency, expected=expected, modes=modes)


def _problem(
    mesh: TaggedMesh, supports: Sequence[Support], material: Material, choice: Discretisation
) -> StaticProblem:
    return StaticProblem(Domain.from_tagged(mesh), {"body": material}, supports, discretisation=choice)


def _modes(problem: StaticProblem, count: int, density: float) -> Modes:
    held = problem.supported.astype(np.int64)
    return natural_modes(problem, {"body": density}, Holds(held=held), count)


def _in_plane(modes: Modes, number: int) -> float:
    """Share of a mode's energy in motions along x and z."""
    squares = modes.weight @ modes.shape[number] ** 2
    return float((squares[0] + squares[2]) / squares.sum())


def _closed(mesh: TaggedMesh) -> TaggedMesh:
    """Nodes at the same place made one; the faces between them go."""
    _, first, number = np.unique(np.round(mesh.points, 9), axis=0, return_index=True, return_inverse=True)
    inner = [mesh.faces["x0"], mesh.faces["x1"]]
    kept = ~np.isin(mesh.facet_tags, inner)
    return replace(
        mesh,
        points=mesh.points[first],
        cells=number.ravel()[mesh.cells],
        facets=number.ravel()[mesh.facets[kept]],
        facet_tags=mesh.facet_tags[kept],
        faces={name: tag for name, tag in mesh.faces.items() if tag not in inner},
    )
