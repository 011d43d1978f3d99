"""Newton and the path with cut-back, on small systems with known answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from ancf_reduced.motion.equilibrium import NewtonControls, NewtonResult, follow_path, newton_solve
from contracts.errors import ConvergenceError, IncrementRecord, InputError

CONTROLS = NewtonControls()


def _cube_root(c: float, start: float, controls: NewtonControls = CONTROLS) -> NewtonResult:
    return newton_solve(lambda x: (x**3 - c, abs(c)), lambda x: 3.0 * np.diag(x**2), np.array([start]), controls)


def test_newton_converges_quadratically() -> None:
    result = _cube_root(8.0, 3.0)
    assert result.converged
    assert result.x[0] == pytest.approx(2.0, abs=1e-10)
    errors = np.array(result.residuals[1:-1])
    orders = np.log(errors[2:] / errors[1:-1]) / np.log(errors[1:-1] / errors[:-2])
    assert orders[-1] == pytest.approx(2.0, abs=0.2)


def test_sparse_tangent_gives_the_same_iterates() -> None:
    cubes = np.array([8.0, 27.0])
    full = newton_solve(lambda x: (x**3 - cubes, 1.0), lambda x: 3.0 * np.diag(x**2), np.ones(2), CONTROLS)
    sparse = newton_solve(
        lambda x: (x**3 - cubes, 1.0), lambda x: csc_array(3.0 * np.diag(x**2)), np.ones(2), CONTROLS, solve=spsolve
    )
    assert sparse.converged
    assert sparse.residuals == pytest.approx(full.residuals, abs=1e-12)


def test_singular_tangent_overflow_and_iteration_limit_are_not_converged() -> None:
    assert not _cube_root(8.0, 0.0).converged
    assert not _cube_root(8.0, np.nan).converged
    limited = _cube_root(8.0, 30.0, NewtonControls(max_iterations=2))
    assert not limited.converged
    assert limited.iterations == 2


def test_path_halves_increments_that_fail() -> None:
    controls, history = NewtonControls(max_iterations=3), list[IncrementRecord]()
    path = follow_path(lambda c, x: _cube_root(c, x[0], controls), (1.0, np.ones(1)), [27.0, 64.0], controls, history)
    points = list(path)
    assert [p.target for p in points] == [27.0, 64.0]
    assert [p.x[0] for p in points] == pytest.approx([3.0, 4.0], rel=1e-8)
    assert any(not record.converged for record in history)
    assert points[0].iterations + points[1].iterations == sum(len(r.residuals) - 1 for r in history)


def test_path_that_cannot_go_on_says_where_it_stopped() -> None:
    def refuse_beyond_two(c: float, x: np.ndarray) -> NewtonResult:
        return NewtonResult(x=x, residuals=(0.0,), converged=c <= 2.0, reason="refused")

    history = list[IncrementRecord]()
    path = follow_path(refuse_beyond_two, (0.0, np.zeros(1)), [1.0, 3.0], CONTROLS, history)
    with pytest.raises(ConvergenceError, match=r"refused.*last good at 2") as caught:
        list(path)
    assert caught.value.history[-1].step <= 2.0 * CONTROLS.smallest_step
    assert len(caught.value.history) == len(history)


@pytest.mark.parametrize("name", ["tolerance", "max_iterations", "smallest_step"])
def test_controls_must_be_above_zero(name: str) -> None:
    with pytest.raises(InputError, match=name):
        NewtonControls(**{name: 0})
