"""The equations of rigid reference nodes, g = (a_i . a_j - delta_ij) / 2 = 0, with their derivatives.

For integrators that solve them together with the motion; `rigid_triads` has the other way. A gradient that is held has
its reference value e_i, and the equation of two held ones is left out.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ancf_reduced.motion.vector_coordinates import VectorCoordinates

__all__ = ["TriadEquations"]

FloatArray = NDArray[np.float64]

_PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


class TriadEquations:
    """Equations of all triads.

    Verified by tests/unit/test_ancf_implicit_dynamics.py.
    """

    def __init__(self, coordinates: VectorCoordinates) -> None:
        self._n_vectors = coordinates.n_vectors
        pairs = [(t[1:], i, j) for t in coordinates.triads for i, j in _PAIRS if t[1 + i] >= 0 or t[1 + j] >= 0]
        self._axes = np.array([(i, j) for _, i, j in pairs], dtype=np.int64).reshape(-1, 2)
        self._rows = np.array([(rows[i], rows[j]) for rows, i, j in pairs], dtype=np.int64).reshape(-1, 2)

    def _vectors(self, z: FloatArray, held: FloatArray) -> FloatArray:
        """a_i and a_j of each equation, (n, 2, 3)."""
        return np.where(self._rows[..., None] >= 0, z[self._rows], held[self._axes])

    def defect(self, z: FloatArray) -> FloatArray:
        """g, (n,) [-]."""
        a = self._vectors(z, np.eye(3))
        return np.asarray(0.5 * (np.sum(a[:, 0] * a[:, 1], axis=-1) - (self._axes[:, 0] == self._axes[:, 1])))

    def jacobian(self, z: FloatArray) -> FloatArray:
        """G = dg/dz, (n, 3 n_vectors)."""
        return self._jacobian(self._vectors(z, np.eye(3)))

    def jacobian_rate(self, v: FloatArray) -> FloatArray:
        """dG/dt at rates v, (n, 3 n_vectors)."""
        return self._jacobian(self._vectors(v, np.zeros((3, 3))))

    def stiffness(self, multipliers: FloatArray) -> FloatArray:
        """Derivative of G^T lambda by z for each direction, (n_vectors, n_vectors)."""
        matrix = np.zeros((self._n_vectors, self._n_vectors))
        both = (self._rows >= 0).all(axis=1)
        i, j = self._rows[both].T
        np.add.at(matrix, (i, j), 0.5 * multipliers[both])
        np.add.at(matrix, (j, i), 0.5 * multipliers[both])
        return matrix

    def _jacobian(self, vectors: FloatArray) -> FloatArray:
        n = len(self._rows)
        G = np.zeros((n, self._n_vectors, 3))
        for side in (0, 1):
            free = self._rows[:, side] >= 0
            np.add.at(G, (np.arange(n)[free], self._rows[free, side]), 0.5 * vectors[free, 1 - side])
        return G.reshape(n, 3 * self._n_vectors)
