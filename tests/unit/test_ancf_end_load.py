"""End loads of the cantilever benchmarks: the moment is a couple, and its derivative is that of finite differences."""

from __future__ import annotations

import numpy as np
import pytest

from ancf_reduced.plates.mesh import build_plate_mesh
from ancf_reduced.plates.model import PlateModel, build_plate_model
from ancf_reduced.verification.cantilever import MOMENT, end_load
from ancf_reduced.verification.plate_strips import strip
from tests.plate_derivatives import crumpled


@pytest.fixture(scope="module")
def model() -> PlateModel:
    patches = strip(np.zeros(3), np.array([12.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), 0.1, 2)
    return build_plate_model(build_plate_mesh(patches), young_modulus=1.0, poisson_ratio=0.0, density=1.0)


def test_work_of_the_moment_is_that_of_a_rotation(model: PlateModel) -> None:
    """Turning all directors by a small angle about the axis takes M times the angle, whatever their length."""
    p = crumpled(model) * 1.3
    turn = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    p[:, 3, 1] = 0.0
    force, _ = end_load(model, "moment", follows=True)(p, 0.5)
    rates = np.zeros_like(p)
    rates[:, 3] = p[:, 3] @ turn.T
    assert float((force * rates).sum()) == pytest.approx(0.5 * MOMENT, rel=1e-12)


@pytest.mark.parametrize("follows", [True, False])
def test_derivative_of_the_moment(model: PlateModel, follows: bool) -> None:
    load, p = end_load(model, "moment", follows), crumpled(model)
    step = 1e-5 * np.random.default_rng(3).normal(size=p.shape)
    difference = 0.5 * (load(p + step, 1.0)[0] - load(p - step, 1.0)[0]).ravel()
    slope = load(p, 1.0)[1] @ step.ravel()
    np.testing.assert_allclose(slope, difference, rtol=0.0, atol=1e-8 * MOMENT * np.abs(step).max())
    assert np.abs(slope).max() > 0.0 if follows else not slope.any()
