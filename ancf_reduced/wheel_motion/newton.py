"""One step of Newton's method on the equations of a wheel with a hub, its contacts found within the step.

Verified by tests/verification/test_ancf_rolling.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from ancf_reduced.wheel.contact_step import settle
from ancf_reduced.wheel_motion.bordered import HUB, Bordered
from ancf_reduced.wheel_motion.rolling import Linearised

__all__ = ["newton_step"]

Array = NDArray[np.float64]
_HELD = 1e15
"""Stiffness against which a held coordinate does not move [N/m, N m]."""


def newton_step(
    found: Linearised, touching: NDArray[np.bool_], weights: tuple[float, float], held: tuple[int, ...] = ()
) -> tuple[Array, Array] | None:
    """Step (n_free + 3,) and forces (m,) of the contacts near; None where the matrix is singular or contact unsettled.

    Parameters
    ----------
    found : the equations about a state
    touching : (m,) contacts of the first guess
    weights : of the derivatives by rates and by accelerations
    held : coordinates of the hub (0 to 2) that stay where they are
    """
    by_v, by_a = weights
    inner = csc_array(found.by_place[0] + by_v * found.by_rate[0] + by_a * found.by_acceleration[0])
    border = found.by_place[1] + by_v * found.by_rate[1] + by_a * found.by_acceleration[1]
    for k in held:
        border[k - HUB, k] += _HELD
    system = found.system
    which = np.flatnonzero(touching)
    G = csr_array(found.slopes[which])
    heavy = csr_array(G * system.stiffness[which, None])
    own = csr_array(G[:, :-HUB])
    with_contact = csc_array(inner + own.T @ csr_array(heavy[:, :-HUB]))
    full = border + (G.T @ heavy[:, -HUB:].toarray())
    try:
        solve = Bordered((with_contact, full))
    except (RuntimeError, np.linalg.LinAlgError):
        return None

    def product(x: Array) -> Array:
        plates = inner @ x[:-HUB] + border[:-HUB] @ x[-HUB:]
        return np.concatenate([plates, border[:-HUB].T @ x[:-HUB] + border[-HUB:] @ x[-HUB:]])

    return settle(solve, product, found.residual, (system.gaps, found.slopes, system.stiffness), touching)
