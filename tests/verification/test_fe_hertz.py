"""Claim: line contact of an elastic body with a rigid cylinder follows Hertz: half width and peak pressure to 3 %.

Source: tests/data/analytic/hertz_line.csv, a = sqrt(4 F R / (pi E*)), p0 = 2 F / (pi a) (Johnson, Contact Mechanics,
1985, eqs. 4.43 and 4.45). Here the obstacle is rigid and the block has all the compliance, E / (1 - nu^2) = E*. Hertz'
theory is linear; at this load a / R = 12 %, so that large strain accounts for most of the tolerance (neo-Hookean
material, half width on the deformed surface; measured: 0.1 % and 2.1 %). Half width and peak come from a fit of
p^2 = p0^2 (1 - x^2 / a^2). The same load on a body of radius 2 R against a cylinder of radius 2 R has the same answer:
1/R = 1/R1 + 1/R2.
"""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe.contact_obstacle import ContactMethod, ObstacleContact, ObstacleTerm
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.obstacles import HalfRoundRock
from reference_fe.static_problem import Discretisation, StaticProblem
from reference_fe.supports import Support
from tests.structured_hexahedra import block_mesh

F, R, E_STAR, A, P0 = np.loadtxt(
    Path(__file__).parents[1] / "data/analytic/hertz_line.csv", delimiter=",", skiprows=2
) * [1e3, 1e-3, 1e6, 1e-3, 1e6]
SIZE, WIDTH, POISSON = 0.15, 1e-3, 0.3
BODY = Material(
    name="half space",
    young_modulus=E_STAR * (1.0 - POISSON**2),
    poisson_ratio=POISSON,
    density=1.0,
    yield_strength=1e9,
    source="so that E / (1 - nu^2) is the table's E*",
)


def half_block(obstacle_radius: float, body_curvature: float, method: ContactMethod) -> StaticProblem:
    """Half of a block in plane strain, cells of a/6 at the contact, on a cylinder that rises from below."""

    def graded(t: NDArray[np.float64]) -> NDArray[np.float64]:
        near, far = 4.0 * A * t, 2.0 * A * (SIZE / (2.0 * A)) ** (2.0 * t - 1.0)
        return np.where(t < 0.5, near, far)

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        x, z = graded(X[:, 0]), graded(X[:, 2])
        bulge = 0.5 * body_curvature * np.minimum(x, 3.0 * A) ** 2
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
    domain = Domain.from_tagged(block_mesh((24, 1, 14), mapping))
    return StaticProblem(domain, {"body": BODY}, supports, contact=contact, discretisation=choice)


def press_to_the_load(problem: StaticProblem) -> ObstacleTerm:
    """Raise the cylinder until it carries F, by secants on the rise."""
    solver = NewtonSolver(problem, NewtonSettings(maximum_iterations=40))
    rises, loads = [0.0], [0.0]
    while abs(loads[-1] / F - 1.0) > 1e-3:
        rise = (
            0.3e-3
            if len(rises) == 1
            else rises[-1] + (F - loads[-1]) * (rises[-1] - rises[-2]) / (loads[-1] - loads[-2])
        )
        problem.set_control(rise)
        assert solver.solve(rise=rise - rises[-1]).converged
        rises.append(rise)
        loads.append(2.0 * float(problem.contact_force()[2]) / WIDTH)
        assert len(rises) < 8
    (term,) = problem.surfaces.terms
    assert isinstance(term, ObstacleTerm)
    return term


@functools.cache
def half_width_and_peak(
    obstacle_radius: float = R, body_curvature: float = 0.0, method: ContactMethod = ContactMethod.AUGMENTED_LAGRANGIAN
) -> tuple[float, float, float]:
    """a [m], p0 [Pa] by fit, and the largest penetration [m]."""
    term = press_to_the_load(half_block(obstacle_radius, body_curvature, method))
    points, pressure = term.points_and_pressure()
    on = pressure > 0.05 * pressure.max()
    slope, intercept = np.polyfit(points[on, 0] ** 2, pressure[on] ** 2, 1)
    return float(np.sqrt(-intercept / slope)), float(np.sqrt(intercept)), term.penetration()


def test_the_table_is_hertz_formula() -> None:
    assert pytest.approx(np.sqrt(4.0 * F * R / (np.pi * E_STAR)), rel=1e-8) == A
    assert pytest.approx(2.0 * F / (np.pi * A), rel=1e-8) == P0


@pytest.mark.parametrize(("radius", "curvature"), [(R, 0.0), (2.0 * R, 0.5 / R)], ids=["flat", "two radii"])
def test_half_width_and_peak_pressure(radius: float, curvature: float) -> None:
    a, p0, penetration = half_width_and_peak(radius, curvature)
    assert a == pytest.approx(A, rel=0.03)
    assert p0 == pytest.approx(P0, rel=0.03)
    assert penetration < 1e-6


def test_a_wrong_radius_is_caught() -> None:
    """Negative control: a cylinder of 1.2 R makes the contact 10 % wider."""
    a, p0, _ = half_width_and_peak(1.2 * R)
    assert abs(a / A - 1.0) > 0.05
    assert abs(p0 / P0 - 1.0) > 0.05
