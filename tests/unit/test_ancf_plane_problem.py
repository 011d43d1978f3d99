"""Residual and tangent of a tire against a plane."""

from __future__ import annotations

import numpy as np

from ancf_reduced.motion.equilibrium import NewtonControls
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.plane_problem import PlaneProblem
from ancf_reduced.tire.preset import thesis_preset
from contracts.frames import ground_direction_h

PROBLEM = PlaneProblem(tire=build_tire(thesis_preset()), direction=ground_direction_h(0.2))
X0 = PROBLEM.tire.mesh.reference_coordinates()[PROBLEM.tire.tie.free].ravel()


def test_tangent_is_the_derivative_of_the_residual() -> None:
    rng = np.random.default_rng(13)
    x = X0 + 0.01 * rng.normal(size=X0.shape)
    step = 1e-7 * rng.normal(size=X0.shape)
    gap = 0.1325 - PROBLEM.tire.grid.positions(PROBLEM.expand(x)) @ PROBLEM.direction
    assert np.abs(gap).min() > 1e-6  # no point switches
    difference = (PROBLEM.residual(x + step, 0.01)[0] - PROBLEM.residual(x - step, 0.01)[0]) / 2
    expected = PROBLEM.tangent(x, 0.01) @ step
    np.testing.assert_allclose(difference, expected, rtol=0, atol=1e-6 * np.abs(expected).max())


def test_unloaded_tire_is_in_equilibrium() -> None:
    residual, scale = PROBLEM.residual(X0, -0.01)
    assert np.abs(residual).max() < 1e-10 * scale


def test_inverted_plates_are_refused() -> None:
    mirrored = X0.reshape(-1, 4, 3).copy()
    mirrored[:, 3, 2] = -1.0  # r_Z turned over at the free nodes: residual is not asked about by a huge tolerance
    result = PROBLEM.solve(0.0, mirrored.ravel(), NewtonControls(tolerance=1e12))
    assert not result.converged
    assert "inverted" in result.reason
