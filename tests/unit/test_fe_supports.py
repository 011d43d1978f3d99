"""Supports of a mid-surface and its lines, and the force of each support by its name."""

from __future__ import annotations

import numpy as np
import pytest

from contracts.errors import InputError
from reference_fe.problem.balance import support_forces
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, ElementFamily, StaticProblem
from reference_fe.problem.supports import Middle, Support, Traction
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh
from tests.unit.test_fe_loads import SOFT


def block(counts: tuple[int, int, int], supports: list[Support], order: int = 2, **choices: object) -> StaticProblem:
    """A bent wall, 0.1 m thick; z0 is inside."""

    def mapping(X: np.ndarray) -> np.ndarray:
        angle, r = X[:, 0], 1.0 + 0.1 * X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle)])

    mesh = block_mesh(counts, mapping, order)
    return StaticProblem(Domain.from_tagged(mesh), {"body": SOFT}, supports, **choices)  # type: ignore[arg-type]


def held(problem: StaticProblem) -> np.ndarray:
    return np.asarray(problem.V.tabulate_dof_coordinates()[np.unique(problem.supported // 3)])


@pytest.mark.parametrize(("counts", "order", "nodes"), [((2, 3, 1), 2, 7), ((2, 3, 2), 2, 7), ((2, 3, 2), 1, 4)])
def test_a_hinge_is_the_line_of_the_mid_surface(counts: tuple[int, int, int], order: int, nodes: int) -> None:
    choice = Discretisation() if order == 2 else Discretisation(degree=1, gauss_points=(2, 2, 2))
    edge = Middle(between=("z0", "z1"), within=("x1",))
    places = held(block(counts, [Support(middles=(edge,), components=(0, 2))], order, discretisation=choice))
    assert len(places) == nodes
    np.testing.assert_allclose(np.hypot(places[:, 0], places[:, 2]), 1.05)
    np.testing.assert_allclose(np.arctan2(places[:, 0], places[:, 2]), 1.0)


def test_a_mid_surface_and_a_point_of_it() -> None:
    whole = held(block((2, 3, 1), [Support(middles=(Middle(between=("z0", "z1")),))]))
    assert len(whole) == 5 * 7
    np.testing.assert_allclose(np.hypot(whole[:, 0], whole[:, 2]), 1.05)
    point = held(block((2, 3, 1), [Support(middles=(Middle(between=("z0", "z1"), within=("x0", "y0")),))]))
    np.testing.assert_allclose(point, [[0.0, 0.0, 1.05]], atol=1e-15)


@pytest.mark.parametrize(
    ("counts", "order", "choice", "words"),
    [
        ((2, 2, 1), 1, Discretisation(degree=1, gauss_points=(2, 2, 2)), "no node halfway"),
        ((2, 2, 1), 2, Discretisation(family=ElementFamily.SERENDIPITY, gauss_points=(2, 2, 2)), "nodal values"),
    ],
)
def test_a_middle_without_nodes_is_refused(
    counts: tuple[int, int, int], order: int, choice: Discretisation, words: str
) -> None:
    with pytest.raises(InputError, match=words):
        block(counts, [Support(middles=(Middle(between=("z0", "z1")),))], order, discretisation=choice)


def test_each_support_tells_its_force() -> None:
    """A plate pulled at an unsupported face: the clamp takes the whole force; a free name takes none."""

    def mapping(X: np.ndarray) -> np.ndarray:
        return np.asarray(X * [1.0, 0.2, 0.1])

    problem = StaticProblem(
        Domain.from_tagged(block_mesh((2, 1, 1), mapping)),
        {"body": SOFT},
        [
            Support(faces=("x0",), components=(0,), name="clamp"),
            Support(faces=("x0", "y0"), components=(1,), name="side"),
            Support(faces=("z0",), components=(2,)),
        ],
        loads=[Traction(faces=("x1",), vector=(1.0, 0.0, 0.0))],
    )
    problem.set_control(1.0)
    outcome = NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-10)).solve()
    forces = support_forces(problem, outcome.residual)
    assert sorted(forces) == ["clamp", "side"]
    np.testing.assert_allclose(forces["clamp"], [-2e-2, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(forces["side"], 0.0, atol=1e-9)
    np.testing.assert_allclose(forces["clamp"] + forces["side"], problem.reaction(outcome.residual), atol=1e-9)
