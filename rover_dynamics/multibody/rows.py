"""Three-vectors and 3 x 3 matrices as tuples, a matrix by its rows: they stay in registers and allocate nothing.

Verified by tests/unit/test_multibody_rotations.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rover_dynamics.multibody.compiled import compiled
from rover_dynamics.tires.brush_compiled import Vector, along, cross, dot

__all__ = [
    "Matrix",
    "Vector",
    "along",
    "cross",
    "dot",
    "matrix",
    "put_matrix",
    "put_pair",
    "put_vector",
    "times",
    "times_matrix",
    "transposed_times",
    "turn_matrix",
    "vector",
]

FloatArray = NDArray[np.float64]
type Matrix = tuple[Vector, Vector, Vector]


@compiled
def vector(a: FloatArray, k: int, at: int) -> Vector:
    """Three numbers of row k of (n, m), from column ``at`` on."""
    return a[k, at], a[k, at + 1], a[k, at + 2]


@compiled
def put_vector(a: FloatArray, k: int, x: Vector) -> None:
    """Row k of (n, 3) becomes x."""
    a[k, 0], a[k, 1], a[k, 2] = x


@compiled
def put_pair(a: FloatArray, k: int, x: Vector, y: Vector) -> None:
    """Row k of (n, 6) becomes (x, y)."""
    a[k, 0], a[k, 1], a[k, 2] = x
    a[k, 3], a[k, 4], a[k, 5] = y


@compiled
def matrix(a: FloatArray, k: int) -> Matrix:
    """Matrix k of (n, 3, 3)."""
    return (
        (a[k, 0, 0], a[k, 0, 1], a[k, 0, 2]),
        (a[k, 1, 0], a[k, 1, 1], a[k, 1, 2]),
        (a[k, 2, 0], a[k, 2, 1], a[k, 2, 2]),
    )


@compiled
def put_matrix(a: FloatArray, k: int, A: Matrix) -> None:
    """Matrix k of (n, 3, 3) becomes A."""
    a[k, 0, 0], a[k, 0, 1], a[k, 0, 2] = A[0]
    a[k, 1, 0], a[k, 1, 1], a[k, 1, 2] = A[1]
    a[k, 2, 0], a[k, 2, 1], a[k, 2, 2] = A[2]


@compiled
def times(A: Matrix, x: Vector) -> Vector:
    """A x."""
    return dot(A[0], x), dot(A[1], x), dot(A[2], x)


@compiled
def transposed_times(A: Matrix, x: Vector) -> Vector:
    """A^T x."""
    return along(along((x[0] * A[0][0], x[0] * A[0][1], x[0] * A[0][2]), x[1], A[1]), x[2], A[2])


@compiled
def times_matrix(A: Matrix, B: Matrix) -> Matrix:
    """A B."""
    return transposed_times(B, A[0]), transposed_times(B, A[1]), transposed_times(B, A[2])


@compiled
def turn_matrix(axis: Vector, angle: float) -> Matrix:
    """Rotation about a unit axis by an angle [rad] (Rodrigues)."""
    c, s = np.cos(angle), np.sin(angle)
    (x, y, z), h = axis, 1.0 - c
    return (
        (c + h * x * x, h * x * y - s * z, h * x * z + s * y),
        (h * x * y + s * z, c + h * y * y, h * y * z - s * x),
        (h * x * z - s * y, h * y * z + s * x, c + h * z * z),
    )
