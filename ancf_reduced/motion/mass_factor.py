"""Cholesky factor of the constant mass matrix, and the coordinates in which the mass is the identity.

M = L L^T; with z_bar = L^T z the kinetic energy is |z_bar'|^2 / 2 and a generalised force becomes Q_bar = L^-1 Q
(thesis section 2.5.3, Cholesky coordinates). L is sparse: SuperLU orders the unknowns first, so M = P^T L L^T P.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array, diags_array
from scipy.sparse.linalg import splu, spsolve_triangular

from contracts.errors import InputError

__all__ = ["MassFactor"]

FloatArray = NDArray[np.float64]

_DENSE = 400
"""Up to so many vectors the inverse is kept as a full matrix: one product is then quicker than two sparse solves."""


class MassFactor:
    """Solves with a constant mass matrix (n, n), symmetric and positive definite, the same for each direction.

    Attributes
    ----------
    lower : (n, n) sparse, L
    order : (n,) int, row k of L belongs to unknown order[k]

    Raises
    ------
    InputError
        If the matrix is not positive definite: a vector without mass.

    Verified by tests/unit/test_ancf_mass_factor.py.
    """

    def __init__(self, mass: csc_array) -> None:
        options = {"SymmetricMode": True, "Equil": False}
        rule, hint = "must be positive definite", "give every node some mass"
        try:
            self._solver = splu(mass.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        except RuntimeError as error:
            raise InputError("mass matrix", "singular", rule, hint) from error
        pivots = self._solver.U.diagonal()
        if not pivots.min() > 0.0 or not np.array_equal(self._solver.perm_r, self._solver.perm_c):
            raise InputError("mass matrix", f"smallest pivot {pivots.min():.3g}", rule, hint)
        self.lower = csr_array(self._solver.L @ diags_array(np.sqrt(pivots)))
        self.order = np.argsort(self._solver.perm_c)
        self._upper = csr_array(self.lower.T)
        small = mass.shape[0] <= _DENSE
        self._inverse = self._solver.solve(np.eye(mass.shape[0])) if small else None

    def solve(self, force: FloatArray) -> FloatArray:
        """M^-1 force, (n,) or (n, m)."""
        if self._inverse is not None:
            return np.asarray(self._inverse @ force)
        return np.asarray(self._solver.solve(np.ascontiguousarray(force)))

    def to_cholesky(self, z: FloatArray) -> FloatArray:
        """Cholesky coordinates z_bar = L^T z of vectors (n, 3); their rates likewise."""
        return np.asarray(self._upper @ z[self.order])

    def from_cholesky(self, z_bar: FloatArray) -> FloatArray:
        """Vectors (n, 3) [m, -] from z_bar (n, 3) [kg^1/2 m], the inverse of `to_cholesky`; rates likewise."""
        z = np.empty_like(z_bar)
        z[self.order] = spsolve_triangular(self._upper, z_bar, lower=False)
        return z

    def force_to_cholesky(self, force: FloatArray) -> FloatArray:
        """Q_bar = L^-1 Q of generalised forces (n, 3)."""
        return np.asarray(spsolve_triangular(self.lower, force[self.order], lower=True))
