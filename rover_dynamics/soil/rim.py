"""Where the rim of a wheel lies below its hub, where it touches, and how its pressure falls off behind, compiled.

Verified by tests/unit/test_rover_soil_cells.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import inlined
from rover_dynamics.soil.field import ANGLES, SoilNumbers
from rover_dynamics.tires.brush_compiled import Vector, compiled
from soil import laws

__all__ = ["BULGE", "LEAST_COSINE", "falling_off", "rim_over", "share_of_depth"]

FloatArray = NDArray[np.float64]
NEAR = 1e-7
"""Change of a rim's radius over the wheel's at which it is found."""
BULGE = 1.05
"""How far a rim may reach beyond its radius, over that."""
STEP, STEPS = 0.025, ANGLES
"""Of the angles at which the rim is looked at for where it touches [rad], and their number to each side."""
FARTHEST, COSINE, SINE = STEP * STEPS, math.cos(STEP), math.sin(STEP)
LEAST_COSINE = math.cos(FARTHEST)
"""Of the pieces of the rim that are looked at."""

_slip_sinkage = compiled(laws.slip_sinkage)


@inlined
def rim_over(s: float, state: FloatArray, radius: float, guess: float) -> tuple[float, float, float]:
    """Depth of the rim below the hub at the place s ahead [m], dw/d theta [m], and R - w [m]; depth 0 if beside it.

    Newton's method from a guess of R - w: the neighbour's is near.
    """
    rho, slope, depth, count = guess, 0.0, 0.0, state.shape[0] // 2 - 1
    if count == 0:
        return (math.sqrt(radius * radius - s * s) if abs(s) < radius else 0.0), 0.0, radius
    for _ in range(5):
        if abs(s) >= rho:
            return 0.0, 0.0, rho
        over, depth = 1.0 / rho, math.sqrt(rho * rho - s * s)
        sine, cosine = s * over, depth * over
        w, slope, c, d = 0.0, 0.0, 1.0, 0.0
        for k in range(count):
            w += state[k] * c + state[count + k] * d
            slope += k * (state[count + k] * c - state[k] * d)
            c, d = c * cosine - d * sine, d * cosine + c * sine
        change = (radius - w - rho) * depth / (depth - slope * sine)
        rho += change
        if abs(change) < NEAR * radius:
            break
    return (math.sqrt(rho * rho - s * s) if abs(s) < rho else 0.0), slope, rho


@compiled
def _way(cosine: float, sine: float, state: FloatArray) -> float:
    """w at an angle [m]."""
    w, c, d, count = 0.0, 1.0, 0.0, state.shape[0] // 2 - 1
    for k in range(count):
        w += state[k] * c + state[count + k] * d
        c, d = c * cosine - d * sine, d * cosine + c * sine
    return w


@compiled
def falling_off(
    height: float, state: FloatArray, n: SoilNumbers, rut: float, depths: FloatArray
) -> tuple[Vector, float]:
    """theta_1, theta_m and theta_2 [rad] of a wheel that rolls ahead, mirrored for one that rolls back; largest R - w.

    ``depths`` (2 `STEPS` + 1,) is filled with those of the rim [m], at angles from behind to ahead.
    """
    side, lowest, farthest = math.copysign(1.0, state[-1]), 0.0, 0.0
    cosine, sine = math.cos(FARTHEST), -math.sin(FARTHEST)
    for k in range(2 * STEPS + 1):
        rho = n.radius - _way(cosine, side * sine, state)
        depths[k], farthest = rho * cosine - height, max(farthest, rho)
        lowest = max(lowest, depths[k])
        cosine, sine = cosine * COSINE - sine * SINE, sine * COSINE + cosine * SINE
    entry = _crossed(depths, rut, 2 * STEPS, -1)
    top = (n.peaks[0] + n.peaks[1] * min(max(state[-2], 0.0), 1.0)) * entry
    softer = _slip_sinkage(state[-2]) ** n.slip_sinkage
    peak, modulus = max(_at(top, depths), 0.0), n.modulus / softer**n.exponent
    behind = _crossed(depths, lowest - _rebound(peak, modulus, n.exponent, n.least, n.growth), 0, 1)
    return (entry, top, min(behind, top - 1e-6)), farthest


@compiled
def _crossed(depths: FloatArray, level: float, begin: int, way: int) -> float:
    """Angle at which the rim first lies below a depth [rad], looked for from one end."""
    k = begin
    while 0 <= k < 2 * STEPS + 1 and depths[k] <= level:
        k += way
    if not 0 <= k < 2 * STEPS + 1:
        return 0.0
    if k == begin:
        return (k - STEPS) * STEP
    back = float((depths[k] - level) / (depths[k] - depths[k - way]))
    return (k - STEPS - way * back) * STEP


@inlined
def _at(angle: float, depths: FloatArray) -> float:
    """Depth of the rim at an angle [m]."""
    place = min(max(angle / STEP + STEPS, 0.0), 2.0 * STEPS - 1e-9)
    k = int(place)
    return float(depths[k] + (place - k) * (depths[k + 1] - depths[k]))


@inlined
def share_of_depth(sine: float, z: float, rolled: float, falls: Vector, depths: FloatArray) -> float:
    """Depth whose pressure a piece of rim has, over its own depth: 1 ahead of theta_m, less behind (Wong and Reece)."""
    entry, top, behind = falls
    angle = math.asin(math.copysign(sine, sine * rolled))
    if angle >= top or rolled == 0.0:
        return 1.0
    there = max(_at(min(top + (top - angle) * (entry - top) / (top - behind), entry), depths), 0.0)
    return 1.0 - abs(rolled) * (1.0 - min(there / z, 1.0))


@compiled
def _rebound(deepest: float, modulus: float, exponent: float, least: float, growth: float) -> float:
    """`soil.laws.rebound`, which calls another law."""
    return min(deepest, float(modulus * deepest**exponent) / max(least + growth * deepest, 1e-300))
