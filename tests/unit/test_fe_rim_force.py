"""Force between springs and rim: nodes in the mesh's order, a penetration by hand, none without contact."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.mesh import TaggedMesh
from geometry.build import build_mesh
from geometry.wheel import exomars_hoops
from reference_fe.contact.inner import InnerContactTerm
from reference_fe.contact.rim_force import RimForce
from reference_fe.wheel.case import WheelLoadCase
from reference_fe.wheel.problem import wheel_problem

Array = NDArray[np.float64]
STIFFNESS = 1e11
RADIUS = exomars_hoops().tire.inner_radius


@pytest.fixture(scope="module")
def mesh() -> TaggedMesh:
    return build_mesh(exomars_hoops(), element_size=30e-3, axial_size=60e-3, parts="flexible", half_width=True)


def outwards(x: Array, by: float) -> Array:
    """Displacement (n, 3) [m]: what lies 1 mm and more inside the rim moves outwards by so much, the rim not at all."""
    rho = np.hypot(x[:, 0], x[:, 2])
    size = by * np.clip((RADIUS - rho) / 1e-3, 0.0, 1.0) / rho
    return np.asarray(x * np.array([1.0, 0.0, 1.0]) * size[:, None])


def test_it_is_what_the_solver_finds_at_the_same_displacement(mesh: TaggedMesh) -> None:
    """The solver's own term, its displacement given by place instead of by the mesh's numbers; whole wheel, twice."""
    case = WheelLoadCase(orientation_deg=0.0, deflections=(1e-3,), inner_contact_stiffness=STIFFNESS)
    problem = wheel_problem(mesh, dict(exomars_hoops().materials), case).problem
    problem.u.interpolate(lambda x: outwards(x.T, 2e-3).T)
    (term,) = (one for one in problem.surfaces.terms if isinstance(one, InnerContactTerm))
    found = term.evaluate(problem.u.x.array.copy(), 0.0)
    forces = np.linalg.norm(found.force[:, : mesh.facets.shape[1]].sum(axis=1), axis=1)
    assert forces.sum() > 1.0
    assert RimForce(mesh, STIFFNESS)(outwards(mesh.points, 2e-3)) == pytest.approx(2.0 * forces.sum(), rel=1e-9)


def test_it_grows_with_the_penalty_and_needs_contact(mesh: TaggedMesh) -> None:
    one, ten = (RimForce(mesh, k)(outwards(mesh.points, 2e-3)) for k in (STIFFNESS, 10.0 * STIFFNESS))
    assert ten == pytest.approx(10.0 * one, rel=1e-9)
    assert RimForce(mesh, STIFFNESS)(outwards(mesh.points, -1e-3)) == 0.0
    assert RimForce(mesh, STIFFNESS)(0.0 * mesh.points) == 0.0
