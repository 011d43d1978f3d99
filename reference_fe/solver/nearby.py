"""Solves linear systems whose matrices differ in few rows from one that is factorised."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference_fe.solver import process_sums

__all__ = ["NearbySolver"]

DEPENDENT = 1e-10
"""Part of an image outside the span of the others, relative to |image| and |w_j| = 1, below which it is round-off."""

type Array = NDArray[np.float64]


class NearbySolver:
    """Solves (K + D) x = b for one K with factors and several D of low rank, by generalised conjugate residuals.

    Each search direction z_j comes from a solve with K, K z_j = w_j, so that its image under K + D needs D alone,

        (K + D) z_j = w_j + D z_j.

    The images are made orthonormal and the residual is minimised over them (Eisenstat, Elman & Schultz, SIAM J. Numer.
    Anal. 20, 1983). Directions serve every later D and b as well, and only where they do not suffice the residual left
    over becomes the next w: all systems together need about as many solves with K as the D have different rows.
    Neither symmetric nor definite matrices are asked for.

    Parameters
    ----------
    solve : K^-1 times a vector, (n_own,) each
    capacity : most search directions that are kept [-]

    Verified by tests/unit/test_fe_nearby_solver.py.
    """

    def __init__(self, solve: Callable[[Array], Array], capacity: int) -> None:
        self._solve, self._capacity = solve, capacity
        self._w, self._z = list[Array](), list[Array]()

    @property
    def full(self) -> bool:
        """Whether no search direction can be added."""
        return len(self._w) >= self._capacity

    def solve(self, b: Array, change: Callable[[Array], Array], tolerance: float) -> tuple[Array, Array]:
        """Solution x of (K + D) x = b, and the residual b - (K + D) x that is left.

        Parameters
        ----------
        b : (n_own,) right-hand side
        change : D times a vector
        tolerance : norm at which the residual is small enough; once the solver is full, more may be left
        """
        x, left = np.zeros_like(b), b.copy()
        images, directions = list[Array](), list[Array]()
        for j in range(self._capacity):
            size = process_sums.global_norm(left)
            if size <= tolerance:
                break
            if j == len(self._w):
                self._w.append(left / size)
                self._z.append(self._solve(self._w[j]))
            z = self._z[j].copy()
            image = self._w[j] + change(z)
            whole = max(1.0, process_sums.global_norm(image))
            for other, direction in zip(images, directions, strict=True):
                share = process_sums.global_dot(other, image)
                image -= share * other
                z -= share * direction
            length = process_sums.global_norm(image)
            if length <= DEPENDENT * whole:
                if j + 1 < len(self._w):
                    continue
                break  # nor would the next direction help: K + D is singular
            image, z = image / length, z / length
            share = process_sums.global_dot(image, left)
            x += share * z
            left -= share * image
            images.append(image)
            directions.append(z)
        return x, left
