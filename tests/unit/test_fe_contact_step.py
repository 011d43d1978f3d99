"""One Newton step settles contact on a body that is linear, and leaves its terms evaluated where it ends."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contracts.materials import Material
from reference_fe.contact import newton_step as contact_step
from reference_fe.contact.surface_term import SurfaceForces
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support
from reference_fe.solver.newton import NewtonSettings, NewtonSolver
from reference_fe.verification.structured_hexahedra import block_mesh

SOFT = Material(name="a", young_modulus=3.0, poisson_ratio=0.3, density=1.0, yield_strength=1.0, source="test")
SMALL = 1e-9
"""Displacement [m] at which the unit block is linear to round-off."""


class Stops:
    """A load along x at nodes of the end face, and springs that stop them at gaps of their own."""

    pattern_version = 0

    def __init__(self, gaps: NDArray[np.float64], stiffness: float, load: float) -> None:
        self.gaps, self.stiffness, self.load = gaps, stiffness, load
        self.nodes = np.zeros((len(gaps), 1), dtype=np.int64)

    def build(self, domain: Domain, V: Any) -> Stops:
        along = V.tabulate_dof_coordinates()[:, 0]
        self.nodes = np.argsort(-along, kind="stable")[: len(self.gaps), None].astype(np.int64)
        return self

    def couplings(self) -> NDArray[np.int64]:
        return self.nodes

    def set_control(self, control: float) -> None:
        pass

    def evaluate(self, u: NDArray[np.float64], lag: float) -> SurfaceForces:
        depth = u[3 * self.nodes[:, 0]] - self.gaps
        force, stiffness = np.zeros((len(depth), 1, 3)), np.zeros((len(depth), 1, 3, 1, 3))
        force[:, 0, 0] = self.load - self.stiffness * np.maximum(depth, 0.0)
        stiffness[:, 0, 0, 0, 0] = np.where(depth > 0.0, self.stiffness, 0.0)
        return SurfaceForces(nodes=self.nodes, force=force, stiffness=stiffness)

    def resultant(self) -> NDArray[np.float64]:
        return np.zeros(3)

    def augment(self) -> bool:
        return False

    def accept(self) -> None:
        pass

    def state(self) -> dict[str, NDArray[np.float64]]:
        return {}

    def restore(self, state: object) -> None:
        pass


def stopped_block(stiffness: float) -> NewtonSolver:
    """Some of the end's nine nodes reach their stop, others are drawn back from theirs by the neighbours."""
    stops = Stops(SMALL * np.linspace(0.05, 2.0, 9), stiffness, 0.3 * SMALL)
    domain = Domain.from_tagged(block_mesh((2, 1, 1), lambda X: X))
    problem = StaticProblem(domain, {"body": SOFT}, [Support(faces=("x0",))], surfaces=[stops])
    return NewtonSolver(problem, NewtonSettings(relative_tolerance=1e-8))


@pytest.mark.parametrize("stiffness", [1.0, 1e3])
def test_linear_body_is_solved_with_one_factorisation(stiffness: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact_step, "TOLERANCE", 1e-12)
    once = stopped_block(stiffness)
    assert once.solve().iterations == 1
    monkeypatch.setattr(contact_step, "INNER_LIMIT", 0)
    often = stopped_block(stiffness)
    outcome = often.solve()
    assert outcome.converged
    assert outcome.iterations >= 3
    np.testing.assert_allclose(once.problem.u.x.array, often.problem.u.x.array, atol=1e-6 * SMALL)


def test_step_leaves_the_surface_terms_evaluated_where_it_ends() -> None:
    solver = stopped_block(1e3)
    outcome = solver.solve()
    np.testing.assert_allclose(outcome.residual, solver.problem.residual(), atol=1e-12 * SMALL)
