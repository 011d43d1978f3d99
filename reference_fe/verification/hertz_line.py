"""Line contact of an elastic block in plane strain with a rigid cylinder: Hertz' half width and peak pressure.

Source: contracts/published/hertz_line.csv, a = sqrt(4 F R / (pi E*)), p0 = 2 F / (pi a) (Johnson, Contact Mechanics,
1985, eqs. 4.43 and 4.45). The obstacle is rigid and the block has all the compliance, E / (1 - nu^2) = E*. A body of
radius 2 R against a cylinder of radius 2 R has the same answer: 1/R = 1/R1 + 1/R2. Hertz' theory is linear; at this
load a / R = 12 %. A cylinder of k times the radius under 1/k of the load has the same half width, and 1/k of the
pressure and of the strain, so that the difference from the theory falls with the first power of k.

What is measured comes from the forces at the nodes, which are what the body feels: pressures at quadrature points of a
facet that is touched in part alternate from point to point. Verified by tests/verification/test_fe_hertz.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contracts.errors import ConvergenceError
from contracts.materials import Material
from contracts.published import published_table
from reference_fe.contact.law import ramped_pressure
from reference_fe.contact.nodal_pressure import nodal_pressure
from reference_fe.contact.obstacle import ContactMethod, ObstacleContact, ObstacleTerm
from reference_fe.contact.obstacles import HalfRoundRock
from reference_fe.contact.patch import contact_faces, facet_areas
from reference_fe.material.hyperelastic import MaterialLaw
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

__all__ = [
    "CELLS",
    "E_STAR",
    "GENTLE",
    "HALF_WIDTH",
    "LOAD",
    "PEAK_PRESSURE",
    "RADIUS",
    "LineContact",
    "line_contact",
    "pressure_on_the_line",
]

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
"""Along the contact and into the depth; half of either within 4 a and 2 a of the middle."""
MIDDLE = 0.8
"""Share of the half width that tells the peak pressure: of the forces at the contact's end only the sum is known."""
GENTLE = 4.0
"""Radius times this and load over it: the same half width at a / R = 3 %, where large strain is worth 0.3 %."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LineContact:
    """What the run measured.

    Attributes
    ----------
    half_width : 3 pi / 4 times the mean distance of the pressure from the middle, on the deformed surface [m]
    peak_pressure : of the semi-ellipse that has the forces of the middle, |x| < 0.8 a of Hertz [Pa]
    load : that the cylinder carries at last [N/m]
    penetration : largest, at the quadrature points [m]
    iterations : linear solves in all
    """

    half_width: float
    peak_pressure: float
    load: float
    penetration: float
    iterations: int


def line_contact(
    obstacle_radius: float = RADIUS,
    body_curvature: float = 0.0,
    method: ContactMethod = ContactMethod.AUGMENTED_LAGRANGIAN,
    cells: tuple[int, int] = CELLS,
    load: float = LOAD,
) -> LineContact:
    """Press a cylinder into the block, flat or of a curvature [1/m], until it carries the load [N/m] to 0.1 %."""
    problem = half_block(obstacle_radius, body_curvature, method, cells)
    iterations = _press_to_the_load(problem, load)
    place, force = _forces_on_the_line(problem)
    return LineContact(
        half_width=float(0.75 * np.pi * (force @ place) / force.sum()),
        peak_pressure=_peak_pressure(place, force),
        load=float(2.0 * force.sum()),
        penetration=_term(problem).penetration(),
        iterations=iterations,
    )


def pressure_on_the_line(cells: tuple[int, int], stiffness: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Deformed places x of the face's nodes [m] and the pressure recovered there [Pa], by the penalty method.

    At the gentle load: `GENTLE` times the radius, half width `HALF_WIDTH`, peak `PEAK_PRESSURE` over `GENTLE`.

    Parameters
    ----------
    cells : along the contact and into the depth
    stiffness : penalty stiffness [N/m^3]
    """
    problem = half_block(GENTLE * RADIUS, 0.0, ContactMethod.PENALTY, cells, stiffness)
    _press_to_the_load(problem, LOAD / GENTLE)
    mesh, term = problem.domain.tagged, _term(problem)
    facets = contact_faces(mesh, term.description.faces)
    shape, areas = facet_areas(mesh, facets, term.description.gauss_points)
    moved = mesh.points + problem.nodal_displacement()
    points = np.einsum("sn,fnk->fsk", shape, moved[facets])
    gap = term.description.gap(points.reshape(-1, 3), float(problem.load_factor.value))
    law = (ramped_pressure(float(g), stiffness, term.description.ramp)[0] for g in gap)
    pressure, _ = nodal_pressure(len(mesh.points), facets, areas, np.fromiter(law, float).reshape(areas.shape))
    on = np.unique(facets)
    return moved[on, 0], pressure[on]


