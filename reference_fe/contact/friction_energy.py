"""Energy account of Coulomb friction at the points of contact: what sliding dissipates, what elastic slip stores.

The slip of an increment is ds = ds_e + ds_p; its elastic part takes up the change of the tangential traction on the
body, ds_e = -(t - t_a) / k_t, the rest slides (return mapping of `contact.law.friction_traction`; Simo & Laursen,
Comput. Struct. 42, 1992).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["sliding_dissipation", "slip_energy"]


def sliding_dissipation(
    weights: NDArray[np.float64],
    tractions: tuple[NDArray[np.float64], NDArray[np.float64]],
    slip: NDArray[np.float64],
    stick: NDArray[np.float64],
) -> float:
    """Energy dissipated in one increment, -int (t_a + t) / 2 . ds_p dA [J].

    The mean of both tractions is the trapezoid rule, by which the work of the ground is integrated too: with it
    dissipation and slip energy add up to the work that this rule finds at the points of contact, to the last digit.

    Parameters
    ----------
    weights : (m, q) undeformed area of each point [m^2]
    tractions : t_a and t, (m, q, c, dim) each, on the body at the increment's start and end [Pa]
    slip : (m, q, dim) displacement of the body relative to the obstacle in the increment, ds [m]
    stick : (m,) stiffness of sticking k_t [N/m^3]

    Verified by tests/verification/test_fe_friction_block.py (mu N s) and tests/verification/test_fe_energy.py.
    """
    before, after = tractions
    slid = slip[:, :, None, :] + (after - before) / stick[:, None, None, None]
    return -0.5 * float(np.einsum("mq,mqci,mqci->", weights, before + after, slid))


def slip_energy(weights: NDArray[np.float64], traction: NDArray[np.float64], stick: NDArray[np.float64]) -> float:
    """Energy stored by elastic slip, int |t|^2 / (2 k_t) dA [J]; parameters as in `sliding_dissipation`.

    Verified by tests/verification/test_fe_friction_block.py.
    """
    return 0.5 * float(np.einsum("mq,mqci,mqci,m->", weights, traction, traction, 1.0 / stick))
