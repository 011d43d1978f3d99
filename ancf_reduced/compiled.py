"""Compilation of the plate loops, and the small tensors they are written in.

A vector is a tuple (x, y, z); a symmetric tensor a tuple (11, 22, 33, 23, 13, 12). Numba dissolves both into registers,
so that loops over points written with them are vectorised.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numba
import numpy as np
from numpy.typing import NDArray

from contracts.compile_cache import kept_by_sources

__all__ = [
    "LANES",
    "Symmetric",
    "Vector",
    "columns",
    "combination",
    "compiled",
    "dot",
    "inlined",
    "put",
    "symmetric_at",
    "vector_at",
]

type Vector = tuple[float, float, float]
type Symmetric = tuple[float, float, float, float, float, float]
FloatArray = NDArray[np.float64]
_PACKAGE = Path(__file__).parent

LANES = 32
"""Integration points handled together."""


def compiled[F: Callable[..., object]](function: F) -> F:
    """Compile with numba; sums may be re-associated and contracted, nothing else is relaxed.

    No entry for callers in C is made, which took a sixth of the time of compilation. Cached on disk for the present
    sources of the package.
    """
    with kept_by_sources(numba.config, _PACKAGE):
        jit: Any = numba.njit  # whose stubs lack an option
        decorate = jit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"}, no_cfunc_wrapper=True)
        return cast(F, decorate(function))


def inlined[F: Callable[..., object]](function: F) -> F:
    """Compile into every caller: the arrays a caller allocates are then known not to overlap, and loops vectorised."""
    jit = numba.njit(error_model="numpy", fastmath={"reassoc", "contract"}, inline="always")
    return cast(F, jit(function))


@inlined
def vector_at(f: FloatArray, k: int, q: int) -> Vector:
    """Vector k of point q from an array (n_vectors, 3, n_points)."""
    return f[k, 0, q], f[k, 1, q], f[k, 2, q]


@inlined
def put(f: FloatArray, k: int, q: int, v: Vector) -> None:
    """Write vector k of point q to an array (n_vectors, 3, n_points)."""
    f[k, 0, q], f[k, 1, q], f[k, 2, q] = v


@inlined
def symmetric_at(f: FloatArray, q: int) -> Symmetric:
    """Symmetric tensor of point q from an array (6, n_points)."""
    return f[0, q], f[1, q], f[2, q], f[3, q], f[4, q], f[5, q]


@inlined
def dot(a: Vector, b: Vector) -> float:
    """Scalar product of two vectors (x, y, z), in the product of their units."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def combination(x: Vector, a: Vector, b: Vector, c: Vector) -> Vector:
    """Vector (x, y, z): x0 a + x1 b + x2 c."""
    return (
        x[0] * a[0] + x[1] * b[0] + x[2] * c[0],
        x[0] * a[1] + x[1] * b[1] + x[2] * c[1],
        x[0] * a[2] + x[1] * b[2] + x[2] * c[2],
    )


@inlined
def columns(S: Symmetric) -> tuple[Vector, Vector, Vector]:
    """Columns, (x, y, z) each, of a symmetric tensor (11, 22, 33, 23, 13, 12)."""
    return (S[0], S[5], S[4]), (S[5], S[1], S[3]), (S[4], S[3], S[2])