def _forces_on_the_line(problem: StaticProblem) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Deformed places x of the face's stations of nodes [m], from the middle outwards, and their forces [N/m]."""
    on = np.unique(_term(problem).couplings())
    start = problem.V.tabulate_dof_coordinates()
    u = problem.u.x.array.reshape(start.shape)
    upwards = problem.surfaces.force(u.ravel(), 0.0).reshape(start.shape)[on, 2]
    _, which = np.unique(start[on, 0].round(12), return_inverse=True)
    place = np.bincount(which, (start + u)[on, 0]) / np.bincount(which)
    return place, np.bincount(which, upwards) / WIDTH


def _peak_pressure(place: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Largest pressure [Pa] of the semi-ellipse that has the middle's forces [N/m], weighted by (1 - (x / c)^2)^2."""
    middle = np.linspace(0.0, MIDDLE, 2001)
    of_one = np.trapezoid(np.sqrt(1.0 - middle**2) * _weight(middle), middle) * HALF_WIDTH
    return float(force @ _weight(place / HALF_WIDTH) / of_one)


def _weight(x: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.clip(1.0 - (x / MIDDLE) ** 2, 0.0, 1.0) ** 2


def half_block(
    obstacle_radius: float,
    body_curvature: float,
    method: ContactMethod,
    cells: tuple[int, int] = CELLS,
    stiffness: float | None = None,
) -> StaticProblem:
    """Half of a block in plane strain, with small cells at the contact, on a cylinder that rises from below.

    Parameters
    ----------
    obstacle_radius : of the cylinder [m]
    body_curvature : of the block's face, > 0 if convex [1/m]
    cells : along the contact and into the depth
    stiffness : penalty stiffness [N/m^3]; None is that of each facet's cell
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
        stiffness=stiffness,
    )
    choice = Discretisation(law=MaterialLaw.NEO_HOOKEAN, gauss_points=(3, 3, 3))
    domain = Domain.from_tagged(block_mesh((cells[0], 1, cells[1]), mapping))
    return StaticProblem(domain, {"body": BODY}, supports, contact=contact, discretisation=choice)


def _press_to_the_load(problem: StaticProblem, load: float) -> int:
    """Raise the cylinder until it carries the load [N/m] to 0.1 %, by secants on the rise; returns linear solves."""
    solver = NewtonSolver(problem, NewtonSettings(maximum_iterations=40))
    rises, loads, iterations = [0.0, 0.3e-3 * load / LOAD], [0.0], 0
    while abs(loads[-1] / load - 1.0) > 1e-3:
        problem.set_control(rises[-1])
        outcome = solver.solve(rise=rises[-1] - rises[-2])
        if not outcome.converged or len(loads) == 8:
            raise ConvergenceError("the cylinder does not come to carry its load; try a smaller first rise", [])
        iterations += outcome.iterations
        loads.append(2.0 * float(problem.contact_force()[2]) / WIDTH)
        slope = (rises[-1] - rises[-2]) / (loads[-1] - loads[-2])
        rises.append(rises[-1] + (load - loads[-1]) * slope)
    return iterations


def _term(problem: StaticProblem) -> ObstacleTerm:
    (term,) = problem.surfaces.terms
    assert isinstance(term, ObstacleTerm)
    return term
