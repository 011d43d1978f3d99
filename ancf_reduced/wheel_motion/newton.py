"""One step of Newton's method on the equations of a wheel with a hub, its contacts found within the step.

What is linearised and factored about a state serves other states near: the end of one time step the begin of the next.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from ancf_reduced.wheel.contact_step import settle
from ancf_reduced.wheel_motion.bordered import HUB, Bordered, BorderedMatrix
from ancf_reduced.wheel_motion.rolling import Linearised

__all__ = ["Factored"]

Array = NDArray[np.float64]
_HELD = 1e15
"""Stiffness against which a held coordinate does not move [N/m, N m]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Factored:
    """The equations about a state with their factors.

    Attributes
    ----------
    found : the equations
    touching : (m,) contacts near that are in the factors
    weights : of the derivatives by rates and by accelerations
    matrix : derivative by a step, without contact
    solve : its inverse, with contact
    """

    found: Linearised
    touching: NDArray[np.bool_]
    weights: tuple[float, float]
    matrix: BorderedMatrix
    solve: Bordered

    @classmethod
    def of(
        cls,
        found: Linearised,
        touching: NDArray[np.bool_],
        weights: tuple[float, float],
        held: tuple[int, ...] = (),
    ) -> Factored | None:
        """None where the matrix is singular; ``held``: coordinates of the hub (0 to 2) that stay where they are."""
        by_v, by_a = weights
        inner = csc_array(found.by_place[0] + by_v * found.by_rate[0] + by_a * found.by_acceleration[0])
        border = found.by_place[1] + by_v * found.by_rate[1] + by_a * found.by_acceleration[1]
        for k in held:
            border[k - HUB, k] += _HELD
        which = np.flatnonzero(touching)
        G, push = csr_array(found.slopes[which]), csr_array(found.push[which])
        heavy = csr_array(G * found.system.stiffness[which, None])
        with_contact = csc_array(inner + csr_array(push[:, :-HUB]).T @ csr_array(heavy[:, :-HUB]))
        full = border + (push.T @ heavy[:, -HUB:].toarray())
        rows = border[:-HUB].T + push[:, -HUB:].toarray().T @ csr_array(heavy[:, :-HUB])
        try:
            solve = Bordered((with_contact, full), rows)
        except (RuntimeError, np.linalg.LinAlgError):
            return None
        return cls(found=found, touching=touching, weights=weights, matrix=(inner, border), solve=solve)

    def step(self, away: tuple[Array, Array, Array] | None = None) -> tuple[Array, Array] | None:
        """Step (n_free + 3,) and forces (m,) of the contacts near; None where contact is unsettled.

        away : from where to step, places, rates and accelerations less those of the linearised state
        """
        found, system = self.found, self.found.system
        residual, gaps = found.residual, system.gaps
        if away is not None:
            parts = zip((found.by_place, found.by_rate, found.by_acceleration), away, strict=True)
            residual = residual + sum(product(matrix, x) for matrix, x in parts)
            gaps = gaps + found.slopes @ away[0]
        contact = gaps, found.slopes, system.stiffness
        return settle(self.solve, lambda x: product(self.matrix, x), residual, contact, self.touching, found.push)


def product(matrix: BorderedMatrix, x: Array) -> Array:
    """Of a symmetric matrix and a vector (n_free + 3,)."""
    inner, border = matrix
    plates = inner @ x[:-HUB] + border[:-HUB] @ x[-HUB:]
    return np.concatenate([plates, border[:-HUB].T @ x[:-HUB] + border[-HUB:] @ x[-HUB:]])
