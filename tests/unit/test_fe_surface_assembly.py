"""Surface terms in the residual and the matrix, checked with a nonlinear spring between far nodes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe.contact.surface_term import SurfaceForces
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import Discretisation, StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

SOFT = Material(name="a", young_modulus=3.0, poisson_ratio=0.3, density=1.0, yield_strength=1.0, source="test")


class SpringTerm:
    """Pull k (1 + w.w) w - control on the relative displacement w of two nodes; its components couple."""

    def __init__(self, nodes: tuple[int, int], k: float = 0.7) -> None:
        self.nodes, self.k, self.control, self.version, self.solves_left = nodes, k, 0.0, 0, 0

    def build(self, domain: Domain, V: Any) -> SpringTerm:
        return self

    @property
    def pattern_version(self) -> int:
        return self.version

    def couplings(self) -> NDArray[np.int64]:
        return np.array([[*self.nodes, -1]])

    def set_control(self, control: float) -> None:
        self.control = control

    def evaluate(self, u: NDArray[np.float64], lag: float) -> SurfaceForces:
        a, b = (u[3 * n : 3 * n + 3] for n in self.nodes)
        w = b - a
        pull = self.k * (1.0 + w @ w) * w - self.control
        slope = self.k * ((1.0 + w @ w) * np.eye(3) + 2.0 * np.outer(w, w))
        force, stiffness = np.zeros((1, 3, 3)), np.zeros((1, 3, 3, 3, 3))
        force[0, 0], force[0, 1] = pull, -pull
        for i, row in enumerate((1.0, -1.0)):
            for j, column in enumerate((1.0, -1.0)):
                stiffness[0, i, :, j] = row * column * slope
        return SurfaceForces(nodes=self.couplings(), force=force, stiffness=stiffness)

    def resultant(self) -> NDArray[np.float64]:
        return np.zeros(3)

    def augment(self) -> bool:
        self.solves_left -= 1
        return self.solves_left >= 0

    def accept(self) -> None:
        pass

    def state(self) -> dict[str, NDArray[np.float64]]:
        return {}

    def restore(self, state: object) -> None:
        pass


def sprung_block(*, compiled: bool) -> tuple[StaticProblem, SpringTerm]:
    term = SpringTerm((0, 0))
    made = StaticProblem(
        Domain.from_tagged(block_mesh((3, 1, 1), lambda X: X * [3.0, 1.0, 1.0])),
        {"body": SOFT},
        [Support(faces=("x0",))],
        surfaces=[term],
        discretisation=Discretisation(compiled=compiled),
    )
    far = np.argsort(made.V.tabulate_dof_coordinates()[:, 0])
    term.nodes = int(far[len(far) // 2]), int(far[-1])
    return made, term


def dense(made: StaticProblem) -> NDArray[np.float64]:
    indptr, indices, values = made.unsupported_tangent().getValuesCSR()
    out = np.zeros((made.dofs, made.dofs))
    out[np.repeat(np.arange(made.dofs), np.diff(indptr)), indices] = values
    return out


@pytest.mark.parametrize("compiled", [True, False])
def test_tangent_is_the_derivative_of_the_residual(compiled: bool) -> None:
    made, _ = sprung_block(compiled=compiled)
    rng = np.random.default_rng(5)
    u = 0.05 * rng.standard_normal(made.dofs)
    direction = rng.standard_normal(made.dofs)
    residuals = []
    for step in (1e-6, -1e-6, 0.0):
        made.u.x.array[:] = u + step * direction
        residuals.append(made.residual())
    made.store_stress(extrapolate=False)
    slope = (residuals[0] - residuals[1]) / 2e-6
    np.testing.assert_allclose(dense(made) @ direction, slope, atol=1e-8)


def test_product_with_the_stiffness_is_the_derivative_of_the_force() -> None:
    made, _ = sprung_block(compiled=True)
    rng = np.random.default_rng(6)
    u, direction = 0.05 * rng.standard_normal(made.dofs), rng.standard_normal(made.dofs)
    made.surfaces.force(u, 0.0)
    stiffness = made.surfaces.stiffness()
    ahead, behind = (made.surfaces.force(u + step * direction, 0.0) for step in (1e-6, -1e-6))
    product = made.surfaces.product(stiffness, direction)
    assert np.linalg.norm(product) > 0.1
    np.testing.assert_allclose(product, (behind - ahead) / 2e-6, atol=1e-8)


@pytest.mark.parametrize("compiled", [True, False])
def test_newton_solves_with_a_pattern_that_changes(compiled: bool) -> None:
    made, term = sprung_block(compiled=compiled)
    solver = NewtonSolver(made, NewtonSettings(relative_tolerance=1e-10))
    ends = []
    for nodes in (term.nodes, (term.nodes[0], term.nodes[1] - 1), term.nodes):
        term.nodes, term.version = nodes, term.version + 1
        made.set_control(0.05)
        outcome = solver.solve()
        assert outcome.converged
        assert outcome.iterations <= 8
        ends.append(made.u.x.array.copy())
    assert np.linalg.norm(ends[0] - ends[1]) > 1e-3 * np.linalg.norm(ends[0])
    np.testing.assert_allclose(ends[2], ends[0], atol=1e-9)


@pytest.mark.parametrize("compiled", [True, False])
def test_room_in_the_pattern_is_kept_until_it_is_used(compiled: bool) -> None:
    """A contact that opens only after the first matrix was assembled: same pattern, new entries."""
    made, term = sprung_block(compiled=compiled)
    spring = term.evaluate
    term.evaluate = lambda u, lag: replace(spring(u, lag), nodes=np.full((1, 3), -1))  # type: ignore[method-assign]
    made.residual()
    matrix = made.tangent(None)
    row, column = sorted(3 * node for node in term.nodes)  # in the upper triangle
    assert matrix.getValue(row, column) == pytest.approx(0.0, abs=1e-12)
    term.evaluate = spring  # type: ignore[method-assign]
    made.residual()
    assert made.tangent(matrix).getValue(row, column) == pytest.approx(-term.k, rel=1e-9)


def test_augmentation_asks_for_more_solves() -> None:
    made, term = sprung_block(compiled=True)
    term.solves_left = 2
    made.set_control(0.05)
    outcome = NewtonSolver(made, NewtonSettings()).solve()
    assert outcome.converged
    assert outcome.augmentations == 2
    assert outcome.residuals[-1] <= 1e-8
