"""The increment driver on a scripted solver: cut-back, growth, records, failure."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contracts.errors import ConvergenceError, IncrementRecord, InputError, MemoryLimitError
from reference_fe.solver.increments import solve_increments
from reference_fe.solver.newton import NewtonOutcome


class ScriptedSolver:
    """Converges when the step is at most ``limit``; the state is the control parameter itself."""

    def __init__(self, limit: float) -> None:
        self.limit, self.control = limit, 0.0
        self.u = SimpleNamespace(x=SimpleNamespace(array=np.zeros(1)))
        self.problem: Any = self
        self.contact = None
        self.surfaces = SimpleNamespace(terms=())
        self.histories = SimpleNamespace(remembered=False)

    def accept(self) -> None:
        """Nothing to commit."""

    def state(self) -> np.ndarray:
        return self.u.x.array.copy()

    def restore(self, state: np.ndarray) -> None:
        self.u.x.array[:] = state

    def set_control(self, control: float) -> None:
        self.control = control

    def solve(self, rise: float = 0.0) -> NewtonOutcome:
        converged = self.control - self.u.x.array[0] <= self.limit * (1 + 1e-12)
        self.u.x.array[0] = self.control if converged else 1e9
        return NewtonOutcome(converged=converged, residuals=(1.0, 0.0), residual=np.zeros(1))

    def contact_force(self) -> np.ndarray:
        return np.zeros(3)

    def reaction(self, residual: np.ndarray) -> np.ndarray:
        return np.zeros(3)


def drive(limit: float, targets: list[float]) -> tuple[list[float], list[bool], list[IncrementRecord]]:
    history: list[IncrementRecord] = []
    solver: Any = ScriptedSolver(limit)
    states = list(solve_increments(solver, targets, history))
    return [s.control for s in states], [s.wanted for s in states], history


def test_targets_are_hit_exactly() -> None:
    controls, wanted, history = drive(10.0, [1.0, 2.5, 4.0])
    assert controls == [1.0, 2.5, 4.0]
    assert all(wanted)
    assert all(record.converged for record in history)


def test_a_failed_increment_is_halved_from_the_last_good_state() -> None:
    controls, wanted, history = drive(0.3, [1.0])
    assert controls[-1] == 1.0
    assert max(np.diff([0.0, *controls])) <= 0.3 * (1 + 1e-9)
    assert wanted == [False] * (len(controls) - 1) + [True]
    assert [record.converged for record in history[:3]] == [False, False, True]
    assert history[2].step == pytest.approx(0.25)


def test_a_hopeless_problem_raises_with_its_history() -> None:
    history: list[IncrementRecord] = []
    solver: Any = ScriptedSolver(0.0)
    with pytest.raises(ConvergenceError, match="does not converge") as caught:
        list(solve_increments(solver, [1.0], history))
    assert len(caught.value.history) == len(history) > 5


def test_a_singular_matrix_is_cut_back_and_then_told() -> None:
    class Singular(ScriptedSolver):
        def solve(self, rise: float = 0.0) -> NewtonOutcome:
            failure = "the stiffness matrix is singular"
            return NewtonOutcome(converged=False, residuals=(1.0, float("inf")), residual=np.zeros(1), failure=failure)

    history: list[IncrementRecord] = []
    solver: Any = Singular(0.0)
    with pytest.raises(ConvergenceError, match=r"the stiffness matrix is singular; last converged at 0.* look for"):
        list(solve_increments(solver, [1.0], history))
    assert len(history) == 11


def test_a_lack_of_memory_is_not_cut_back() -> None:
    class Large(ScriptedSolver):
        attempts = 0

        def solve(self, rise: float = 0.0) -> NewtonOutcome:
            self.attempts += 1
            raise MemoryLimitError("the factors need 31 GB", "choose larger elements")

    solver: Any = Large(0.0)
    with pytest.raises(MemoryLimitError, match="31 GB"):
        list(solve_increments(solver, [1.0], []))
    assert solver.attempts == 1


def test_a_residual_at_round_off_is_not_cut_back() -> None:
    """Halving cannot lower round-off: one attempt, then the message says which tolerance can be met."""
    solver: Any = ScriptedSolver(0.0)
    stalled = NewtonOutcome(converged=False, residuals=(1.0, 2e-8, 2e-8), residual=np.zeros(1), stalled=True)
    solver.solve = lambda rise=0.0: stalled
    history: list[IncrementRecord] = []
    with pytest.raises(ConvergenceError, match=r"stalls at a relative residual.*tolerance to"):
        list(solve_increments(solver, [1.0], history))
    assert len(history) == 1


@pytest.mark.parametrize("targets", [[], [2.0, 1.0], [0.0, 1.0], [1.0, float("nan")]])
def test_bad_targets_are_refused(targets: list[float]) -> None:
    with pytest.raises(InputError):
        drive(1.0, targets)


def test_a_path_may_turn_back_at_what_was_found() -> None:
    """Targets as a function of what is reached, that ends with None."""
    turned = False

    def there_and_back(reached: float) -> float | None:
        nonlocal turned
        turned = turned or reached == 1.5
        if not turned:
            return 1.0 if reached < 1.0 else 1.5
        return -0.5 if reached > -0.5 else None

    class Both(ScriptedSolver):
        def solve(self, rise: float = 0.0) -> NewtonOutcome:
            converged = abs(self.control - self.u.x.array[0]) <= self.limit
            self.u.x.array[0] = self.control if converged else 1e9
            return NewtonOutcome(converged=converged, residuals=(1.0, 0.0), residual=np.zeros(1))

    solver: Any = Both(0.7)
    history: list[IncrementRecord] = []
    states = list(solve_increments(solver, there_and_back, history))
    controls = [state.control for state in states]
    assert controls[-1] == -0.5
    assert max(controls) == 1.5
    assert [state.control for state in states if state.wanted] == [1.0, 1.5, -0.5]
    assert any(record.step < 0.0 and not record.converged for record in history)  # cut back on the way back
    assert controls.index(1.5) == len([record for record in history if record.converged and record.step > 0.0]) - 1
