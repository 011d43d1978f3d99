"""Claim: a thin elastic ring pressed between frictionless rigid plates follows the elastica to 60 % compression.

Source: tests/data/analytic/ring_between_plates_elastica.csv (quadrature of the inextensible elastica); beyond the load
at which the contact splits, h/R = I1 / sqrt(p) with I1 = 1.198140234736, p = P R^2 / EI. Tolerance 1 %: the ring is
0.6 mm thick at R = 142.5 mm (t/R = 0.4 %), so that extension, shear and thickness together stay far below it.
Effort: at most 60 Newton iterations in all.
"""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.materials import Material
from reference_fe.contact_obstacle import ContactMethod, ObstacleContact
from reference_fe.domain import Domain
from reference_fe.hyperelastic import MaterialLaw
from reference_fe.increments import ConvergedState, solve_increments
from reference_fe.newton import NewtonSettings, NewtonSolver
from reference_fe.orientation import curved_axis_first
from reference_fe.static_problem import Discretisation, StaticProblem
from reference_fe.stress import StressRecovery
from reference_fe.supports import Support
from tests.structured_hexahedra import block_mesh

RADIUS, THICKNESS, WIDTH = 0.1425, 0.6e-3, 0.02
STRIP = Material(
    name="strip", young_modulus=1e11, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="round numbers"
)
BENDING_STIFFNESS = STRIP.young_modulus * WIDTH * THICKNESS**3 / 12.0
COMPRESSIONS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)


def quarter_ring(
    elements: int,
    discretisation: Discretisation | None = None,
    *,
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0),
    thickness: float = THICKNESS,
    stiffness: float = 1e9,
    method: ContactMethod = ContactMethod.PENALTY,
) -> StaticProblem:
    """Quarter of the ring, symmetric at its lowest and foremost points, on a plane below it."""

    def mapping(X: NDArray[np.float64]) -> NDArray[np.float64]:
        angle, r = 0.5 * np.pi * X[:, 0], RADIUS + thickness * (X[:, 2] - 0.5)
        return np.column_stack([r * np.sin(angle), WIDTH * X[:, 1], -r * np.cos(angle)])

    mesh = curved_axis_first(block_mesh((elements, 1, 1), mapping))
    supports = [Support(faces=(face,), components=(axis,)) for face, axis in (("x0", 0), ("x1", 2), ("y0", 1))]
    plane = ObstacleContact(
        faces=("z1",), normal=normal, distance_at_touch=RADIUS + thickness / 2, stiffness=stiffness, method=method
    )
    return StaticProblem(
        Domain.from_tagged(mesh), {"body": STRIP}, supports, contact=plane, discretisation=discretisation
    )


def press(problem: StaticProblem, compressions: tuple[float, ...] = COMPRESSIONS) -> list[ConvergedState]:
    """Raise the plane; control is compression times R."""
    settings = NewtonSettings(maximum_iterations=40)
    return list(solve_increments(NewtonSolver(problem, settings), [c * RADIUS for c in compressions], []))


def load_parameter(states: list[ConvergedState]) -> NDArray[np.float64]:
    """p = P R^2 / EI; the quarter carries half of P."""
    return np.array([2.0 * state.contact_force[2] * RADIUS**2 / BENDING_STIFFNESS for state in states])


def elastica(compressions: tuple[float, ...]) -> NDArray[np.float64]:
    """Load parameter of the elastica at compressions of the diameter."""
    table = np.loadtxt(
        Path(__file__).parents[1] / "data/analytic/ring_between_plates_elastica.csv", delimiter=",", skiprows=3
    )
    split = table[table[:, 3] > 0.0, 1].min()
    before = [np.interp(c, table[:, 1], table[:, 0]) for c in compressions]
    return np.array(
        [(1.198140234736 / (1.0 - c)) ** 2 if c > split else b for c, b in zip(compressions, before, strict=True)]
    )


@functools.cache
def reference_run() -> tuple[ConvergedState, ...]:
    return tuple(press(quarter_ring(40)))


def relative_error(states: list[ConvergedState]) -> float:
    return float(np.max(np.abs(load_parameter(states) / elastica(COMPRESSIONS) - 1.0)))


def test_ring_follows_the_elastica() -> None:
    assert relative_error(list(reference_run())) < 0.01


def test_ring_needs_few_newton_iterations() -> None:
    assert sum(state.outcome.iterations for state in reference_run()) <= 60


def test_a_wrong_thickness_is_caught() -> None:
    """Negative control: one per cent of thickness is three per cent of bending stiffness."""
    assert relative_error(press(quarter_ring(40, thickness=1.01 * THICKNESS))) > 0.02


def test_full_integration_locks_on_a_coarse_mesh() -> None:
    """Negative control of the quadrature: with three points along the arc, 12 elements are far too stiff."""
    exact = elastica((0.1,))
    reduced = load_parameter(press(quarter_ring(12), (0.1,))) / exact - 1.0
    full = load_parameter(press(quarter_ring(12, Discretisation(gauss_points=(3, 3, 3))), (0.1,))) / exact - 1.0
    assert abs(reduced[0]) < 0.01
    assert full[0] > 0.2


def test_every_increment_balances() -> None:
    for state in reference_run():
        assert np.linalg.norm(state.reaction + state.contact_force) < 1e-6 * np.linalg.norm(state.contact_force)
        assert state.outcome.residuals[-1] <= 1e-8


@pytest.mark.parametrize("law", list(MaterialLaw))
def test_plain_newton_finds_the_same_state(law: MaterialLaw) -> None:
    """The mixed integration points change the way, not the solution (Magisano et al. 2017): equal load to 1e-6."""
    mixed = press(quarter_ring(12, Discretisation(law=law)), (0.01,))
    plain = press(
        quarter_ring(12, Discretisation(law=law, mixed_integration_points=False)), (0.001, 0.004, 0.007, 0.01)
    )
    assert plain[-1].contact_force[2] == pytest.approx(mixed[-1].contact_force[2], rel=1e-6)


def test_a_flipped_normal_is_caught() -> None:
    """Negative control: a plane whose normal points away from the ring is refused before anything is solved."""
    with pytest.raises(InputError, match="normal pointing to the body"):
        quarter_ring(12, normal=(0.0, 0.0, -1.0))


def test_stress_is_that_of_bending() -> None:
    """At 10 % compression the elastica gives the curvatures; fibre stress = E t/2 times their change, to 2 %."""
    problem = quarter_ring(40)
    press(problem, (0.1,))
    table = np.loadtxt(
        Path(__file__).parents[1] / "data/analytic/ring_between_plates_elastica.csv", delimiter=",", skiprows=3
    )
    curvature_change = np.array([np.interp(0.1, table[:, 1], table[:, k]) - 1.0 for k in (4, 5)]) / RADIUS
    fibre_stress = STRIP.young_modulus * 0.5 * THICKNESS * np.abs(curvature_change)
    recovery = StressRecovery(problem)
    assert recovery.largest_by_part()["body"] == pytest.approx(fibre_stress.max(), rel=0.02)
    points, stress = problem.domain.tagged.points, recovery.nodal_von_mises()
    at_ends = [stress[np.abs(points[:, axis]) < 1e-9].max() for axis in (0, 2)]  # contact, and a quarter turn on
    np.testing.assert_allclose(at_ends, fibre_stress, rtol=0.03)
