"""Line contact of an elastic block in plane strain with a rigid cylinder: Hertz' half width and peak pressure.

Source: contracts/published/hertz_line.csv, a = sqrt(4 F R / (pi E*)), p0 = 2 F / (pi a) (Johnson, Contact Mechanics,
1985, eqs. 4.43 and 4.45). The obstacle is rigid and the block has all the compliance, E / (1 - nu^2) = E*. A body of
radius 2 R against a cylinder of radius 2 R has the same answer: 1/R = 1/R1 + 1/R2. Hertz' theory is linear; at this
load a / R = 12 %. Verified by tests/verification/test_fe_hertz.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.materials import Material
from contracts.published import published_table
from reference_fe.contact.obstacle import ContactMethod, ObstacleContact, ObstacleTerm
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = ["CELLS", "E_STAR", "HALF_WIDTH", "LOAD", "PEAK_PRESSURE", "RADIUS", "LineContact", "line_contact"]

_TABLE = published_table("hertz_line")
LOAD, RADIUS = 1e3 * float(_TABLE["F_N_per_mm"][0]), 1e-3 * float(_TABLE["R_mm"][0])
"""Load on the line [N/m] and radius of the cylinder [m]."""
E_STAR, HALF_WIDTH = 1e6 * float(_TABLE["Estar_MPa"][0]), 1e-3 * float(_TABLE["a_mm"][0])
PEAK_PRESSURE = 1e6 * float(_TABLE["p0_MPa"][0])
SIZE, WIDTH, POISSON = 0.15, 1e-3, 0.3
BODY = Material(
    name="half space",
    young_modulus=E_STAR * (1.0 - POISSON**2),
    poisson_ratio=POISSON,
    density=1.0,
    yield_strength=1e9,
    source="so that E / (1 - nu^2) is the table's E*",
)
CELLS = (24, 14)
"""Along the contact and into the depth; half of either within 2 a and 4 a of the middle."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LineContact:
    """What the run measured.

    Attributes
    ----------
    half_width, peak_pressure : a [m] and p0 [Pa] of the fit p^2 = p0^2 (1 - x^2 / a^2) on the deformed surface
    penetration : largest, at the quadrature points [m]
    iterations : linear solves in all
    """

    half_width: float
    peak_pressure: float
    penetration: float
    iterations: int


def line_contact(
    obstacle_radius: float = RADIUS,
    body_curvature: float = 0.0,
    method: ContactMethod = ContactMethod.AUGMENTED_LAGRANGIAN,
    cells: tuple[int, int] = CELLS,
) -> LineContact:
    """Press a cylinder into the block, flat or of a curvature [1/m], until it carries the load."""
    problem = half_block(obstacle_radius, body_curvature, method, cells)
    term, iterations = _press_to_the_load(problem)
    points, pressure = term.points_and_pressure()
    on = pressure > 0.05 * pressure.max()
    slope, intercept = np.polyfit(points[on, 0] ** 2, pressure[on] ** 2, 1)
    return LineContact(
        half_width=float(np.sqrt(-intercept / slope)),
        peak_pressure=float(np.sqrt(intercept)),
        penetration=term.penetration(),
        iterations=iterations,
    )


def half_block(
    obstacle_radius: float, body_curvature: float, method: ContactMethod, cells: tuple[int, int] = CELLS
) -> StaticProblem:
    """Half of a block in plane strain, with small cells at the contact, on a cylinder that rises from below.

    Parameters
    ----------
    obstacle_radius : of the cylinder [m]
    body_curvature : of the block's face, > 0 if convex [1/m]
    cells : along the contact and into the depth
    """

    def graded(t: NDArray[np.float64]) -> NDArray[np.float64]:
        near, far = 4.0 * HALF_WIDTH * t, 2.0 * HALF_WIDTH * (SIZE / (2.0 * HALF_WIDTH)) ** (2.0 * t - 1.0)
        return np.where(t < 0.5, near, far)

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        x, z = graded(X[:, 0]), graded(X[:, 2])
        bulge = 0.5 * body_curvature * np.minimum(x, 3.0 * HALF_WIDTH) ** 2
        return np.column_stack([x, WIDTH * X[:, 1], z + bulge * (1.0 - z / SIZE)])

    supports = [
        Support(faces=(face,), components=(axis,)) for face, axis in (("z1", 2), ("x0", 0), ("y0", 1), ("y1", 1))
    ]
    contact = ObstacleContact(
        faces=("z0",),
        normal=(0.0, 0.0, 1.0),
        along=(1.0, 0.0, 0.0),
        distance_at_touch=0.0,
        obstacle=HalfRoundRock(radius=obstacle_radius),
        ramp=1e-7,
        method=method,
    )
    choice = Discretisation(law=MaterialLaw.NEO_HOOKEAN, gauss_points=(3, 3, 3))
    domain = Domain.from_tagged(block_mesh((cells[0], 1, cells[1]), mapping))
    return StaticProblem(domain, {"body": BODY}, supports, contact=contact, discretisation=choice)


def _press_to_the_load(problem: StaticProblem) -> tuple[ObstacleTerm, int]:
    """Raise the cylinder until it carries the load within 0.1 %, by secants on the rise; the contact, linear solves."""
    solver = NewtonSolver(problem, NewtonSettings(maximum_iterations=40))
    rises, loads, iterations = [0.0, 0.3e-3], [0.0], 0
    while abs(loads[-1] / LOAD - 1.0) > 1e-3:
        problem.set_control(rises[-1])
        outcome = solver.solve(rise=rises[-1] - rises[-2])
        if not outcome.converged or len(loads) == 8:
            raise ConvergenceError("the cylinder does not come to carry its load; try a smaller first rise", [])
        iterations += outcome.iterations
        loads.append(2.0 * float(problem.contact_force()[2]) / WIDTH)
        slope = (rises[-1] - rises[-2]) / (loads[-1] - loads[-2])
        rises.append(rises[-1] + (LOAD - loads[-1]) * slope)
    (term,) = problem.surfaces.terms
    assert isinstance(term, ObstacleTerm)
    return term, iterations
