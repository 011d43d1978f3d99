"""Claim: a run that ends at a limit point says so, with control parameter, load and mode; one that fails otherwise not.

Sources: the path that arc length finds on the same mesh (tests/verification/test_fe_arc_length.py holds it against a
published one); Euler's load of a column. Tolerances: 0.1 % of the limit load, which is extrapolated from two states
within 0.2 % of it; 0.01 % of a deflection or height that turns back. The load there goes as the root of what is left:
0.4 N of a roof that carried 145 N (0.1 and 0.3 N are found; the last states lie 2 and 5 N off), 0.25 % of the arch's
(0.15 %). 0.5 % for Euler's load, which leaves out shear and the column's shortening (0.2 % each).
Negative control: a solver that fails on the way at no limit.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

from contracts.errors import ConvergenceError, IncrementRecord, LimitLoad
from contracts.hub_travel import HubTravel, Way
from contracts.materials import Material
from reference_fe.contact.obstacle import ContactMethod
from reference_fe.problem.balance import support_forces
from reference_fe.problem.domain import Domain
from reference_fe.problem.static_problem import StaticProblem
from reference_fe.problem.supports import Support, Traction
from reference_fe.solver.arc_length import ArcLength, follow_path
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.limit_point import limit_point
from reference_fe.solver.newton import NewtonOutcome, NewtonSettings, NewtonSolver
from reference_fe.verification.hinged_roof import hinged_roof, roof_path
from reference_fe.verification.load_path import limit_loads
from reference_fe.verification.padded_arch import padded_arch
from reference_fe.verification.structured_hexahedra import block_mesh

TWENTIETHS = [0.05 * k for k in range(1, 21)]
HEIGHTS = [0.5e-3 * k for k in range(1, 25)]
FAR_OFF = HubTravel.along(way=Way.FORE_AFT, start=1.0, steps=(1.0,))
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
    assert limit.load == pytest.approx(750.0 * limit.control, rel=1e-6)
    assert not limit.branch
    assert limit.part == "body"
    assert limit.place[0] == 0.0
    assert "limit load: the driven load ends at control 0.1936" in str(error)
    assert "finer mesh or smaller increments do not help" in str(error)


@pytest.mark.parametrize(("iterations", "parts"), [(6, 20), (20, 5)])
def test_a_driven_displacement_ends_where_it_would_have_to_go_back(iterations: int, parts: int) -> None:
    """Deflection and load of the fold, whatever the increments; the load falls ever faster there, by 138 N before."""
    control, load = moved_roofs_fold()
    solver = NewtonSolver(hinged_roof((4, 4), drop=30.0), NewtonSettings(maximum_iterations=iterations))
    error = ended(solver, [k / parts for k in range(1, parts + 1)])
    assert limit_of(error).control == pytest.approx(control, rel=1e-4)
    assert limit_of(error).load == pytest.approx(load, abs=0.4)
    assert "the displacement turns back there: snap-back" in str(error)


@functools.cache
def moved_roofs_fold() -> tuple[float, float]:
    problem = hinged_roof((4, 4), drop=30.0)
    solver = NewtonSolver(problem, NewtonSettings())
    return fold(
        (state.control, -support_forces(problem, state.outcome.residual)["centre"][2])
        for state in follow_path(solver, ArcLength(first=0.02, longest=1.0), [], target=1.0)
    )


def fold(path: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Where the control parameter first turns back, and the load there: top of a parabola, by the load."""
    points = list[tuple[float, float]]()
    for point in path:
        points.append(point)
        if len(points) > 2 and points[-1][0] < points[-2][0]:
            break
    (_, load), middle = points[-2], np.array(points[-3:])
    square, slope, top = np.polyfit(middle[:, 1] - load, middle[:, 0], 2)
    return top - slope**2 / (4.0 * square), load - slope / (2.0 * square)


def test_a_pressed_arch_ends_at_the_height_that_snaps_back_and_is_followed_there() -> None:
    """Height driven, told; and with ``past_limits`` followed until the arch leaves the ground."""
    error = ended(NewtonSolver(padded_arch(), FEW), HEIGHTS)
    limit = limit_of(error)
    solver = NewtonSolver(padded_arch(), NewtonSettings())
    list(solve_increments(solver, HEIGHTS[:16], []))
    arcs = follow_path(solver, ArcLength(first=HEIGHTS[0] / 4.0, longest=1.0), [], start=HEIGHTS[15])
    height_there, load_there = fold((state.control, -state.contact_force[2]) for state in arcs)
    assert limit.control == pytest.approx(height_there, rel=1e-4)
    assert limit.load == pytest.approx(load_there, rel=2.5e-3)
    assert limit.part == "body"
    assert limit.place[0] < 5e-3, "the crown"
    assert "driven height of the ground" in str(error)
    found = list[tuple[float, float]]()
    run = solve_increments(NewtonSolver(padded_arch(), FEW), HEIGHTS, [], past_limits=True)
    with pytest.raises(ConvergenceError, match="the body leaves the obstacle"):
        found.extend((state.control, -state.contact_force[2]) for state in run)
    height, load = np.array(found).T
    turn = int(np.argmax(height))
    assert np.all(np.diff(height[turn:]) < 0.0)
    assert np.all(np.diff(load[turn:]) < 0.0)
    assert load[-1] < 1e-3 * load.max()
    assert height[-1] < 0.7 * height[turn]


@pytest.mark.parametrize("how", [{"travel": FAR_OFF}, {"method": ContactMethod.AUGMENTED_LAGRANGIAN}])
def test_no_limit_is_told_of_an_obstacle_that_travels_or_of_multipliers(how: dict[str, Any]) -> None:
    """The run ends as one that does not converge, with its history."""
    error = ended(NewtonSolver(padded_arch(**how), FEW), HEIGHTS)
    assert error.limit is None
    assert error.history


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


def test_no_limit_is_told_where_nothing_moved() -> None:
    solver = NewtonSolver(hinged_roof((2, 2)), NewtonSettings())
    assert limit_point(solver, (0.0, solver.problem.state()), (0.1, solver.problem.state()), 0.1) is None


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
