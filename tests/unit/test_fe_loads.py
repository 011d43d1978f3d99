"""Line loads, end moments and supports where faces meet: totals, symmetry, derivative, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.errors import InputError
from contracts.materials import Material
from reference_fe.dolfinx_api import ufl
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.problem.supports import BodyForce, EdgeLoad, EndMoment, Load, Support, Traction
from reference_fe.verification.structured_hexahedra import block_mesh

SOFT = Material(name="soft", young_modulus=1e6, poisson_ratio=0.3, density=1.0, yield_strength=1e9, source="none")
RADIUS, WIDTH, THICKNESS = 2.0, 0.5, 0.1
MOMENT = EndMoment(faces=("x1",), magnitude=300.0, axis=(0.0, 1.0, 0.0), director=(1.0, 0.0, 0.0))


def arc(X: NDArray[np.float64]) -> NDArray[np.float64]:
    """A quarter ring in the xz plane; face x1 lies at z = 0 with the thickness along x, z1 is the outer face."""
    angle, r = 0.5 * np.pi * X[:, 0], RADIUS + THICKNESS * (X[:, 2] - 0.5)
    return np.column_stack([r * np.sin(angle), WIDTH * X[:, 1], r * np.cos(angle)])


def quarter_ring(
    loads: list[Load],
    family: ElementFamily = ElementFamily.LAGRANGE,
    supports: tuple[Support, ...] = (),
) -> StaticProblem:
    problem = StaticProblem(
        Domain.from_tagged(block_mesh((8, 1, 1), arc)),
        {"body": SOFT},
        supports,
        loads=loads,
        discretisation=Discretisation(family=family, mixed_integration_points=False),
    )
    problem.set_control(1.0)
    return problem


def load_vector(problem: StaticProblem) -> NDArray[np.float64]:
    """External force at every unknown in the present state, (n_dofs,) [N]."""
    loaded = problem.residual()
    problem.set_control(0.0)
    unloaded = problem.residual()
    problem.set_control(1.0)
    return unloaded - loaded


@pytest.mark.parametrize("family", list(ElementFamily))
def test_a_line_load_sums_to_its_length(family: ElementFamily) -> None:
    """Along the outer arc: the total is the load times a quarter circle (parabolic edges: to 1e-5)."""
    problem = quarter_ring([EdgeLoad(meeting=("z1", "y0"), vector=(3.0, 0.0, -2.0))], family)
    total = load_vector(problem).reshape(-1, 3).sum(axis=0)
    length = 0.5 * np.pi * (RADIUS + THICKNESS / 2.0)
    np.testing.assert_allclose(total, [3.0 * length, 0.0, -2.0 * length], rtol=1e-5, atol=1e-12)


def test_a_line_load_works_on_a_linear_displacement_as_its_integral() -> None:
    """Work on u = (x, 0, 0) of a unit load along x on the outer arc: integral of R sin(a) R da = R^2."""
    problem = quarter_ring([EdgeLoad(meeting=("z1", "y0"), vector=(1.0, 0.0, 0.0))])
    force = load_vector(problem)
    problem.u.interpolate(lambda x: np.stack([x[0], 0.0 * x[0], 0.0 * x[0]]))
    assert force @ problem.u.x.array == pytest.approx((RADIUS + THICKNESS / 2.0) ** 2, rel=1e-5)


def test_faces_that_do_not_meet_carry_no_line_load() -> None:
    with pytest.raises(InputError, match="must be faces that meet"):
        quarter_ring([EdgeLoad(meeting=("z0", "z1"), vector=(1.0, 0.0, 0.0))])


@pytest.mark.parametrize("family", list(ElementFamily))
def test_a_body_force_sums_to_volume_and_a_traction_to_area(family: ElementFamily) -> None:
    weight = BodyForce(parts=("body",), field=lambda X: ufl.as_vector((0.0, 0.0, -7.0)))
    shear = Traction(faces=("x1",), vector=(0.0, 11.0, 0.0))
    total = load_vector(quarter_ring([weight, shear], family)).reshape(-1, 3).sum(axis=0)
    volume = 0.5 * np.pi * RADIUS * WIDTH * THICKNESS
    np.testing.assert_allclose(total, [0.0, 11.0 * WIDTH * THICKNESS, -7.0 * volume], rtol=1e-5, atol=1e-9)


def test_an_end_moment_is_a_pure_couple_in_any_plane_state() -> None:
    """After a large plane motion: no resultant force, and the work on a further rotation is magnitude times area."""
    problem = quarter_ring([MOMENT])
    problem.u.interpolate(
        lambda x: np.stack([0.4 * x[2] - 0.2 * x[0] * x[2], 0.0 * x[0], 0.3 * x[0] ** 2 - 1.5 * x[0]])
    )
    force, rotation = load_vector(problem), problem.du
    assert np.abs(force.reshape(-1, 3).sum(axis=0)).max() < 1e-9 * np.abs(force).max()
    u = problem.u.x.array.reshape(-1, 3)
    position = problem.V.tabulate_dof_coordinates() + u
    rotation.x.array.reshape(-1, 3)[:] = np.cross([0.0, 1.0, 0.0], position)
    area = WIDTH * THICKNESS
    assert force @ rotation.x.array == pytest.approx(MOMENT.magnitude * area, rel=1e-9)


def test_the_tangent_of_an_end_moment_is_symmetric_and_the_derivative() -> None:
    problem = quarter_ring([MOMENT])
    rng = np.random.default_rng(3)
    plane = np.tile([1.0, 0.0, 1.0], problem.dofs // 3)
    base, direction = (0.01 * rng.standard_normal(problem.dofs) * plane for _ in range(2))
    problem.u.x.array[:] = base
    matrix = problem.unsupported_tangent()
    x, y = matrix.createVecRight(), matrix.createVecLeft()
    x.array[:] = direction
    matrix.mult(x, y)
    h, sides = 1e-5, []
    for sign in (1.0, -1.0):
        problem.u.x.array[:] = base + sign * h * direction
        sides.append(problem.residual())
    difference = (sides[0] - sides[1]) / (2.0 * h)
    np.testing.assert_allclose(y.array, difference, rtol=0.0, atol=1e-6 * np.abs(difference).max())
    assert matrix.isSymmetric(tol=1e-9 * matrix.norm())


@pytest.mark.parametrize(("meeting", "nodes"), [(("x0", "z1"), 3), (("x0", "y0", "z0"), 1), (("y0", "z1"), 17)])
def test_a_support_holds_the_nodes_where_faces_meet(meeting: tuple[str, ...], nodes: int) -> None:
    problem = quarter_ring([], supports=(Support(meetings=(meeting,), components=(1,)),))
    assert len(problem.supported) == nodes
    assert np.all(problem.supported % 3 == 1)


def test_bad_loads_are_refused() -> None:
    with pytest.raises(InputError, match="two faces or more"):
        Support(meetings=(("x0",),))
    with pytest.raises(InputError, match="axis"):
        EndMoment(faces=("x1",), magnitude=1.0, axis=(0.0, 2.0, 0.0), director=(1.0, 0.0, 0.0))
    with pytest.raises(InputError, match="right angles"):
        EndMoment(faces=("x1",), magnitude=1.0, axis=(0.0, 1.0, 0.0), director=(0.0, 1.0, 0.0))
