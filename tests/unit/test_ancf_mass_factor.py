"""Cholesky factor of the mass and the coordinates in which it is the identity."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import block_diag, csc_array

from ancf_reduced.motion.mass_factor import MassFactor
from ancf_reduced.plates.assembly import sparse_matrix
from ancf_reduced.plates.mass import mass_blocks
from ancf_reduced.tire.mesh import build_tire
from ancf_reduced.tire.preset import thesis_preset
from contracts.errors import InputError

MODEL = build_tire(thesis_preset()).model
MASS = sparse_matrix(MODEL.mesh, mass_blocks(MODEL))


@pytest.mark.parametrize("wheels", [1, 8], ids=["one wheel, inverse kept", "eight wheels, factor only"])
def test_solves(wheels: int) -> None:
    mass = csc_array(block_diag([MASS] * wheels))
    factor, force = MassFactor(mass), np.random.default_rng(1).normal(size=(mass.shape[0], 3))
    np.testing.assert_allclose(mass @ factor.solve(force), force, atol=1e-10)


def test_cholesky_coordinates_have_unit_mass() -> None:
    factor, rng = MassFactor(MASS), np.random.default_rng(2)
    v, force = rng.normal(size=(2, MASS.shape[0], 3))
    bar = factor.to_cholesky(v)
    assert np.sum(bar**2) == pytest.approx(np.sum(v * (MASS @ v)), rel=1e-12)  # twice the kinetic energy
    np.testing.assert_allclose(factor.from_cholesky(bar), v, atol=1e-9)
    assert np.sum(factor.force_to_cholesky(force) * bar) == pytest.approx(np.sum(force * v), rel=1e-9)  # power
    np.testing.assert_allclose(  # acceleration: L^-T L^-1 Q = M^-1 Q
        factor.from_cholesky(factor.force_to_cholesky(force)), factor.solve(force), rtol=1e-7, atol=1e-6
    )


def test_factor_is_sparse_and_lower() -> None:
    """A strip of many plates: the factor has a few entries a row, not half of the matrix."""
    mass = csc_array(block_diag([MASS] * 8))
    factor = MassFactor(mass)
    assert factor.lower.nnz < 0.2 * mass.shape[0] ** 2 / 2
    assert (factor.lower.tocoo().row >= factor.lower.tocoo().col).all()
    reordered = mass[factor.order][:, factor.order]
    assert abs(factor.lower @ factor.lower.T - reordered).max() < 1e-12 * abs(mass).max()


def test_a_vector_without_mass_is_refused() -> None:
    with pytest.raises(InputError, match="positive definite"):
        MassFactor(csc_array(np.diag([1.0, -1e-3, 2.0])))
