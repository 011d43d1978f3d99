"""Compilation of the brush tire's loops, and the vectors they and the trees of bodies are written in.

A vector is a tuple (x, y, z), which numba keeps in registers: nothing is allocated.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled

__all__ = ["Vector", "along", "compiled", "cross", "dot", "hypotenuse", "over_length", "ramp", "vector"]

type Vector = tuple[float, float, float]
FloatArray = NDArray[np.float64]


@compiled
def vector(row: FloatArray) -> Vector:
    """First three numbers of an array (n,)."""
    return row[0], row[1], row[2]


@compiled
def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def along(a: Vector, s: float, b: Vector) -> Vector:
    """a + s b."""
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


@compiled
def over_length(a: Vector) -> Vector:
    """Unit vector of a [-]; zero stays zero."""
    scale = 1.0 / max(math.sqrt(dot(a, a)), 1e-300)
    return scale * a[0], scale * a[1], scale * a[2]


@compiled
def hypotenuse(x: float, y: float) -> float:
    """sqrt(x^2 + y^2); a third of the time of math.hypot, which scales against overflow."""
    return math.sqrt(x * x + y * y)


@compiled
def ramp(x: float) -> float:
    """Smooth step 3 x^2 - 2 x^3 [-] from 0 at x <= 0 to 1 at x >= 1."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
