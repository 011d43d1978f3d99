"""Tangent stiffness and damping of a system of plates in its independent coordinates, full or sparse by size.

Row 3 k + i is component i of independent vector k. Verified by tests/unit/test_ancf_implicit_dynamics.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_array, csc_array, eye_array, kron

from ancf_reduced.motion.factors import factorised
from ancf_reduced.motion.plate_system import PlateSystem
from ancf_reduced.plates.assembly import dense_matrix, sparse_matrix

__all__ = ["Linearisation", "Matrix", "constrained"]

FloatArray = NDArray[np.float64]
type Matrix = FloatArray | csc_array
"""Full for small systems, sparse for large ones."""

_SMALL = 250
"""Up to so many vectors matrices are full."""


def constrained(matrix: Matrix, G: FloatArray) -> Matrix:
    """[matrix G^T; G 0] with the constraints' Jacobian G (m, 3 n)."""
    m = len(G)
    if isinstance(matrix, np.ndarray):
        return np.block([[matrix, G.T], [G, np.zeros((m, m))]])
    if not m:
        return matrix
    below = csc_array(G)
    blocks: list[list[csc_array | None]] = [[matrix, csc_array(below.T)], [below, None]]
    return csc_array(block_array(blocks))


class Linearisation:
    """Matrices of one system, and solves with them.

    Attributes
    ----------
    mass : (3 n, 3 n) matrix of the inertia
    is_small : whether matrices are full
    """

    def __init__(self, system: PlateSystem) -> None:
        self.system, self.is_small = system, system.coordinates.n_vectors <= _SMALL
        self._map = system.coordinates.map.toarray() if self.is_small else kron(system.coordinates.map, eye_array(3))
        mass = kron(system.mass, eye_array(3))
        self.mass: Matrix = mass.toarray() if self.is_small else csc_array(mass)

    def elastic(self, z: FloatArray) -> Matrix:
        """Derivative of the elastic force by z (n_vectors, 3): (3 n, 3 n) [N/m, N, N m]."""
        return self._reduced(self.system.model.elastic_tangents(self.system.coordinates.expand(z)))

    def damping(self, z: FloatArray, v: FloatArray, time: float = 0.0) -> Matrix:
        """Minus the derivative of `PlateSystem.force` by v (n_vectors, 3): (3 n, 3 n) [N s/m, N s, N m s]."""
        system = self.system
        p, p_dot = system.coordinates.expand(z), system.coordinates.expand_rates(v)
        blocks = np.zeros((len(system.model.mesh.elements), 48, 48))
        if system.is_damped:
            blocks += system.model.damping_matrices(p)
        for external in system.external:
            if external.depends_on_rates:
                blocks += external.tangents(p, p_dot, time)[1]
        return self._reduced(blocks)

    def stiffness_and_damping(self, z: FloatArray, v: FloatArray, time: float) -> tuple[Matrix, Matrix]:
        """Minus the derivatives of `PlateSystem.force` by z and by v, (3 n, 3 n) each [as `elastic`, `damping`]."""
        system = self.system
        p, p_dot = system.coordinates.expand(z), system.coordinates.expand_rates(v)
        stiffness, damping = system.model.elastic_tangents(p), np.zeros((len(system.model.mesh.elements), 48, 48))
        if system.is_damped:
            by_position, by_rate = system.model.damping_tangents(p, p_dot)
            stiffness += by_position
            damping += by_rate
        for external in system.external:
            by_position, by_rate = external.tangents(p, p_dot, time)
            stiffness += by_position
            damping += by_rate
        return self._reduced(stiffness), self._reduced(damping)

    def solve(self, matrix: Matrix, constraints: FloatArray, right: FloatArray) -> FloatArray:
        """Solution of [matrix G^T; G 0] x = right with the constraints' Jacobian G (m, 3 n); LinAlgError if none."""
        return factorised(constrained(matrix, constraints))(right)

    def like_mass(self, matrix: FloatArray) -> Matrix:
        """A matrix (n, n) that is the same for each direction, as (3 n, 3 n)."""
        if self.is_small:
            return np.asarray(np.kron(matrix, np.eye(3)), dtype=np.float64)
        return csc_array(kron(csc_array(matrix), eye_array(3)))

    def _reduced(self, blocks: FloatArray) -> Matrix:
        mesh = self.system.model.mesh
        if not self.is_small:
            return csc_array(self._map.T @ sparse_matrix(mesh, blocks) @ self._map)
        B, n = self._map, self.system.coordinates.n_vectors
        rows = 4 * len(mesh.points)
        half = B.T @ dense_matrix(mesh, blocks).reshape(rows, -1)  # (n, 3 rows 3)
        halves = half.reshape(n, 3, rows, 3).transpose(2, 0, 1, 3).reshape(rows, -1)
        whole = (B.T @ halves).reshape(n, n, 3, 3)  # [column vector, row vector, row component, column component]
        return np.ascontiguousarray(whole.transpose(1, 2, 0, 3).reshape(3 * n, 3 * n))
