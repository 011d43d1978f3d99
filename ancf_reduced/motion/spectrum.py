"""Small vibrations about a state: natural frequencies, and the longest stable explicit step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csc_array, kron
from scipy.sparse.linalg import LinearOperator, eigsh

from ancf_reduced.motion.mass_factor import MassFactor
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.plates.assembly import sparse_matrix
from contracts.errors import ConvergenceError

__all__ = ["natural_frequencies", "stable_step", "stiffness_matrix"]

FloatArray = NDArray[np.float64]
_DENSE = 600
"""Up to so many coordinates all eigenvalues are computed; above, the wanted ones by Lanczos iterations."""


def stiffness_matrix(system: PlateSystem, z: FloatArray) -> csc_array:
    """Elastic tangent in the independent coordinates, (3 n_vectors, 3 n_vectors) sparse; row 3 k + i."""
    blocks = system.model.elastic_tangents(system.coordinates.expand(z))
    B = kron(system.coordinates.map, np.eye(3), format="csr")
    return csc_array(B.T @ sparse_matrix(system.model.mesh, blocks) @ B)


def natural_frequencies(system: PlateSystem, z: FloatArray, count: int | None = None) -> FloatArray:
    """The lowest natural frequencies about z, ascending [Hz]; all of them where ``count`` is None.

    Rigid motions have zero; triads are taken as deformable, so that a hub adds frequencies of its own if it is free.
    External forces and damping are left out.

    Verified by tests/verification/test_ancf_frequencies.py.
    """
    K = stiffness_matrix(system, z)
    M = csc_array(kron(system.mass, np.eye(3)))
    try:
        if count is None or K.shape[0] <= _DENSE:
            squares = eigh(K.toarray(), M.toarray(), eigvals_only=True, check_finite=False)
        else:
            shift = -1e-6 * K.diagonal().max() / M.diagonal().max()
            squares = np.sort(eigsh(K, k=count, M=M, sigma=shift, v0=_start(K.shape[0]), return_eigenvectors=False))
    except (np.linalg.LinAlgError, RuntimeError) as error:  # the latter: SuperLU's, ARPACK's
        raise ConvergenceError(f"natural frequencies are not found: {error}; look at mass and shape", []) from error
    if not np.isfinite(squares).all():
        raise ConvergenceError("natural frequencies are not found: the stiffness is no finite number", [])
    found = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
    return np.asarray(found if count is None else found[:count])


def stable_step(system: PlateSystem, z: FloatArray, safety: float = 0.8) -> float:
    """Longest step of `motion.explicit` for elastic and damping forces about z [s]: safety times 2 / omega_max.

    omega_max is the highest circular frequency; damping, taken at the end of each step, does not shorten the step.
    External forces are left out: contact is soft against the plates, but friction is a damper mu N / v_0 below its slip
    velocity and asks for shorter steps where that is small.

    Verified by tests/unit/test_ancf_rigid_hub.py and tests/verification/test_ancf_wheel_rig.py.
    """
    return float(safety * 2.0 / np.sqrt(_largest(system, stiffness_matrix(system, z))))


def _largest(system: PlateSystem, matrix: csc_array) -> float:
    """Largest eigenvalue of a matrix relative to the mass; on large systems to 1 %, upwards."""
    n = matrix.shape[0]
    if n <= _DENSE:
        M = csc_array(kron(system.mass, np.eye(3))).toarray()
        top = (n - 1, n - 1)
        return float(eigh(matrix.toarray(), M, eigvals_only=True, subset_by_index=top, check_finite=False)[0])
    factor = MassFactor(system.mass)

    def product(x: FloatArray) -> FloatArray:
        moved = factor.from_cholesky(x.reshape(-1, 3)).ravel()
        return factor.force_to_cholesky((matrix @ moved).reshape(-1, 3)).ravel()

    operator = LinearOperator((n, n), matvec=product, dtype=np.float64)
    return float(1.02 * eigsh(operator, k=1, which="LM", tol=1e-2, v0=_start(n), return_eigenvectors=False)[0])


def _start(n: int) -> FloatArray:
    """First vector of the Lanczos iterations: any without symmetry, the same in every run."""
    return np.random.default_rng(0).normal(size=n)
