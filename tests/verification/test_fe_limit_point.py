"""Claim: a run that ends at a limit point says so, with control parameter, load and mode; one that fails otherwise not.

Sources: the path that arc length finds on the same mesh (tests/verification/test_fe_arc_length.py holds it against a
published one); Euler's load of a column. Tolerances: 0.1 % of the limit load, which is extrapolated from two states
within 0.2 % of it; 0.5 % for Euler's load, which leaves out shear and the column's shortening (0.2 % each).
Negative control: a solver that fails on the way at no limit.
"""

from __future__ import annotations

import functools

import numpy as np
import pytest

from contracts.errors import ConvergenceError, IncrementRecord, LimitLoad
from contracts.materials import Material
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support, Traction
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonOutcome, NewtonSettings, NewtonSolver
from reference_fe.verification.hinged_roof import hinged_roof, roof_path
from reference_fe.verification.load_path import limit_loads
from reference_fe.verification.padded_arch import padded_arch
from reference_fe.verification.structured_hexahedra import block_mesh

TWENTIETHS = [0.05 * k for k in range(1, 21)]
path = functools.cache(roof_path)
FEW = NewtonSettings(maximum_iterations=6)


def ended(solver: NewtonSolver, targets: list[float]) -> ConvergenceError:
    """What a run that does not come to its last target says."""
    with pytest.raises(ConvergenceError) as caught:
        list(solve_increments(solver, targets, []))
    return caught.value


def limit_of(error: ConvergenceError) -> LimitLoad:
    assert error.limit is not None
    return error.limit


def test_a_driven_load_ends_at_the_roofs_limit_load() -> None:
    """The load is that of a quarter; the mode moves the crown, where the roof gives way."""
    error = ended(NewtonSolver(hinged_roof((6, 6)), FEW), TWENTIETHS)
    limit = limit_of(error)
    assert limit.control == pytest.approx(limit_loads(path((6, 6)))[0], rel=1e-3)
    assert limit.load == pytest.approx(750.0 * limit.control, rel=2e-3)
    assert not limit.branch
    assert limit.part == "body"
    assert limit.place[0] == 0.0
    assert "limit load: the driven load ends at control 0.1936" in str(error)
    assert "finer mesh or smaller increments do not help" in str(error)


def test_a_driven_displacement_ends_where_it_would_have_to_go_back() -> None:
    """The centre's largest deflection before it snaps back, of the force-driven path on the same mesh."""
    driven = path((6, 6))
    before = driven.deflection[: int(np.argmin(driven.load)), 0].max()
    error = ended(NewtonSolver(hinged_roof((6, 6), drop=30.0), FEW), TWENTIETHS)
    assert 30.0 * limit_of(error).control == pytest.approx(before, rel=5e-3)
    assert "the displacement turns back there: snap-back" in str(error)


def test_a_pressed_arch_ends_at_the_height_that_snaps_back_and_is_followed_there() -> None:
    """Height driven, told; and with ``past_limits`` followed until the arch leaves the ground."""
    heights = [0.5e-3 * k for k in range(1, 25)]
    error = ended(NewtonSolver(padded_arch(), FEW), heights)
    limit = limit_of(error)
    assert limit.part == "body"
    assert limit.place[0] < 5e-3, "the crown"
    assert "driven height of the ground" in str(error)
    found = list[tuple[float, float]]()
    run = solve_increments(NewtonSolver(padded_arch(), FEW), heights, [], past_limits=True)
    with pytest.raises(ConvergenceError, match="the body leaves the obstacle"):
        found.extend((state.control, -state.contact_force[2]) for state in run)
    height, load = np.array(found).T
    fold = int(np.argmax(height))
    assert height[fold] == pytest.approx(limit.control, rel=2e-3)
    assert load[fold] == pytest.approx(limit.load, rel=0.02)
    assert np.all(np.diff(height[fold:]) < 0.0)
    assert np.all(np.diff(load[fold:]) < 0.0)
    assert load[-1] < 1e-3 * load.max()
    assert height[-1] < 0.7 * height[fold]


def test_a_run_goes_on_past_limits_by_itself() -> None:
    """Every target is reached, in order, with the states that load control finds; between them the load falls."""
    problem, history = hinged_roof((6, 6)), list[IncrementRecord]()
    states = list(solve_increments(NewtonSolver(problem, NewtonSettings()), TWENTIETHS, history, past_limits=True))
    assert [state.control for state in states if state.wanted] == TWENTIETHS
    controls = np.array([state.control for state in states])
    assert controls.min() < -0.11
    assert sum(not record.converged for record in history) == 1
    node = int(np.argmin(np.linalg.norm(problem.domain.tagged.points - [0.0, 0.0, 2540.0], axis=1)))
    full = path((6, 6)).deflection[-1, 0]
    assert -problem.nodal_displacement()[node, 2] == pytest.approx(full, rel=1e-6)


class Failing(NewtonSolver):
    """Converges up to a control parameter, and where the tangent is positive definite."""

    last = float("inf")

    def solve(self, rise: float = 0.0) -> NewtonOutcome:
        outcome = super().solve(rise)
        if float(self.problem.load_factor.value) <= self.last and not outcome.negative_pivots:
            return outcome
        return NewtonOutcome(converged=False, residuals=(1.0, 0.5, 0.4), residual=outcome.residual)


def test_control_an_iteration_that_fails_elsewhere_is_not_taken_for_a_limit() -> None:
    solver = Failing(hinged_roof((6, 6)), NewtonSettings())
    solver.last = 0.12
    error = ended(solver, TWENTIETHS)
    assert error.limit is None
    assert "does not converge" in str(error)


def test_a_perfect_column_that_fails_beyond_eulers_load_is_told_to_branch() -> None:
    """Pushed at its free end; the mode bends it, which the straight push does no work on."""
    length, side, modulus = 1.0, 0.04, 2e11
    steel = Material(
        name="steel", young_modulus=modulus, poisson_ratio=0.0, density=1.0, yield_strength=1e9, source="assumed"
    )
    euler = np.pi**2 * modulus * side**4 / 12.0 / (4.0 * length**2)
    mesh = block_mesh((8, 1, 1), lambda X: X * [length, side, 1.5 * side] - [0.0, 0.5 * side, 0.75 * side])
    problem = StaticProblem(
        Domain.from_tagged(mesh),
        {"body": steel},
        [Support(faces=("x0",))],
        loads=[Traction(faces=("x1",), vector=(-euler / side**2, 0.0, 0.0))],
    )
    error = ended(Failing(problem, NewtonSettings()), [0.1 * k for k in range(1, 13)])
    limit = limit_of(error)
    assert limit.branch
    assert limit.control == pytest.approx(1.0, abs=5e-3)
    assert limit.place[0] == length
    assert "another path branches off" in str(error)
