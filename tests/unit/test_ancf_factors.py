"""A matrix without an inverse is one error, full or sparse, and ends a Newton iteration with its reason."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csc_array

from ancf_reduced.motion.equilibrium import NewtonControls, newton_solve
from ancf_reduced.motion.factors import factorised
from ancf_reduced.motion.mass_factor import MassFactor
from contracts.errors import InputError
from rover_dynamics.flexible.linear_solves import _factors

FORMS: list[Callable[[Any], Any]] = [np.asarray, csc_array]
SINGULAR = np.array([[1.0, 2.0], [2.0, 4.0]])


@pytest.mark.parametrize("form", FORMS)
def test_solves(form: Callable[[Any], Any]) -> None:
    solve = factorised(form(np.array([[2.0, 1.0], [1.0, 3.0]])))
    np.testing.assert_allclose(solve(np.array([3.0, 4.0])), 1.0)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("matrix", [SINGULAR, np.zeros((2, 2)), np.diag([1.0, np.nan]), np.diag([1.0, 1e-320])])
def test_a_matrix_without_an_inverse_is_one_error(form: Callable[[Any], Any], matrix: np.ndarray) -> None:
    with pytest.raises(np.linalg.LinAlgError):
        factorised(form(matrix))(np.ones(2))


def test_a_singular_tangent_ends_newton_with_its_reason() -> None:
    """Given as infinities instead of an error, as sparse solvers do: the residual is never asked there."""
    seen = list[bool]()

    def system(x: np.ndarray) -> tuple[np.ndarray, float]:
        seen.append(bool(np.isfinite(x).all()))
        return x - 1.0, 1.0

    for solve in (np.linalg.solve, lambda matrix, right: np.full(2, np.inf)):
        result = newton_solve(system, lambda x: SINGULAR * 0.0, np.zeros(2), NewtonControls(), solve)
        assert not result.converged
        assert "singular" in result.reason
    assert all(seen)


def test_a_singular_mass_is_bad_input() -> None:
    with pytest.raises(InputError, match="positive definite"):
        MassFactor(csc_array(np.array([[1.0, 1.0], [1.0, 1.0]])))
    with pytest.raises(InputError, match="positive definite"):
        MassFactor(csc_array(np.diag([1.0, 0.0])))


def test_a_singular_tire_is_the_error_that_shortens_the_step() -> None:
    with pytest.raises(np.linalg.LinAlgError, match="singular"):
        _factors(csc_array(np.diag([1.0, 0.0])))
