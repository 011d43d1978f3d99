"""Laws of contact at a point: penalty with a short quadratic ramp at touch, soil, and Coulomb friction with stick."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from reference_fe.compiled import compiled
from soil.laws import pressure_and_stiffness

__all__ = ["friction_traction", "ramped_pressure", "soil_pressure"]

soil_pressure = compiled(inline="always")(pressure_and_stiffness)
"""Bekker's pressure and stiffness of soil at a depth, as `soil.laws.pressure_and_stiffness`."""


@compiled(inline="always")
def ramped_pressure(gap: float, penalty: float, ramp: float, multiplier: float = 0.0) -> tuple[float, float]:
    """Contact pressure and its stiffness.

    With normal gap g (open > 0), penalty k, ramp d, multiplier l and y = g - l/k:
    p = 0 for y > d; p = k (d - y)^2 / (4 d) for |y| <= d; p = -k y = l - k g for y < -d. It is continuously
    differentiable, so points that are barely open do not flicker between two stiffnesses. With l = 0 it is the penalty
    law, with Uzawa's update l <- p the augmented Lagrangian (Simo & Laursen, Comput. Struct. 42, 1992); its fixed
    points have 0 <= g <= d where they touch.

    Parameters
    ----------
    gap : g [m]
    penalty : k [N/m^3]
    ramp : d > 0 [m]
    multiplier : l >= 0 [Pa]

    Returns
    -------
    pressure, stiffness : p [Pa] and -dp/dg [N/m^3]

    Verified by tests/unit/test_fe_contact_law.py and tests/verification/test_fe_ring.py (elastica ring).
    """
    y = gap - multiplier / penalty
    if y > ramp:
        return 0.0, 0.0
    if y < -ramp:
        return -penalty * y, penalty
    return penalty * (ramp - y) ** 2 / (4.0 * ramp), penalty * (ramp - y) / (2.0 * ramp)


@compiled(inline="always")
def friction_traction(
    trial: NDArray[np.float64], limit: float, traction: NDArray[np.float64], direction: NDArray[np.float64]
) -> float:
    """Return mapping of Coulomb friction; fills ``traction`` and ``direction`` (Simo & Laursen 1992).

    Parameters
    ----------
    trial : (dim,) tangential traction if the point stuck [Pa]
    limit : mu p [Pa]
    traction : (dim,) the trial traction, shortened to the limit [Pa]
    direction : (dim,) its unit vector where it slides, zero where it sticks [-]

    Returns
    -------
    share : traction over trial traction [-]; 1 where the point sticks

    Verified by tests/unit/test_fe_contact_law.py.
    """
    length = 0.0
    for i in range(len(trial)):
        length += trial[i] ** 2
    length = math.sqrt(length)
    sticks = length <= limit
    share = 1.0 if sticks else limit / length
    for i in range(len(trial)):
        traction[i] = share * trial[i]
        direction[i] = 0.0 if sticks else trial[i] / length
    return share
