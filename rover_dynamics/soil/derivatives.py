"""Derivatives of what a wheel feels of one cell, summed up for implicit integration, compiled.

Verified by tests/unit/test_rover_soil_cells.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import inlined
from rover_dynamics.soil.field import SoilGround, SoilNumbers
from rover_dynamics.tires.brush_compiled import Vector, along, compiled, cross, dot

__all__ = ["add_derivatives", "finish_derivatives"]

FloatArray = NDArray[np.float64]
MOST_SLIP = 0.9
"""That the derivatives know."""


@inlined
def add_derivatives(
    axes: tuple[Vector, Vector, Vector, Vector, tuple[float, float, float, float, float]],
    laws_of: tuple[float, Vector, float, float],
    sheared: Vector,
    n: SoilNumbers,
    sigma: float,
    sums: tuple[FloatArray, FloatArray],
) -> None:
    """Add one cell's derivatives.

    Parameters
    ----------
    axes : lever, tangent, normal, axle; cosine and sine of the place on the rim, area, that which moves the rim
        towards the hub [m^2], and the part of the normal out of the ground
    laws_of : shear stress over way, `_shear`'s derivatives, dp/dz, and p where the soil yields, else 0
    sheared : ahead and aside, lag included [m], and how much of it a unit of sliding speed adds [s]
    sigma : slip along the contact [-]
    sums : (6 + s, 12 + s) float that is added to; (2, 5 + s) float, working memory: what a pressure on the cell does,
        and by what the pressure changes
    """
    r, t, normal, e, (cosine, sine, area, conjugate, facing) = axes
    shear, (rising, by_pressure, way), stiffness, yielding = laws_of
    a, b, by_speed = sheared
    jacobian, felt, by = sums[0], sums[1][0], sums[1][1]
    count = (jacobian.shape[0] - 8) // 2
    unit = along(along(normal, -by_pressure * a, t), -by_pressure * b, e)  # of the force per area, by the pressure
    on_wrench = _wrench((r, e), unit, -by_pressure * a, (n.shear_radius, area))
    turned = cross(r, normal)
    by_motion = (*normal, *turned)
    for q in range(6):
        felt[q], by[q] = on_wrench[q], -stiffness * by_motion[q] / facing
    c, d = 1.0, 0.0
    for k in range(count):
        felt[6 + k], felt[6 + count + k] = conjugate * c, conjugate * d
        by[6 + k], by[6 + count + k] = -stiffness * c / facing, -stiffness * d / facing
        c, d = c * cosine - d * sine, d * cosine + c * sine
    by[6 + 2 * count] = 0.0
    if 0.0 < sigma < 1.0:
        by[6 + 2 * count] = -yielding * n.exponent * n.slip_sinkage * (1.0 / (1.0 + sigma) + 0.5 / (1.0 - 0.5 * sigma))
    for m in range(6 + 2 * count):
        for q in range(6):
            jacobian[m, q] += felt[m] * by[q]
        for q in range(6, 7 + 2 * count):
            jacobian[m, 6 + q] += felt[m] * by[q]
    over = 1.0 / max(way, 1e-12)
    x, y = a * over, b * over
    ahead_too = by_speed - (by_speed - n.lag) * min(max(sigma, 0.0), MOST_SLIP)  # what comes from upwind grows as well
    first = -ahead_too * (shear * (1.0 - x * x) + rising * x * x)
    mixed = -by_speed * (rising - shear) * x * y
    second = -by_speed * (shear * (1.0 - y * y) + rising * y * y)
    zero = (0.0, 0.0, 0.0)
    on_ahead = _wrench((r, e), along(along(zero, first, t), mixed, e), first, (n.shear_radius, area))
    on_aside = _wrench((r, e), along(along(zero, mixed, t), second, e), mixed, (n.shear_radius, area))
    spun = cross(r, t)
    ahead = (*t, *along(spun, -dot(spun, e) - n.shear_radius, e))
    aside = (*e, *cross(r, e))
    for q in range(6):
        for m in range(6):
            jacobian[m, 6 + q] += on_ahead[m] * ahead[q] + on_aside[m] * aside[q]


@inlined
def _wrench(
    axes: tuple[Vector, Vector], stress: Vector, ahead: float, sizes: tuple[float, float]
) -> tuple[float, float, float, float, float, float]:
    """Force and moment of a stress over an area at a lever, that about the axle by its part ahead along the rim."""
    r, e = axes
    lever, area = sizes
    moment = cross(r, stress)
    moment = along(moment, -dot(moment, e) - lever * ahead, e)
    return (
        area * stress[0],
        area * stress[1],
        area * stress[2],
        area * moment[0],
        area * moment[1],
        area * moment[2],
    )


@compiled
def finish_derivatives(
    axes: tuple[Vector, Vector], rolling: tuple[float, float, float], ground: SoilGround, jacobian: FloatArray
) -> None:
    """Bring the harmonics' rows from forces to rates, and fill that of the slip; ``axes`` heading and axle."""
    heading, e = axes
    rolls, spin, length = rolling
    count, n = (jacobian.shape[0] - 8) // 2, ground.numbers
    for k in range(2 * count):
        for column in range(jacobian.shape[1]):
            jacobian[6 + k, column] *= ground.compliance[k % count] / n.settling
        jacobian[6 + k, 12 + k] -= 1.0 / n.settling
    last, way = 6 + 2 * count, math.copysign(1.0, spin)
    for k in range(2):
        jacobian[last + k, 12 + 2 * count + k] = -rolls / length
    for q in range(3):
        jacobian[last, 6 + q] = -way * heading[q] / length
        jacobian[last, 9 + q] = way * n.radius * e[q] / length
        jacobian[last + 1, 9 + q] = n.radius * e[q] / length
