"""Compilation of the multibody loops, and rotations by unit quaternions (scalar first).

A quaternion q = (q0, q1, q2, q3) turns body axes into world axes: r_w = R(q) r_b. Its rate is q' = 1/2 (0, w) * q with
the angular velocity w in world axes. Verified by tests/unit/test_multibody_rotations.py.
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
    "compiled",
    "cross",
    "inlined",
    "multiply_quaternions",
    "quaternion_of",
    "rotation_matrix",
    "rotation_quaternion",
]

FloatArray = NDArray[np.float64]
_PACKAGE = Path(__file__).parents[1]


def compiled[F: Callable[..., object]](function: F) -> F:
    """Compile with numba, no rule of arithmetic relaxed, cached on disk for the present sources of the package.

    No entry for callers in C is made, which took a sixth of the time of compilation.
    Where sums may be contracted, the digits depend on which functions were compiled together and which came from the
    cache: a run that was killed and started again ended with other last digits. It was no faster either.
    """
    return _compiled(function)


def inlined[F: Callable[..., object]](function: F) -> F:
    """As `compiled`, for what is put into its callers: a call by itself copies every array of its arguments' tuples."""
    return _compiled(function, forceinline=True)


def _compiled[F: Callable[..., object]](function: F, **options: bool) -> F:
    jit: Any = numba.njit  # whose stubs lack an option
    with kept_by_sources(numba.config, _PACKAGE):
        return cast(F, jit(cache=True, error_model="numpy", no_cfunc_wrapper=True, **options)(function))


@compiled
def cross(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """out = a x b, (3,) each; out must not be a or b."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@compiled
def rotation_matrix(q: FloatArray, out: FloatArray) -> None:
    """R(q), (3, 3), of a quaternion of any length but zero."""
    s = 2.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    xx, yy, zz = s * q[1] * q[1], s * q[2] * q[2], s * q[3] * q[3]
    xy, xz, yz = s * q[1] * q[2], s * q[1] * q[3], s * q[2] * q[3]
    wx, wy, wz = s * q[0] * q[1], s * q[0] * q[2], s * q[0] * q[3]
    out[0, 0], out[0, 1], out[0, 2] = 1.0 - yy - zz, xy - wz, xz + wy
    out[1, 0], out[1, 1], out[1, 2] = xy + wz, 1.0 - xx - zz, yz - wx
    out[2, 0], out[2, 1], out[2, 2] = xz - wy, yz + wx, 1.0 - xx - yy


@compiled
def multiply_quaternions(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """out = a * b, (4,) each, the rotation b followed by a; out must not be a or b."""
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3]
    out[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2]
    out[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1]
    out[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]


@compiled
def rotation_quaternion(turn: FloatArray, out: FloatArray) -> None:
    """Unit quaternion of a rotation vector, (3,) [rad]."""
    angle = np.sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2])
    scale = 0.5 if angle < 1e-12 else np.sin(0.5 * angle) / angle
    out[0] = np.cos(0.5 * angle)
    for k in range(3):
        out[1 + k] = scale * turn[k]


def quaternion_of(rotation: FloatArray) -> FloatArray:
    """Unit quaternion of a rotation matrix, (4,), scalar first and not negative."""
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_matrix(rotation).as_quat(canonical=True, scalar_first=True))
