"""Statistics of a least-squares fit against the closed form of a straight line."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import linregress

from ancf_reduced.fit.fit_statistics import fit_statistics

X = np.linspace(1.0, 3.0, 12)
Y = 2.0 * X - 1.0 + 0.1 * np.random.default_rng(4).standard_normal(12)
BOTH = np.array([True, True])


def test_a_straight_line() -> None:
    line = linregress(X, Y)
    J = np.column_stack([X, np.ones_like(X)])
    found = fit_statistics(J, line.slope * X + line.intercept - Y, np.array([line.slope, line.intercept]), BOTH)
    np.testing.assert_allclose(found.standard_error, [line.stderr, line.intercept_stderr], rtol=1e-10)
    np.testing.assert_allclose(found.half_width, 2.228139 * found.standard_error, rtol=1e-6)  # t, 10 degrees of freedom
    assert found.correlation[0, 1] == pytest.approx(-X.mean() / np.sqrt((X**2).mean()))
    assert found.indistinguishable() == [(0, 1)]


def test_parameters_that_do_the_same_are_told() -> None:
    J = np.column_stack([X, 1.0000001 * X + 1e-7 * np.cos(9.0 * X)])
    found = fit_statistics(J, 0.1 * np.cos(5.0 * X), np.zeros(2), BOTH)
    assert found.condition > 1e5
    assert found.indistinguishable() == [(0, 1)]
    assert abs(found.weakest @ [1.0, -1.0]) == pytest.approx(np.sqrt(2.0), rel=1e-6)


def test_one_at_its_bound_has_no_interval() -> None:
    J = np.column_stack([X, np.ones_like(X)])
    found = fit_statistics(J, 0.1 * np.cos(5.0 * X), np.zeros(2), np.array([True, False]))
    assert np.isnan(found.half_width[1])
    assert np.isfinite(found.half_width[0])
    assert found.degrees_of_freedom == 11
    assert found.indistinguishable() == []
